"""Shots at the goal: their data, how they are collected, and predictors that learn from them."""

from robobt.config.extras import need

need("shots", "sklearn", "scipy", "pyarrow")
