"""How far the filter's estimate is from the truth, measured against the simulator."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from math import cos, hypot, pi, sin
from typing import Annotated

import numpy as np
import typer

from robobt.cli import MAX_SEED, Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.league.estimate.filter import VisionFilter
from robobt.league.serve.cameras import Cameras
from robobt.league.wire.vision import CameraFrame
from robobt.match import MatchLoop, Scenario, load_scenario
from robobt.sim import SimSettings, SimWorld, settings_from
from robobt.sim.realism import RealismSettings, realism_level
from robobt.world import DIVISION_B, Frame, Placement, RobotCommand, RobotId, Team, wrap_angle

PERIOD = 1 / 60
"""Time between two frames of the cameras [s]."""

_WARM_UP = 0.75
"""Time at the beginning that is not measured [s]."""

_PLACED = 0.25
"""How long the ball is not measured after the referee has put it down [s]."""

_RUN = 4.0
"""Duration of one run across the field [s]."""

Errors = dict[str, dict[str, list[float]]]
"""Errors by time of comparison and by quantity."""

Rms = dict[str, dict[str, float]]
"""Root mean squares of the errors."""


def bench_filter(
    scenario: Scenario,
    seconds: float = 60.0,
    seed: int = 0,
    realism: str | RealismSettings = "realistic",
    cameras: int = 1,
) -> dict[str, Rms]:
    """Measure root mean square errors of the filter's frames, in SI units and in the plane.

    Two situations: robots that drive straight ahead past a rolling ball
    ("constant_velocity"), and a match ("play"), each seen by noisy cameras. The
    filter knows blue's commands, in the match also yellow's. For each situation:
    the errors at the time of capture; then, at the time of the decision, with the
    latency compensated and not.

    Args:
        scenario: what is played in the match.
        seconds: simulated time of each situation [s].
        seed: of noise and match.
        realism: a level, or the name of one of :data:`robobt.sim.REALISM`.
        cameras: how many.
    """
    level = realism_level(realism) if isinstance(realism, str) else realism
    if not seconds > 2 * _WARM_UP:
        raise ValueError(f"the filter is measured for more than {2 * _WARM_UP} s, not {seconds}")
    # The cameras alone are late and noisy; the world itself only loses and delays commands.
    bare = RealismSettings(command_loss=level.command_loss, command_delay=level.command_delay)
    base = settings_from(scenario.simulator)
    seen = base.model_copy(update={"realism": level})
    real = base.model_copy(update={"realism": bare})
    rng = np.random.default_rng(seed)
    return {
        "constant_velocity": _straight(real, seen, seconds, cameras, rng),
        "play": _play(scenario.lasting(seconds), real, seen, seed, cameras, rng),
    }


class _Watcher:
    """Follows a world with a filter, with latency, and collects the errors."""

    def __init__(
        self, world: SimWorld, seen: SimSettings, cameras: int, rng: np.random.Generator, errors: Errors
    ) -> None:
        self._world = world
        self._cameras = Cameras(world.field, seen.realism, cameras, rng)
        self._filter = VisionFilter(world.field, seen)
        self._filter.cameras.update(self._cameras.calibrated)
        self._realism = seen.realism
        self._waiting: deque[tuple[float, list[CameraFrame], Frame]] = deque()
        self._ball_from = 0.0
        self._errors = errors

    def sent(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        self._filter.sent(self._world.time + self._realism.command_delay, commands)

    def ball_was_placed(self) -> None:
        """Skip the ball for a moment: it was picked up and put down elsewhere."""
        self._ball_from = self._world.time + _PLACED

    def look(self) -> None:
        """Capture a frame; use those that have arrived by now."""
        truth = self._world.truth()
        now = truth.time
        frames = self._cameras.capture(truth, now, now)
        self._waiting.append((now + self._realism.vision_delay, frames, truth))
        while self._waiting and self._waiting[0][0] <= now + 1e-9:
            _, frames, then = self._waiting.popleft()
            for frame in frames:
                self._filter.add(frame)
            if then.time < _WARM_UP:
                continue
            captured = self._filter.frame_at(then.time)
            ball = now >= self._ball_from
            for when, estimate, real in (
                ("at_capture", captured, then),
                ("compensated", self._filter.frame_at(now), truth),
                ("uncompensated", captured, truth),
            ):
                _compare(self._errors.setdefault(when, {}), estimate, real, ball)


def _straight(
    real: SimSettings, seen: SimSettings, seconds: float, cameras: int, rng: np.random.Generator
) -> Rms:
    """Repeat runs across the field for a number of seconds."""
    robots = [RobotId(team, number) for team in Team for number in range(4)]
    errors: Errors = {}
    for _ in range(max(1, round(seconds / _RUN))):
        world = SimWorld(DIVISION_B, dict.fromkeys(robots), real, PERIOD)
        placement = Placement(ball=(-4.0, 0.0, float(rng.uniform(1.2, 1.9)), 0.0))
        commands = {}
        for i, robot in enumerate(robots):
            heading, speed = float(rng.uniform(-pi, pi)), float(rng.uniform(0.3, 1.6))
            placement.robots[robot] = (-3.8, (i - 3.5) * 0.7, heading)
            commands[robot] = RobotCommand(speed * cos(heading), -speed * sin(heading))
        world.reset(placement, int(rng.integers(2**31)))
        watcher = _Watcher(world, seen, cameras, rng, errors)
        known = {robot: command for robot, command in commands.items() if robot.team is Team.BLUE}
        for _ in range(round(_RUN / PERIOD)):
            watcher.look()
            watcher.sent(known)
            world.act(commands)
    return _rms(errors)


def _play(
    scenario: Scenario,
    real: SimSettings,
    seen: SimSettings,
    seed: int,
    cameras: int,
    rng: np.random.Generator,
) -> Rms:
    errors: Errors = {}

    class Watched(SimWorld):
        """The simulated world, followed by the filter."""

        def __init__(self, scenario: Scenario) -> None:
            robots = {robot: setup.limits_over(real.limits) for robot, setup in scenario.robots}
            super().__init__(scenario.field, robots, real, PERIOD)
            self._watcher = _Watcher(self, seen, cameras, rng, errors)

        def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
            self._watcher.look()
            self._watcher.sent({robot: commands.get(robot, RobotCommand()) for robot, _ in scenario.robots})
            super().act(commands)

        def place_ball(self, x: float, y: float) -> None:
            self._watcher.ball_was_placed()
            super().place_ball(x, y)

    MatchLoop(scenario.model_copy(update={"period": PERIOD}), seed, Watched).play()
    return _rms(errors)


def _compare(errors: dict[str, list[float]], estimate: Frame, truth: Frame, with_ball: bool) -> None:
    """Add the errors of one frame."""
    found = estimate.robots()

    def add(name: str, value: float) -> None:
        errors.setdefault(name, []).append(value)

    for robot, real in truth.robots().items():
        guess = found.get(robot)
        add("missing_robots", 0.0 if guess else 1.0)
        if guess is None:
            continue
        add("robot_position", hypot(guess.x - real.x, guess.y - real.y))
        add("robot_heading", abs(wrap_angle(guess.heading - real.heading)))
        add("robot_velocity", hypot(guess.vx - real.vx, guess.vy - real.vy))
        add("robot_turn", abs(guess.omega - real.omega))
    if with_ball:
        ball, real_ball = estimate.ball, truth.ball
        add("ball_position", hypot(ball.x - real_ball.x, ball.y - real_ball.y))
        add("ball_velocity", hypot(ball.vx - real_ball.vx, ball.vy - real_ball.vy))


def _rms(errors: Errors) -> Rms:
    """Return root mean squares; of missing robots, the share."""
    figures: Rms = {}
    for when, quantities in errors.items():
        figures[when] = {}
        for name, values in quantities.items():
            array = np.asarray(values)
            missing = name == "missing_robots"
            figures[when][name] = float(array.mean() if missing else np.sqrt((array**2).mean()))
    return figures


def filter_(
    scenario: Annotated[
        str, typer.Argument(help="The match: a scenario file or the name of a bundled one.")
    ] = "six_v_six",
    seconds: Annotated[
        float, typer.Option("--seconds", min=2, max=3600, help="Simulated time of each situation.")
    ] = 60.0,
    realism: Annotated[
        str, typer.Option("--realism", help="none, friendly, rc2021 or realistic.")
    ] = "realistic",
    cameras: Annotated[
        int, typer.Option("--cameras", min=1, max=16, help="Cameras that share the field.")
    ] = 1,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure the filter's errors against the simulator's truth: root mean squares in the plane.

    Keys of --json: realism, seed, seconds, cameras, latency, noise (robot,
    ball, heading); constant_velocity and play, each with at_capture (the estimate
    against the truth at the capture's time), compensated and uncompensated
    (against the truth when the frame is used), each with robot_position,
    robot_heading, robot_velocity, robot_turn, ball_position, ball_velocity (SI)
    and missing_robots (share).
    """

    loaded = load_scenario(scenario)
    level = realism_level(realism)
    with errors.status("filtering"):
        situations = bench_filter(loaded, seconds, seed, realism, cameras)
    if as_json:
        noise = {"robot": level.robot_noise, "ball": level.ball_noise, "heading": level.heading_noise}
        given = {"realism": realism, "seed": seed, "seconds": seconds, "cameras": cameras}
        print_json(given | {"latency": level.vision_delay, "noise": noise} | situations)
        return
    say(
        f"Noise of the cameras ({realism}), an axis: robot {level.robot_noise * 1e3:.1f} mm, "
        f"ball {level.ball_noise * 1e3:.1f} mm, heading {level.heading_noise:.3f} rad; "
        f"latency {level.vision_delay * 1e3:.0f} ms."
    )
    for situation, title in (("constant_velocity", "at constant velocity"), ("play", "in a match")):
        listed = table(title, "robot, mm", "rad", "m/s", "rad/s", "ball, mm", "m/s")
        for when, rms in situations[situation].items():
            listed.add_row(when.replace("_", " "), *_row(rms))
        console.print(listed)


def _row(rms: dict[str, float]) -> list[str]:
    return [
        f"{rms['robot_position'] * 1e3:.2f}",
        f"{rms['robot_heading']:.4f}",
        f"{rms['robot_velocity']:.3f}",
        f"{rms['robot_turn']:.3f}",
        f"{rms['ball_position'] * 1e3:.2f}",
        f"{rms['ball_velocity']:.3f}",
    ]
