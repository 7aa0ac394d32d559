"""The table of shots, its files, and the arrays that predictors learn from."""

from robobt.shots.data.files import read_shots, write_shots
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.problems import ShotDataError

__all__ = ["ShotDataError", "goals", "read_shots", "shot_inputs", "write_shots"]
