"""Shot raters: small interchangeable objects that return target, tolerance and score."""

from robobt.skills.aim.raters.base import RATERS as RATERS
from robobt.skills.aim.raters.base import Rater as Rater
from robobt.skills.aim.raters.base import ShotRater as ShotRater
from robobt.skills.aim.raters.base import make_rater as make_rater
from robobt.skills.aim.raters.expected_goal import ExpectedGoal as ExpectedGoal
from robobt.skills.aim.raters.gaussian import Gaussian as Gaussian
from robobt.skills.aim.raters.moving_horizon import MovingHorizon as MovingHorizon
from robobt.skills.aim.raters.nn_filtered import NNFiltered as NNFiltered
from robobt.skills.aim.raters.open_angle import OpenAngle as OpenAngle
from robobt.skills.aim.raters.segment_clearance import SegmentClearance as SegmentClearance
