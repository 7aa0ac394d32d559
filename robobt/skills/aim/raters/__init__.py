"""Shot raters: small interchangeable objects that return target, tolerance and score."""

from robobt.skills.aim.raters.base import RATERS, ShotRater, make_rater
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.gaussian import Gaussian
from robobt.skills.aim.raters.moving_horizon import MovingHorizon
from robobt.skills.aim.raters.nn_filtered import NNFiltered
from robobt.skills.aim.raters.open_angle import OpenAngle
from robobt.skills.aim.raters.segment_clearance import SegmentClearance

__all__ = [
    "RATERS",
    "ExpectedGoal",
    "Gaussian",
    "MovingHorizon",
    "NNFiltered",
    "OpenAngle",
    "SegmentClearance",
    "ShotRater",
    "make_rater",
]
