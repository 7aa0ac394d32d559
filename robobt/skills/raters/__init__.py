"""Shot raters: small interchangeable objects that return target, tolerance and score."""

from robobt.skills.raters.base import RATERS, ShotRater, make_rater
from robobt.skills.raters.gaussian import Gaussian
from robobt.skills.raters.moving_horizon import MovingHorizon
from robobt.skills.raters.open_angle import OpenAngle
from robobt.skills.raters.segment_clearance import SegmentClearance

__all__ = [
    "RATERS",
    "Gaussian",
    "MovingHorizon",
    "OpenAngle",
    "SegmentClearance",
    "ShotRater",
    "make_rater",
]
