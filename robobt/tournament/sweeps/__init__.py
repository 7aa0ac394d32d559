"""Tuning the parameters of a play: varied parameters, candidates and results."""

from robobt.config.extras import need

need("sweep", "optuna", "google.protobuf", "pyarrow", "scipy")
