"""How well the filter tells chips from flat kicks and where they land, against the simulator."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, hypot, pi, sin, sqrt
from typing import Annotated, Any

import numpy as np
import typer

from robobt.cli import MAX_SEED, Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.league.estimate.filter import VisionFilter
from robobt.league.serve.cameras import Cameras
from robobt.sim import SimSettings, SimWorld, settings_from
from robobt.sim.realism import RealismSettings
from robobt.world import (
    BALL_RADIUS,
    DIVISION_B,
    ROBOT_RADIUS,
    BallState,
    Frame,
    Placement,
    RobotCommand,
    RobotId,
    Team,
)
from robobt.world.ball_model import GRAVITY
from robobt.world.command import CHIP_ANGLE

PERIOD = 1 / 60
"""Time between two frames of the cameras [s]."""

SHARES = (0.0, 0.25, 0.5, 0.75)
"""Where in the flight the prediction is compared: from the first one on, and from these shares on."""

PERCENTILES = (50, 90, 95, 99)

_KICKER = RobotId(Team.BLUE, 0)
_OTHERS = [RobotId(Team.BLUE, 1), RobotId(Team.BLUE, 2), *[RobotId(Team.YELLOW, i) for i in range(3)]]
_SPEEDS = (2.5, 6.2)
"""Slowest and fastest kick [m/s]."""

_SETTLE, _LATEST, _FOLLOWED = 0.3, 1.5, 1.0
"""Earliest and latest time of the kick, and how long it is followed [s]."""

_IN_THE_AIR = 0.05
"""A ball that the filter has higher than this flies [m]."""


@dataclass(slots=True)
class _Kick:
    """The result of a kick.

    Attributes:
        flew: whether the filter ever had the ball in the air.
        landed: whether the ball touched down on the field, from an undisturbed flight.
        predictions: in order, the share of the flight after which each was made and how far off it was [m].
    """

    flew: bool = False
    landed: bool = False
    predictions: list[tuple[float, float]] = field(default_factory=list)


def bench_chips(
    settings: SimSettings, chips: int = 500, flat: int = 500, seed: int = 0, cameras: int = 1
) -> dict[str, Any]:
    """Measure the filter on chips and on flat kicks at 2.5 to 6.2 m/s from anywhere, in any direction.

    The kicker drives at a resting ball; five other robots stand about, and no command is known. What the
    filter has is judged at every frame: a prediction is where a ball at its place and height first touches
    down with its velocities. A chip that meets a robot, or leaves the field before it touches down, is not
    counted; a flat kick is followed for a second, whatever it meets.

    Args:
        settings: of the simulator; its realism is the cameras'.
        chips: kicks to make.
        flat: the same.
        seed: of all randomness.
        cameras: how many share the field.

    Returns:
        chips (counted), recognised, landing_error (by the share of the flight from which on the first
        prediction is taken: n and percentiles in m), flat, taken_for_chips.
    """
    rng = np.random.default_rng(seed)
    kicks = [_kick(settings, rng, cameras, CHIP_ANGLE) for _ in range(chips)]
    landed = [kick for kick in kicks if kick.landed]
    errors = {}
    for share in SHARES:
        first = [
            next(error for at, error in kick.predictions if at >= share)
            for kick in landed
            if kick.predictions and kick.predictions[-1][0] >= share
        ]
        values = np.percentile(first, PERCENTILES).tolist() if first else []
        named = {f"p{percent}": value for percent, value in zip(PERCENTILES, values, strict=False)}
        errors[f"{share:g}"] = {"n": len(first), **named}
    return {
        "chips": len(landed),
        "recognised": sum(bool(kick.predictions) for kick in landed),
        "landing_error": errors,
        "flat": flat,
        "taken_for_chips": sum(_kick(settings, rng, cameras, 0.0).flew for _ in range(flat)),
    }


def _kick(settings: SimSettings, rng: np.random.Generator, cameras: int, angle: float) -> _Kick:
    bare = settings.model_copy(update={"realism": RealismSettings()})
    world = SimWorld(DIVISION_B, dict.fromkeys([_KICKER, *_OTHERS]), bare, PERIOD)
    world.reset(_placement(settings, rng), 0)
    eyes = Cameras(DIVISION_B, settings.realism, cameras, rng)
    watch = VisionFilter(DIVISION_B, settings)
    watch.cameras.update(eyes.calibrated)
    speed, kick = float(rng.uniform(*_SPEEDS)), _Kick()
    predicted: list[tuple[float, float, float]] = []
    before: Frame | None = None
    left: float | None = None
    while left is None or world.time < left + _FOLLOWED:
        truth = world.truth()
        for frame in eyes.capture(truth, truth.time, truth.time):
            watch.add(frame)
        seen = watch.frame_at(truth.time).ball
        if left is not None and seen.z > _IN_THE_AIR:
            kick.flew = True
            predicted.append((truth.time, *_landing(seen)))
        if left is not None and before is not None and before.ball.z > 0.0:
            ball, old = truth.ball, before.ball
            if ball.vz > old.vz:
                x, y = _landing(old)
                lasted = before.time + _falls(old) - left
                kick.landed = DIVISION_B.contains(x, y)
                kick.predictions = [
                    ((time - left) / lasted, hypot(px - x, py - y)) for time, px, py in predicted
                ]
            if ball.vz > old.vz or (ball.vx, ball.vy) != (old.vx, old.vy):
                return kick
        before = truth
        kicks = world.time > _SETTLE and left is None
        world.act({_KICKER: RobotCommand(0.5, kick_speed=speed, kick_angle=angle)} if kicks else {})
        if world.kicks:
            ball = world.truth().ball
            risen = (sqrt(ball.vz * ball.vz + 2.0 * GRAVITY * ball.z) - ball.vz) / GRAVITY
            left = world.time - (risen if angle else PERIOD / 2)
        elif world.time > _LATEST:
            return kick
    return kick


def _placement(settings: SimSettings, rng: np.random.Generator) -> Placement:
    """Return a ball somewhere, the kicker 2 to 7 cm behind it, the others where they may stand in its way."""
    x, y = float(rng.uniform(-4.0, 4.0)), float(rng.uniform(-2.5, 2.5))
    heading = float(rng.uniform(-pi, pi))
    behind = settings.body.face + BALL_RADIUS + float(rng.uniform(0.02, 0.07))
    placed = [(x - behind * cos(heading), y - behind * sin(heading), heading)]
    while len(placed) <= len(_OTHERS):
        place = float(rng.uniform(-4.2, 4.2)), float(rng.uniform(-2.8, 2.8))
        apart = min(hypot(place[0] - other[0], place[1] - other[1]) for other in placed)
        if apart > 3 * ROBOT_RADIUS and hypot(place[0] - x, place[1] - y) > 4 * ROBOT_RADIUS:
            placed.append((*place, float(rng.uniform(-pi, pi))))
    return Placement(dict(zip([_KICKER, *_OTHERS], placed, strict=True)), (x, y, 0.0, 0.0))


def _falls(ball: BallState) -> float:
    """Return how long a ball in the air takes to touch down [s]."""
    return (ball.vz + sqrt(ball.vz * ball.vz + 2.0 * GRAVITY * ball.z)) / GRAVITY


def _landing(ball: BallState) -> tuple[float, float]:
    left = _falls(ball)
    return ball.x + left * ball.vx, ball.y + left * ball.vy


def chips(
    preset: Annotated[str, typer.Option("--preset", help="Of the simulator.")] = "default",
    realism: Annotated[
        str, typer.Option("--realism", help="none, friendly, rc2021 or realistic.")
    ] = "realistic",
    cameras: Annotated[
        int, typer.Option("--cameras", min=1, max=16, help="Cameras that share the field.")
    ] = 1,
    chips: Annotated[int, typer.Option("--chips", min=1, max=100_000, help="Chips to make.")] = 500,
    flat: Annotated[int, typer.Option("--flat", min=1, max=100_000, help="Flat kicks to make.")] = 500,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure how the filter tells chips from flat kicks and predicts where they touch down.

    Kicks at 2.5 to 6.2 m/s by a robot that drives at a resting ball, five others about, no command known.
    A prediction is where the ball touches down from what a frame shows of it.

    Keys of --json: preset, realism, cameras, seed; chips (that touched down on the field, untouched),
    recognised; landing_error, by the share of the flight from which on the first prediction is taken: n,
    p50, p90, p95, p99 (m); flat, taken_for_chips.
    """

    with errors.status("kicking"):
        settings = settings_from({"preset": preset, "realism": realism})
        figures = bench_chips(settings, chips, flat, seed, cameras)
    if as_json:
        print_json({"preset": preset, "realism": realism, "cameras": cameras, "seed": seed, **figures})
        return
    say(
        f"{figures['recognised']} of {figures['chips']} chips recognised, "
        f"{figures['taken_for_chips']} of {figures['flat']} flat kicks taken for chips."
    )
    listed = table("from, of the flight", "chips", "50 %", "90 %", "95 %", "99 % within, m")
    for share, error in figures["landing_error"].items():
        values = [f"{error[name]:.3f}" if name in error else "-" for name in ("p50", "p90", "p95", "p99")]
        listed.add_row(f"{float(share):.0%}", str(error["n"]), *values)
    console.print(listed)
