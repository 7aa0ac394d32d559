"""Tuning the parameters of a play: what is varied, which candidates are tried, and what came of it."""

from robobt.config.extras import need

need("sweep", "optuna", "google.protobuf", "pyarrow", "scipy")
