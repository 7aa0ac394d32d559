"""A robot's limits and delay are found from its commands and its motion, an opponent's from its motion."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import sin

import numpy as np
import pytest

from robobt.identify.estimate import Estimate
from robobt.identify.noise import identify_noise
from robobt.identify.observations import Observations
from robobt.identify.opponents import identify_opponent
from robobt.identify.robots import RobotEstimate, identify_robot
from robobt.sim import SimSettings
from robobt.sim.realism import RealismSettings
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import RobotId
from tests.identify.made import PERIOD, Watched, driven

pytestmark = pytest.mark.integration

LIMITS = RobotLimits(
    max_speed=2.2, acceleration=2.6, braking=4.0, side_acceleration=2.2, side_braking=3.4, max_turn=8.0
)
LATE = RealismSettings(
    robot_noise=0.001, heading_noise=0.005, missing_robot=0.02, vision_delay=0.03, command_delay=0.05
)
WHOLE_DELAY = (7 + 12) / 240
"""Both delays in the simulator's steps of 1/240 s [s]."""


@cache
def seen() -> Observations:
    return driven(LIMITS, SimSettings(realism=LATE))


@cache
def own() -> RobotEstimate:
    return identify_robot(seen(), 0)


@cache
def opponent() -> RobotEstimate:
    return identify_opponent(seen(), 1, 0.001)


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("max_speed", 2.2),
        ("acceleration", 2.6),
        ("braking", 4.0),
        ("side_acceleration", 2.2),
        ("side_braking", 3.4),
        ("gain", 1.0),
    ],
)
def test_own_robots_are_known_from_commands(name: str, truth: float) -> None:
    figure = own().figures[name]
    assert figure.seen
    assert figure.value == pytest.approx(truth, rel=0.03)


def test_no_interval_of_what_cannot_be_negative_begins_below_0() -> None:
    lags = [figure for name, figure in own().figures.items() if not name.startswith("cross")]
    assert all(figure.low >= 0.0 for figure in lags)
    # These robots have none, so that an interval about the estimate would.
    assert any(own().figures[name].low == 0.0 for name in ("lag", "side_lag", "turn_lag"))


def test_the_whole_delay_is_known_to_a_millisecond() -> None:
    figure = own().figures["delay"]
    assert figure.seen
    assert figure.value == pytest.approx(WHOLE_DELAY, abs=0.001)


def test_pictures_that_know_their_age_give_the_same_whole_delay() -> None:
    aged = seen().between(0.0, np.inf)
    # Taken when they show it: the simulator rounds 30 ms to 7 steps.
    aged.times, aged.age = aged.times - 7 / 240, 7 / 240
    assert identify_robot(aged, 0).figures["delay"].value == pytest.approx(WHOLE_DELAY, abs=0.001)


def test_a_limit_that_was_never_met_is_not_seen_enough() -> None:
    figure = own().figures["max_turn"]
    assert not figure.seen
    assert figure.text() == "not seen enough"


def test_what_rounding_leaves_of_zero_reads_as_zero() -> None:
    assert Estimate(1.4e-15, -2e-15, 0.012, 40, True, "m").text() == "0 (0 to 0.012) m"


def test_a_cameras_noise_is_told_to_a_thousandth_of_a_millimetre() -> None:
    # ER-Force's level "friendly" has 0.4 mm.
    noise = Estimate(0.000376, 0.000351, 0.000402, 900, True, "m")
    assert noise.text() == "0.000376 (0.000351 to 0.000402) m"


@pytest.mark.parametrize(
    ("name", "truth"), [("max_speed", 2.2), ("acceleration", 2.6), ("side_acceleration", 2.2)]
)
def test_opponents_are_known_without_commands(name: str, truth: float) -> None:
    assert not seen().commanded(1)
    figure = opponent().figures[name]
    assert figure.seen
    assert figure.value == pytest.approx(truth, rel=0.05)


def test_delay_and_gain_of_opponents_are_not_seen() -> None:
    figures = opponent().figures
    assert not figures["delay"].seen
    assert not figures["gain"].seen


def test_noise_and_gaps_are_known() -> None:
    found = identify_noise(seen())
    assert found.robot_noise.value == pytest.approx(0.001, rel=0.1)
    assert found.heading_noise.value == pytest.approx(0.005, rel=0.1)
    assert found.missing_robot.value == pytest.approx(0.02, abs=0.008)


def test_a_robot_that_somebody_else_drove_gets_no_figures() -> None:
    robot = RobotId(Team.BLUE, 0)
    watched = Watched({robot: LIMITS}, SimSettings())
    watched.world.reset(Placement(robots={robot: (0.0, 0.0, 0.0)}, ball=(0.0, 2.9, 0.0, 0.0)), 0)
    for tick in range(len(seen().times)):
        t = tick * PERIOD
        by_hand = RobotCommand(1.5 * sin(1.3 * t), 1.2 * sin(2.1 * t + 1.0), 4.0 * sin(0.9 * t))
        watched.tick({robot: by_hand})
    sent = replace(watched.observations(), commands=seen().commands[:, :1])
    assert [name for name, figure in identify_robot(sent, 0).figures.items() if figure.seen] == []
