"""How far the filter is from the truth, measured against the simulator."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from math import cos, hypot, pi, sin
from typing import Any

import numpy as np

from robobt.league.estimate.filter import VisionFilter
from robobt.league.serve.cameras import Cameras
from robobt.match.loop import Match
from robobt.match.scenario.scenario import Scenario
from robobt.sim import SimSettings, SimWorld, settings_from
from robobt.sim.settings import REALISM
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.protocol import Placement
from robobt.world.state import Frame, RobotId, RobotState

PERIOD = 1 / 60
"""Time between two frames of the cameras [s]."""

_WARM_UP = 0.75
"""What is left out at the beginning [s]."""

_PLACED = 0.25
"""What is left out of the ball after the referee has put it down [s]."""

_Errors = dict[str, list[float]]


def bench_filter(
    scenario: Scenario, seconds: float = 60.0, seed: int = 0, realism: str = "realistic", cameras: int = 1
) -> dict[str, Any]:
    """Root mean square errors of the filter's frames, in SI units and the plane.

    Two situations: robots that drive straight ahead past a rolling ball
    ("constant_velocity"), and a match ("play"), each seen by noisy cameras. In
    both, blue's commands are known to the filter and yellow's in the match too.
    For each: the errors at capture time; then, at the time of the decision, with
    the latency compensated and not.

    Args:
        scenario: what is played in the match.
        seconds: simulated time of each situation [s].
        seed: of noise and match.
        realism: a level of :data:`robobt.sim.settings.REALISM`.
        cameras: how many.

    Raises:
        KeyError: no such level of realism.
        ValueError: an argument out of range.
    """
    if realism not in REALISM:
        raise KeyError(f"no realism level is called {realism!r}; there are {', '.join(REALISM)}")
    if not seconds > 2 * _WARM_UP:
        raise ValueError(f"the filter is measured for more than {2 * _WARM_UP} s, not {seconds}")
    level = REALISM[realism]
    delay = level.vision_delay
    # The world under the cameras: what is late and noisy is what they report.
    bare = level.model_copy(
        update={
            "ball_noise": 0.0,
            "robot_noise": 0.0,
            "heading_noise": 0.0,
            "missing_ball": 0.0,
            "missing_robot": 0.0,
            "vision_delay": 0.0,
        }
    )
    base = settings_from(scenario.simulator)
    figures: dict[str, Any] = {
        "realism": realism,
        "seed": seed,
        "seconds": seconds,
        "cameras": cameras,
        "latency": delay,
        "noise": {
            "robot": level.robot_noise,
            "ball": level.ball_noise,
            "heading": level.heading_noise,
        },
    }
    rng = np.random.default_rng(seed)
    seen = base.model_copy(update={"realism": level})
    real = base.model_copy(update={"realism": bare})
    figures["constant_velocity"] = _straight(real, seen, seconds, cameras, rng)
    figures["play"] = _play(scenario, real, seen, seconds, seed, cameras, rng)
    return figures


class _Watcher:
    """Follows a world with a filter, a latency behind, and notes how far they are apart."""

    def __init__(self, world: SimWorld, seen: SimSettings, cameras: int, rng: np.random.Generator) -> None:
        self._world = world
        self._cameras = Cameras(world.field, seen.realism, cameras, rng)
        self._filter = VisionFilter(world.field, seen)
        self._delay = seen.realism.vision_delay
        self._effect = seen.realism.command_delay
        self._waiting: deque[tuple[float, list[Any], Frame]] = deque()
        self._ball_from = 0.0
        self.at_capture: _Errors = {}
        self.compensated: _Errors = {}
        self.uncompensated: _Errors = {}

    def sent(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        self._filter.sent(self._world.time + self._effect, commands)

    def ball_was_placed(self) -> None:
        """The ball was picked up and put down: for a moment nobody can know where it is."""
        self._ball_from = self._world.time + _PLACED

    def look(self) -> None:
        """Take a picture; use those that have arrived by now."""
        truth = self._world.truth()
        now = truth.time
        poses = {robot: (s.x, s.y, s.heading) for robot, s in _all(truth)}
        frames = self._cameras.look(now, now, poses, truth.ball.position)
        self._waiting.append((now + self._delay, frames, truth))
        while self._waiting and self._waiting[0][0] <= now + 1e-9:
            _, frames, then = self._waiting.popleft()
            for frame in frames:
                self._filter.add(frame)
            if then.time < _WARM_UP:
                continue
            captured = self._filter.frame_at(then.time)
            ball = now >= self._ball_from
            _note(self.at_capture, captured, then, ball)
            _note(self.compensated, self._filter.frame_at(now), truth, ball)
            _note(self.uncompensated, captured, truth, ball)

    def figures(self) -> dict[str, dict[str, float]]:
        return {
            "at_capture": _rms(self.at_capture),
            "compensated": _rms(self.compensated),
            "uncompensated": _rms(self.uncompensated),
        }


def _straight(
    real: SimSettings, seen: SimSettings, seconds: float, cameras: int, rng: np.random.Generator
) -> dict[str, dict[str, float]]:
    """Runs across the field until there are enough of them."""
    field = DIVISION_B
    robots = [RobotId(team, number) for team in Team for number in range(4)]
    total: list[_Errors] = [{}, {}, {}]
    run = 4.0
    for _ in range(max(1, round(seconds / run))):
        world = SimWorld(field, dict.fromkeys(robots), real, PERIOD)
        placement = Placement(ball=(-4.0, 0.0, float(rng.uniform(1.2, 1.9)), 0.0))
        commands = {}
        for i, robot in enumerate(robots):
            heading, speed = float(rng.uniform(-pi, pi)), float(rng.uniform(0.3, 1.6))
            y = (i - 3.5) * 0.7
            placement.robots[robot] = (-3.8, y, heading)
            commands[robot] = RobotCommand(speed * cos(heading), -speed * sin(heading))
        world.reset(placement, int(rng.integers(2**31)))
        watcher = _Watcher(world, seen, cameras, rng)
        known = {robot: command for robot, command in commands.items() if robot.team is Team.BLUE}
        for _ in range(round(run / PERIOD)):
            watcher.look()
            watcher.sent(known)
            world.act(commands)
        for errors, more in zip(
            total, (watcher.at_capture, watcher.compensated, watcher.uncompensated), strict=True
        ):
            for name, values in more.items():
                errors.setdefault(name, []).extend(values)
    names = ("at_capture", "compensated", "uncompensated")
    return {name: _rms(errors) for name, errors in zip(names, total, strict=True)}


def _play(
    scenario: Scenario,
    real: SimSettings,
    seen: SimSettings,
    seconds: float,
    seed: int,
    cameras: int,
    rng: np.random.Generator,
) -> dict[str, dict[str, float]]:
    watchers: list[_Watcher] = []
    played = scenario.lasting(seconds).model_copy(update={"period": PERIOD})

    class Watched(SimWorld):
        """The simulated world, followed by the filter while it is played in."""

        def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
            watchers[0].look()
            watchers[0].sent({robot: commands.get(robot, RobotCommand()) for robot in self._ids})
            super().act(commands)

        def place_ball(self, x: float, y: float) -> None:
            watchers[0].ball_was_placed()
            super().place_ball(x, y)

    def watched_world(scenario: Scenario) -> SimWorld:
        robots = {robot: setup.limits_over(real.limits) for robot, setup in scenario.robots}
        world = Watched(scenario.field, robots, real, scenario.period)
        watchers.append(_Watcher(world, seen, cameras, rng))
        return world

    Match(played, seed, watched_world).play()
    return watchers[0].figures()


def _all(frame: Frame) -> list[tuple[RobotId, RobotState]]:
    own = [(RobotId(Team.BLUE, robot.id), robot) for robot in frame.own]
    return own + [(RobotId(Team.YELLOW, robot.id), robot) for robot in frame.opponents]


def _note(errors: _Errors, estimate: Frame, truth: Frame, with_ball: bool) -> None:
    found = dict(_all(estimate))

    def add(name: str, value: float) -> None:
        errors.setdefault(name, []).append(value)

    for robot, real in _all(truth):
        guess = found.get(robot)
        add("missing_robots", 0.0 if guess else 1.0)
        if guess is None:
            continue
        add("robot_position", hypot(guess.x - real.x, guess.y - real.y))
        add("robot_heading", abs(wrap_angle(guess.heading - real.heading)))
        add("robot_velocity", hypot(guess.vx - real.vx, guess.vy - real.vy))
        add("robot_turn", abs(guess.omega - real.omega))
    if not with_ball:
        return
    ball, real_ball = estimate.ball, truth.ball
    add("ball_position", hypot(ball.x - real_ball.x, ball.y - real_ball.y))
    add("ball_velocity", hypot(ball.vx - real_ball.vx, ball.vy - real_ball.vy))


def _rms(errors: _Errors) -> dict[str, float]:
    figures = {}
    for name, values in errors.items():
        array = np.asarray(values)
        figures[name] = float(array.mean() if name == "missing_robots" else np.sqrt((array**2).mean()))
    return figures
