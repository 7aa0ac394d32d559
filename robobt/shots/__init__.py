"""Shots at the goal: their data, how they are collected, and predictors that learn from them."""

from typing import TYPE_CHECKING

from robobt.config.extras import need
from robobt.config.lazy import lazily

need("shots", "sklearn", "scipy", "pyarrow")

_HOMES = {
    "CollectionSettings": "collect",
    "best_predictor": "predict",
    "collect_shots": "collect",
    "goals": "data",
    "read_shots": "data",
    "shot_inputs": "data",
}

if TYPE_CHECKING:
    from robobt.shots.collect import CollectionSettings as CollectionSettings
    from robobt.shots.collect import collect_shots as collect_shots
    from robobt.shots.data import goals as goals
    from robobt.shots.data import read_shots as read_shots
    from robobt.shots.data import shot_inputs as shot_inputs
    from robobt.shots.predict import best_predictor as best_predictor
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
