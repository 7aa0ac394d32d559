"""Shots at the goal: their data, how they are collected, and predictors that learn from them."""

from typing import TYPE_CHECKING

from robobt.config.extras import need
from robobt.config.lazy import lazily

need("shots", "sklearn", "scipy", "pyarrow")

_HOMES = {
    "CollectionSettings": "collect",
    "FOLDS": "predict.validation",
    "Judgement": "predict.validation",
    "Layer": "predict.networks",
    "NetworkClassifier": "predict.network_classifier",
    "Population": "keepers.population",
    "Recipe": "predict.batched",
    "ShotDataError": "data",
    "ShotSets": "predict.shot_sets",
    "Traits": "keepers.population",
    "best_predictor": "predict",
    "collect_shots": "collect",
    "goals": "data",
    "judge": "predict.validation",
    "load_shot_sets": "predict.shot_sets",
    "measured": "predict.score",
    "pair_features": "predict.predictors",
    "read_shots": "data",
    "shot_inputs": "data",
    "stratified_folds": "predict.validation",
}

if TYPE_CHECKING:
    from robobt.shots.collect import CollectionSettings as CollectionSettings
    from robobt.shots.collect import collect_shots as collect_shots
    from robobt.shots.data import ShotDataError as ShotDataError
    from robobt.shots.data import goals as goals
    from robobt.shots.data import read_shots as read_shots
    from robobt.shots.data import shot_inputs as shot_inputs
    from robobt.shots.keepers.population import Population as Population
    from robobt.shots.keepers.population import Traits as Traits
    from robobt.shots.predict import best_predictor as best_predictor
    from robobt.shots.predict.batched import Recipe as Recipe
    from robobt.shots.predict.network_classifier import NetworkClassifier as NetworkClassifier
    from robobt.shots.predict.networks import Layer as Layer
    from robobt.shots.predict.predictors import pair_features as pair_features
    from robobt.shots.predict.score import measured as measured
    from robobt.shots.predict.shot_sets import ShotSets as ShotSets
    from robobt.shots.predict.shot_sets import load_shot_sets as load_shot_sets
    from robobt.shots.predict.validation import FOLDS as FOLDS
    from robobt.shots.predict.validation import Judgement as Judgement
    from robobt.shots.predict.validation import judge as judge
    from robobt.shots.predict.validation import stratified_folds as stratified_folds
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
