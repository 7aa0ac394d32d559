"""Shot raters: small interchangeable objects that return target, tolerance and score."""

from robobt.skills.raters.base import RATERS, ShotRater, make_rater
from robobt.skills.raters.expected_goal import ExpectedGoal
from robobt.skills.raters.gaussian import Gaussian
from robobt.skills.raters.moving_horizon import MovingHorizon
from robobt.skills.raters.nn_filtered import NNFiltered
from robobt.skills.raters.open_angle import OpenAngle
from robobt.skills.raters.segment_clearance import SegmentClearance

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
