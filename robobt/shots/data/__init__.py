"""The table of shots, its files, and the arrays that predictors learn from."""

from robobt.shots.data.files import read_shots as read_shots
from robobt.shots.data.files import write_shots as write_shots
from robobt.shots.data.inputs import goals as goals
from robobt.shots.data.inputs import shot_inputs as shot_inputs
from robobt.shots.data.schema import ShotDataError as ShotDataError
