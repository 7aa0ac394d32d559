"""Shot predictors: the best for few shots, those that ship, and their cross-validation."""

from robobt.shots.predict.predictors import best_predictor as best_predictor
