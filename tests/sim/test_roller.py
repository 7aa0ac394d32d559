"""A roller holds the ball by its spin, as measured in ER-Force's simulator."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

import pytest

from robobt.sim import SimWorld, preset
from robobt.world import BALL_RADIUS, RobotCommand
from tests.sim.rig import ME, ball_offset, holding, kick, one_robot, time_lost

SEEN_LATE = 0.042
"""How much later things are seen in that simulator than they happen; measured times are of sight [s]."""


def dribbling() -> SimWorld:
    """A robot that has had the ball at its roller for half a second, driving forward slowly."""
    world = holding("erforce")
    while world.time < 0.5:
        world.act({ME: RobotCommand(vx=0.1, dribbler=True)})
    return world


def lost_after(command: Callable[[float], RobotCommand], seconds: float = 3.0) -> float | None:
    """When a ball is lost that was being dribbled, from the first of these commands on [s]."""
    world = dribbling()
    start = world.time
    while world.time < start + seconds:
        if (lost := time_lost(world, command(world.time - start), world.time + world.period)) is not None:
            return lost - start
    return None


def test_a_command_takes_effect_as_late_as_measured() -> None:
    world = one_robot("erforce")
    while world.truth().own[0].speed == 0.0:
        world.act({ME: RobotCommand(vx=1.5)})
    assert world.time + SEEN_LATE == pytest.approx(0.059, abs=0.012)
    world = holding("erforce")
    kick(world, 5.0)
    assert world.time + SEEN_LATE == pytest.approx(0.047, abs=0.006)


@pytest.mark.parametrize("rate", [1.0, -2.0])
def test_it_holds_the_ball_while_turning_slowly(rate: float) -> None:
    assert time_lost(holding("erforce"), RobotCommand(omega=rate, dribbler=True)) is None
    assert lost_after(lambda _: RobotCommand(omega=rate, dribbler=True)) is None


@pytest.mark.parametrize(("rate", "measured"), [(3.0, 0.7), (-5.0, 0.35)])
def test_it_loses_the_ball_when_turning_fast(rate: float, measured: float) -> None:
    # The ball rattles between the jaws before it leaves: when exactly hangs on how it lay.
    at_rest = time_lost(holding("erforce"), RobotCommand(omega=rate, dribbler=True))
    dribbled = lost_after(lambda _: RobotCommand(omega=rate, dribbler=True))
    assert at_rest is not None
    assert dribbled is not None
    assert 0.6 * measured < at_rest + SEEN_LATE < 1.2 * measured
    assert 0.6 * measured < dribbled + SEEN_LATE < 2.1 * measured


def test_it_holds_the_ball_when_backing_away_gently() -> None:
    assert lost_after(lambda t: RobotCommand(vx=-min(t, 1.0), dribbler=True)) is None


def test_it_loses_the_ball_when_told_to_back_away_at_once() -> None:
    lost = lost_after(lambda _: RobotCommand(vx=-0.5, dribbler=True))
    assert lost is not None
    assert lost + SEEN_LATE == pytest.approx(0.2, abs=0.03)


def test_no_ball_is_drawn_back_faster_than_the_roller_turns() -> None:
    roller = preset("erforce").dribbler.roller_speed
    lost = lost_after(lambda t: RobotCommand(vx=-t, dribbler=True))
    assert lost is not None
    assert lost == pytest.approx(roller + 0.2, abs=0.15)


@pytest.mark.parametrize("aside", [0.0, 0.01])
def test_a_driven_roller_holds_a_ball_that_arrives_fast(aside: float) -> None:
    world = one_robot("erforce", ball=(1.0, aside, -3.3, 0))
    fastest = 0.0
    while world.time < 3.0:
        world.act({ME: RobotCommand(dribbler=True)})
        fastest = max(fastest, world.truth().ball.speed)
    assert fastest > 3.2
    assert world.truth().own[0].ball_contact
    assert world.truth().ball.speed < 0.01


def test_an_idle_roller_gives_back_more_of_the_speed() -> None:
    farthest = {}
    for driven in (True, False):
        world = one_robot("erforce", ball=(0.5, 0, -3.2, 0))
        place = world.settings.body.face + BALL_RADIUS
        arrived, farthest[driven] = False, 0.0
        while world.time < 1.0:
            world.act({ME: RobotCommand(dribbler=driven)})
            ball = world.truth().ball
            arrived = arrived or ball.x < place + 0.002
            if arrived:
                farthest[driven] = max(farthest[driven], ball.x - place)
    assert farthest[False] > 2 * farthest[True]


def test_without_the_dribbler_the_ball_stays_behind() -> None:
    assert time_lost(dribbling(), RobotCommand(vx=-0.5), 1.5) is not None


@pytest.mark.parametrize("aside", [0.03, -0.05, 0.06])
def test_a_ball_meets_the_jaws_beside_the_mouth(aside: float) -> None:
    world = one_robot("erforce", ball=(0.6, aside, -4.0, 0))
    jaws = preset("erforce").body.jaws
    assert jaws is not None
    nearest = 9.0
    while world.time < 0.4:
        world.act({})
        ball = world.truth().ball
        nearest = min(nearest, ball.x)
    # It came no farther than a corner lets it, and went off again.
    assert nearest > jaws.front - 2 * jaws.rounding
    assert hypot(ball.x, ball.y) > 0.12
    assert ball_offset(world)[0] > 0.12
