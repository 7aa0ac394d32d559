"""A play with parameters and a world without physics, for tests of scenarios and the loop."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, hypot, sin
from typing import Any

import numpy as np

from robobt.match import Scenario
from robobt.plays import PLAYS
from robobt.skills.base import Skill
from robobt.tree import Behaviour, Status
from robobt.world import BallState, Frame, Placement, RobotCommand, RobotId, RobotState, Team, World
from robobt.world.geometry import wrap_angle

MOUTH = 0.1
"""Centre of the robot to the centre of a ball it has [m]."""


_SPOILT: dict[str, Any] = {
    "nan": RobotCommand(vx=float("nan")),
    "huge": RobotCommand(vx=10**400),
    "words": RobotCommand(vx="fast"),  # type: ignore[arg-type]
    "nothing": None,
}
"""Commands that no robot can be sent."""


class Scripted(Skill):
    """Runs to the ball, waits and kicks it straight ahead; can be told to break."""

    def __init__(self, *, speed: float, kick: float, breaks: str, name: str = "") -> None:
        super().__init__(name)
        self.speed, self.kick, self.breaks = speed, kick, breaks

    def on_interrupt(self) -> None:
        if self.breaks:
            raise RuntimeError("broken again")

    def on_running(self) -> Status:
        if self.breaks == "raise":
            raise RuntimeError("broken on purpose")
        if self.breaks == "fail" or (self.breaks == "fail once" and self.frame.time == 0.0):
            return self.fail("cannot")
        if self.breaks in _SPOILT:
            self.store.command = _SPOILT[self.breaks]
            return self.run()
        me, ball = self.me, self.ball
        gap = hypot(ball.x - me.x, ball.y - me.y)
        if me.ball_contact:
            self.store.command = RobotCommand(kick_speed=self.kick)
            return self.run("kicks")
        speed = min(self.speed, (gap - MOUTH) / self.frame.period)
        dx, dy = (ball.x - me.x) / max(gap, 1e-9), (ball.y - me.y) / max(gap, 1e-9)
        c, s = cos(me.heading), sin(me.heading)
        self.store.command = RobotCommand(speed * (c * dx + s * dy), speed * (c * dy - s * dx))
        return self.run("runs")


def _scripted(
    *, speed: float = 1.0, kick: float = 0.0, breaks: str = "", corner: tuple[float, float] | None = None
) -> Behaviour:
    if speed < 0.0:
        raise ValueError("speed must not be negative")
    return Scripted(speed=speed, kick=kick, breaks=breaks)


if "scripted" not in PLAYS:
    PLAYS.register("scripted")(_scripted)


class PlainWorld(World):
    """Robots that drive at once, a little slower by the seed, and a ball that rolls without friction."""

    def __init__(self, scenario: Scenario) -> None:
        self.field, self.period = scenario.field, scenario.period
        self.ticks = 0
        self.pace = 1.0
        self.robots: dict[RobotId, tuple[float, float, float]] = {}
        self.ball = (0.0, 0.0, 0.0, 0.0)
        self.touch: RobotId | None = None
        self.acts: list[dict[RobotId, RobotCommand]] = []

    def reset(self, placement: Placement, seed: int) -> None:
        self.robots, self.ball = dict(placement.robots), placement.ball
        self.pace = 1.0 - 0.1 * float(np.random.default_rng(seed).random())

    def observe(self) -> Frame:
        return self.truth()

    def truth(self) -> Frame:
        states: dict[Team, list[RobotState]] = {Team.BLUE: [], Team.YELLOW: []}
        for robot, (x, y, heading) in sorted(self.robots.items()):
            near = hypot(self.ball[0] - x, self.ball[1] - y) < MOUTH + 0.01
            states[robot.team].append(RobotState(robot.number, x, y, heading, ball_contact=near))
        return Frame(
            self.ticks * self.period,
            self.field,
            BallState(*self.ball),
            tuple(states[Team.BLUE]),
            tuple(states[Team.YELLOW]),
            period=self.period,
            last_touch=self.touch,
        )

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        self.acts.append(dict(commands))
        self.ticks += 1
        x, y, vx, vy = self.ball
        for robot, command in commands.items():
            rx, ry, heading = self.robots[robot]
            if command.kick_speed and hypot(x - rx, y - ry) < MOUTH + 0.01:
                vx, vy = command.kick_speed * cos(heading), command.kick_speed * sin(heading)
                self.touch = robot
            c, s = cos(heading), sin(heading)
            self.robots[robot] = (
                rx + self.pace * self.period * (c * command.vx - s * command.vy),
                ry + self.pace * self.period * (s * command.vx + c * command.vy),
                wrap_angle(heading + self.period * command.omega),
            )
        self.ball = (x + self.period * vx, y + self.period * vy, vx, vy)

    def place_ball(self, x: float, y: float) -> None:
        self.ball = (x, y, 0.0, 0.0)


def data(**changes: Any) -> dict[str, Any]:
    """A valid scenario as plain data: blue 0 runs to the ball and kicks it."""
    scenario: dict[str, Any] = {
        "name": "test",
        "period": 0.02,
        "robots": {
            "blue": [
                {
                    "number": 0,
                    "play": "scripted",
                    "params": {"kick": 4.0},
                    "start": {"position": [-2.0, 0.0], "heading": 0.0},
                }
            ],
            "yellow": [],
        },
        "ball": {"position": [0.0, 0.0]},
        "ends": {"time_limit": 10.0},
    }
    return {**scenario, **changes}
