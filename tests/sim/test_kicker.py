"""Kicks leave from the mouth only, along the heading, no faster than allowed."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.sim import preset, settings_from
from robobt.sim.arenas import Arenas
from robobt.world import BALL_RADIUS, DIVISION_B, KickTrigger, Placement, RobotCommand
from robobt.world.geometry import FloatArray
from tests.sim.rig import ME, holding, kick, one_robot

NOW, ON_CONTACT = KickTrigger.NOW, KickTrigger.ON_CONTACT


@pytest.mark.parametrize("name", ["default", "erforce", "sumatra", "robobulls", "grsim", "rsim"])
def test_no_kick_is_faster_than_the_presets_cap(name: str) -> None:
    cap = preset(name).kicker.max_speed
    world = holding(name)
    kick(world, 50.0)
    speed = world.truth().ball.speed
    assert speed <= cap
    assert speed == pytest.approx(cap, rel=0.02)


def test_the_default_cap_is_the_rules() -> None:
    assert preset("default").kicker.max_speed == 6.5


@pytest.mark.parametrize(
    ("ahead", "aside"), [(0.13, 0.0), (-0.0965, 0.0), (0.0, 0.0965 + 0.02), (0.0965, 0.06)]
)
@pytest.mark.parametrize("trigger", [NOW, ON_CONTACT])
def test_a_ball_outside_the_mouth_is_not_kicked(ahead: float, aside: float, trigger: KickTrigger) -> None:
    world = one_robot(ball=(ahead, aside, 0, 0))
    world.act({ME: RobotCommand(kick_speed=6.0, kick_trigger=trigger)})
    assert world.kicks == []
    assert world.truth().ball.speed < 1.0


def test_now_means_now_and_on_contact_waits() -> None:
    for trigger, leaves in ((NOW, False), (ON_CONTACT, True)):
        # The ball reaches the mouth in the middle of the control period.
        world = one_robot(ball=(0.15, 0, -1.5, 0), period=0.05)
        world.act({ME: RobotCommand(kick_speed=5.0, kick_trigger=trigger)})
        assert (world.kicks == [ME]) == leaves
        assert (world.truth().ball.vx > 3) == leaves


@settings(max_examples=25)
@given(heading=st.floats(-3.1, 3.1), speed=st.floats(0.5, 6.5))
def test_the_ball_leaves_along_the_heading(heading: float, speed: float) -> None:
    gap = preset("default").body.face + BALL_RADIUS + 0.0003
    world = one_robot(pose=(0, 0, heading), ball=(gap * cos(heading), gap * sin(heading), 0, 0))
    world.act({ME: RobotCommand(kick_speed=speed)})
    ball = world.truth().ball
    assert ball.vx / hypot(ball.vx, ball.vy) == pytest.approx(cos(heading), abs=1e-6)
    assert ball.vy / hypot(ball.vx, ball.vy) == pytest.approx(sin(heading), abs=1e-6)
    assert ball.speed == pytest.approx(speed, abs=0.02)


def test_a_turning_robot_gives_the_ball_its_sideways_velocity() -> None:
    world = holding("rsim")
    for _ in range(200):
        world.act({ME: RobotCommand(omega=10.0, dribbler=True)})
    me = world.truth().own[0]
    world.act({ME: RobotCommand(omega=10.0, kick_speed=5.0, dribbler=True)})
    ball = world.truth().ball
    # The ball sits about 0.103 m ahead: 10 rad/s give it about 1 m/s to the left of the heading.
    heading = me.heading
    sideways = cos(heading) * ball.vy - sin(heading) * ball.vx
    assert sideways == pytest.approx(10.0 * 0.103, rel=0.15)


def test_after_a_kick_the_dribbler_lets_the_ball_go_and_the_kicker_recharges() -> None:
    world = holding("grsim")
    world.act({ME: RobotCommand(kick_speed=0.3, dribbler=True)})
    assert world.kicks == [ME]
    again = []
    while world.time < 0.09:
        world.act({ME: RobotCommand(kick_speed=0.3, dribbler=True)})
        again += world.kicks
    assert again == []
    assert world.truth().ball.vx > 0.1


def test_a_single_kick_command_fires_once() -> None:
    world = holding(period=0.05)
    world.act({ME: RobotCommand(kick_speed=1.0)})
    assert world.kicks == [ME]
    world.act({})
    assert world.kicks == []


@settings(max_examples=60)
@given(
    speed=st.floats(2.0, 6.0),
    angle=st.floats(-0.9, 0.9),
    away=st.floats(0.3, 0.4),
    drives=st.floats(-0.5, 0.5),
    kind=st.sampled_from(["default", "sumatra"]),
)
def test_a_kick_on_contact_fires_before_the_ball_bounces(
    speed: float, angle: float, away: float, drives: float, kind: str
) -> None:
    # It comes at the middle of the mouth from ``angle`` beside the heading, as the robot sees it.
    mouth = preset(kind).body.face + BALL_RADIUS
    ball = (mouth + away * cos(angle), away * sin(angle), drives - speed * cos(angle), -speed * sin(angle))
    world = one_robot(kind, ball=(4.0, 2.5, 0.0, 0.0), period=1 / 60, field=DIVISION_B)
    world.reset(Placement({ME: (0, 0, 0)}, ball, {ME: (drives, 0)}), seed=0)
    while not world.kicks:
        world.act({ME: RobotCommand(vx=drives, kick_speed=4.0)})
        assert world.time < 1.5, "it never fires"
    seen, limits = world.truth().ball, preset(kind).limits
    assert seen.vx == pytest.approx(4.0 - limits.touch_returned * ball[2], abs=0.1)
    assert seen.vy == pytest.approx(limits.touch_kept * ball[3], abs=0.12 + 0.1 * abs(ball[3]))


@pytest.mark.parametrize(("carried", "faster"), [(None, -0.2), (0.0, 0.0), (0.9, 0.9)])
def test_a_kick_adds_to_the_speed_of_a_ball_that_moves_ahead(carried: float | None, faster: float) -> None:
    limits = {"touch_returned": 0.2, "kick_carried": carried}
    world = holding(settings_from({"limits": limits}))
    for _ in range(60):
        world.act({ME: RobotCommand(vx=1.0, dribbler=True)})
    world.act({ME: RobotCommand(vx=1.0, kick_speed=4.0)})
    assert world.truth().ball.vx == pytest.approx(4.0 + faster, abs=0.15)


@pytest.mark.parametrize(("carried", "faster"), [(None, 0.0), (0.9, 0.9)])
def test_a_kick_adds_the_speed_of_a_robot_that_drives_into_the_ball(
    carried: float | None, faster: float
) -> None:
    world = one_robot(settings_from({"limits": {"kick_carried": carried}}))
    while not world.kicks:
        if world.truth().own[0].speed < 0.99:
            world.put_ball(world.truth().own[0].x + 0.2, 0.0, 0.0, 0.0)
        world.act({ME: RobotCommand(vx=1.0, kick_speed=4.0)})
    assert world.truth().ball.vx == pytest.approx(4.0 + faster, abs=0.15)


def test_a_carried_ball_may_leave_faster_than_the_kicker_alone_would_send_it() -> None:
    world = holding(settings_from({"limits": {"kick_carried": 1.0}, "kicker": {"max_speed": 4.0}}))
    for _ in range(60):
        world.act({ME: RobotCommand(vx=1.0, dribbler=True)})
    world.act({ME: RobotCommand(vx=1.0, kick_speed=6.0)})
    assert world.truth().ball.vx == pytest.approx(5.0, abs=0.15)


def test_a_kicker_fires_again_only_when_it_is_charged_but_dribbles_before() -> None:
    world = holding(settings_from({"kicker": {"charge": 0.5, "recharge": 0.1}}))
    fired: list[float] = []
    held = 0
    while world.time < 1.2:
        if world.time > 0.1 and not world.truth().own[0].ball_contact:
            world.put_ball(0.0968, 0, 0, 0)
        world.act({ME: RobotCommand(kick_speed=0.5, dribbler=True)})
        fired += [world.time] * len(world.kicks)
        held += world.truth().own[0].ball_contact
    assert len(fired) == 3
    assert all(0.5 <= later - before < 0.51 for before, later in pairwise(fired))
    assert held > 100


def test_kicks_of_arenas_spread_each_by_its_own_seed() -> None:
    settings = settings_from({"kicker": {"speed_spread": 0.05, "recharge": 0.0}})
    n, place = 3, preset("default").body.face + BALL_RADIUS + 0.0003

    def speeds(seeds: list[int], kicks: int) -> FloatArray:
        arenas = Arenas(DIVISION_B, [None], settings, 0.005, n)
        arenas.seed(seeds)
        command = np.zeros((n, 1, 7))
        command[..., 3] = 4.0
        found = []
        for _ in range(kicks):
            arenas.place(np.zeros((n, 1, 3)), np.tile([place, 0.0, 0.0, 0.0], (n, 1)))
            arenas.step(command)
            found.append(arenas.balls[:, 2].copy())
        return np.array(found)

    found = speeds([5, 6, 7], 400)
    assert found.mean() == pytest.approx(4.0, rel=0.01)
    np.testing.assert_allclose(found.std(axis=0), 4.0 * 0.05, rtol=0.12)
    assert abs(np.corrcoef(found.T) - np.eye(n)).max() < 0.2
    assert (speeds([6, 5, 7], 20)[:, [1, 0, 2]] == found[:20]).all()
