"""Shot predictors: the paper's, the best, those that ship, and their cross-validation."""

from robobt.shots.predict.predictors import PREDICTORS, best_predictor

__all__ = ["PREDICTORS", "best_predictor"]
