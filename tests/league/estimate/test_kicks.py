"""Kicks are found in where the ball was seen, once each, whatever was commanded and whenever."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robobt.league.estimate.kicks import Kick, KickWatch
from robobt.league.estimate.robot_track import RobotMotion, SentCommands
from robobt.sim.robot_settings import BodySettings
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import BALL_RADIUS, RobotId

PERIOD = 1 / 60
FACE = BodySettings().face
MOUTH = FACE + BALL_RADIUS
ME, IT = RobotId(Team.BLUE, 3), RobotId(Team.YELLOW, 1)
KICK = RobotCommand(kick_speed=6.0)


class Scene:
    """A robot that drives straight on, the ball on its way before it, and a watch that sees both.

    Args:
        ball: the ball's distance from the robot's centre at a time, along its heading [m].
        pose: the robot's at time 0 [m, m, rad].
        speed: of the robot [m/s].
        noise: standard deviation of the detections [m].
        sent: its commands; None for a robot that others command.
    """

    def __init__(
        self,
        pose: tuple[float, float, float] = (0.5, -0.3, 0.0),
        speed: float = 0.0,
        noise: float = 0.0,
        sent: SentCommands | None = None,
        seed: int = 0,
    ) -> None:
        self.pose, self.speed, self.sent = pose, speed, sent
        self.noise, self.random = noise, np.random.default_rng(seed)
        self.watch = KickWatch(FACE)
        self.kicks: list[Kick] = []

    def see(self, time: float, ahead: float, aside: float = 0.0) -> None:
        x, y, heading = self.pose
        c, s = cos(heading), sin(heading)
        x, y = x + c * self.speed * time, y + s * self.speed * time
        motions = {
            IT: RobotMotion(-3.0, 2.0, 1.0),
            ME: RobotMotion(x, y, heading, c * self.speed, s * self.speed),
        }
        dx, dy = self.random.normal(0.0, self.noise, 2)
        ball = x + c * ahead - s * aside + dx, y + s * ahead + c * aside + dy
        kick = self.watch.update(time, *ball, motions, {} if self.sent is None else {ME: self.sent})
        if kick is not None:
            self.kicks.append(kick)

    def shot(self, at: float, speed: float, gap: tuple[float, float] = (9.0, 9.0)) -> list[Kick]:
        """Watch for a second a ball that lies in the mouth and is kicked; frames in the gap are missing."""
        for i in range(61):
            time = i * PERIOD
            if not gap[0] <= time < gap[1]:
                self.see(time, MOUTH + max(0.0, time - at) * speed)
        return self.kicks


@given(
    at=st.floats(0.2, 0.4),
    speed=st.floats(1.5, 6.5),
    drives=st.floats(-1.0, 3.0),
    heading=st.floats(-pi, pi),
    told=st.booleans(),
    seed=st.integers(0, 2**32 - 1),
)
@example(at=0.21875, speed=1.5, drives=0.0, heading=-2.0, told=True, seed=284226)
def test_every_kick_is_seen_once(
    at: float, speed: float, drives: float, heading: float, told: bool, seed: int
) -> None:
    # Told once only, and some time before the ball is seen to leave.
    sent = [(0.0, RobotCommand()), (at - 0.05, RobotCommand(kick_speed=speed)), (at - 0.03, RobotCommand())]
    scene = Scene(
        (0.5, -0.3, heading), max(drives, 0.0) if not told else drives, 0.0014, sent if told else None, seed
    )
    (kick,) = scene.shot(at, speed)
    assert kick.robot == ME
    # Of a weak kick that was commanded 6 mm between two frames are enough, which noise shows a frame early
    # once in a thousand.
    assert at - PERIOD < kick.time <= at + 2.5 * PERIOD


@given(st.floats(0.0, 2.5), st.floats(-pi, pi), st.integers(0, 2**32 - 1))
def test_a_ball_that_lies_in_the_mouth_is_not_kicked(drives: float, heading: float, seed: int) -> None:
    for sent in (None, [(0.0, KICK)]):
        scene = Scene((0.0, 0.0, heading), drives, 0.0014, sent, seed)
        assert scene.shot(9.0, 0.0) == []


def test_a_weak_kick_counts_if_it_was_commanded() -> None:
    assert len(Scene(sent=[(0.0, RobotCommand(kick_speed=1.0))]).shot(0.3, 0.8)) == 1
    assert Scene().shot(0.3, 0.8) == []


def test_the_kick_of_a_robot_that_was_not_told_to_is_none() -> None:
    assert Scene(sent=[(0.0, RobotCommand(vx=2.0))]).shot(0.3, 3.0) == []


def test_a_kick_while_the_ball_is_hidden_is_seen_afterwards() -> None:
    (kick,) = Scene(sent=[(0.0, KICK)]).shot(0.3, 5.0, gap=(0.1, 0.33))
    assert kick.time <= 0.4


def test_a_ball_that_starts_off_fast_but_is_stopped_at_once_was_not_kicked() -> None:
    scene = Scene(sent=[(0.0, KICK)])
    for i in range(61):
        time = i * PERIOD
        # 4 cm at 2.5 m/s, then on at 0.2 m/s, as when it hits somebody.
        fast = min(max(0.0, time - 0.3), 0.016)
        scene.see(time, MOUTH + 2.5 * fast + 0.2 * max(0.0, time - 0.316))
    assert scene.kicks == []


def test_two_kicks_in_a_row_are_two() -> None:
    scene = Scene(sent=[(0.0, KICK)])
    scene.shot(0.3, 5.0)
    for i in range(61):
        time = 1.5 + i * PERIOD
        scene.see(time, MOUTH + max(0.0, time - 2.0) * 5.0)
    assert len(scene.kicks) == 2


@pytest.mark.parametrize("incoming", [1.0, 2.5, 5.0])
def test_a_ball_that_bounces_off_is_not_kicked(incoming: float) -> None:
    scene = Scene()
    for i in range(61):
        time = i * PERIOD
        way = incoming * (time - 0.5)
        scene.see(time, MOUTH + (-way if way < 0.0 else 0.5 * way))
    assert scene.kicks == []


@pytest.mark.parametrize("incoming", [1.0, 2.5])
def test_a_ball_kicked_as_it_comes_is_kicked(incoming: float) -> None:
    scene = Scene(sent=[(0.0, KICK)])
    for i in range(61):
        time = i * PERIOD
        way = incoming * (time - 0.51)
        scene.see(time, MOUTH + (-way if way < 0.0 else 6.0 * (time - 0.51)))
    assert len(scene.kicks) == 1


def test_a_ball_that_rolls_past_is_not_kicked() -> None:
    for sent in (None, [(0.0, KICK)]):
        scene = Scene(sent=sent)
        for i in range(61):
            scene.see(i * PERIOD, -1.0 + i * PERIOD * 3.0, aside=0.13)
        assert scene.kicks == []


@pytest.mark.parametrize("braking", [4.0, 8.0, 12.0])
def test_a_robot_that_brakes_behind_the_ball_has_not_kicked_it(braking: float) -> None:
    """Not even where it brakes so hard that the ball leaves it as fast as one that was kicked."""
    scene = Scene()
    x = ball = 0.0
    speed = 2.5
    for i in range(61):
        speed = max(0.0, speed - (braking * PERIOD if i > 20 else 0.0))
        x += speed * PERIOD
        ball += (2.5 + 0.01 * (i - 20) if i > 20 else speed) * PERIOD
        scene.pose = (x, 0.0, 0.0)
        scene.see(i * PERIOD, MOUTH + ball - x)
    assert scene.kicks == []


def test_a_ball_seen_in_the_mouth_once_more_after_a_kick_was_kicked_once() -> None:
    """As by a second camera, which is late."""
    scene = Scene(sent=[(0.0, KICK)])
    for i in range(61):
        away = 6.0 * max(0.0, (i - 20) * PERIOD)
        scene.see(i * PERIOD, MOUTH + (0.0 if i == 22 else away))
    assert len(scene.kicks) == 1
