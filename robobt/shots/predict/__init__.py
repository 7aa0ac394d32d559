"""Shot predictors: the paper's, the best, those that ship, and their cross-validation."""

from robobt.shots.predict.predictors import PREDICTORS as PREDICTORS
from robobt.shots.predict.predictors import best_predictor as best_predictor
