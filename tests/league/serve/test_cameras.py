"""Cameras share the field as grSim's do, and see what is over their part of it."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.league.serve.cameras import Cameras
from robobt.sim.settings import REALISM
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.state import BallState, Frame, RobotId, RobotState


def cameras(count: int) -> Cameras:
    return Cameras(DIVISION_B, REALISM["none"], count, np.random.default_rng(0))


def test_four_are_numbered_and_placed_as_grsims() -> None:
    assert cameras(4).places == [(2.25, 1.5), (2.25, -1.5), (-2.25, -1.5), (-2.25, 1.5)]


def test_one_hangs_over_the_middle() -> None:
    assert cameras(1).places == [(0.0, 0.0)]


@pytest.mark.parametrize("count", [2, 6, 16])
def test_every_camera_sees_what_is_below_it(count: int) -> None:
    shared = cameras(count)
    assert len(set(shared.places)) == count
    robots = tuple(RobotState(i, x, y, 0.0) for i, (x, y) in enumerate(shared.places))
    frame = Frame(0.0, DIVISION_B, BallState(0.0, 0.0), robots)
    for seen in shared.capture(frame, 0.0, 0.0):
        assert RobotId(Team.BLUE, seen.camera) in {detection.robot for detection in seen.robots}


def test_what_lies_in_the_middle_is_seen_by_all_four() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(0.1, -0.1))
    assert [len(seen.balls) for seen in cameras(4).capture(frame, 0.0, 0.0)] == [1, 1, 1, 1]
