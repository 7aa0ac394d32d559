"""All that is identified of a field and its robots."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import sqrt

import numpy as np

from robobt.config.wording import counted
from robobt.identify.ball import BallEstimate, identify_ball, model_of
from robobt.identify.cameras import CameraEstimate, identify_cameras
from robobt.identify.estimate import Estimate, not_negative, scaled, unseen
from robobt.identify.free_ball import stretches
from robobt.identify.hops import HopEstimate, identify_hops
from robobt.identify.kicks import KickEstimate, identify_kicks
from robobt.identify.noise import NoiseEstimate, identify_noise
from robobt.identify.observations import Observations
from robobt.identify.opponents import identify_opponent
from robobt.identify.robots import RobotEstimate, identify_robot
from robobt.identify.views import without_offsets

_LEAST_PICTURES = 100
"""Fewer pictures than this hold nothing that could be identified."""


@dataclass(frozen=True, slots=True)
class Identification:
    """What was identified of a field and its robots.

    Attributes:
        seconds: length of the play that it rests on [s].
        ball: how the ball slides and rolls.
        hops: how a chipped ball hops.
        kicks: what kicks do.
        noise: noise and gaps.
        cameras: by how much cameras see things shifted.
        delay: whole delay from a command to its seen effect, over all robots whose commands are known [s].
        robots: each robot's figures.
    """

    seconds: float
    ball: BallEstimate
    hops: HopEstimate
    kicks: KickEstimate
    noise: NoiseEstimate
    cameras: CameraEstimate
    delay: Estimate
    robots: tuple[RobotEstimate, ...]

    def figures(self) -> Iterator[tuple[str, Estimate]]:
        """Yield every figure with its dotted name, such as ``ball.slide_deceleration``."""
        for name in ("slide_deceleration", "roll_deceleration", "switch_share"):
            yield f"ball.{name}", getattr(self.ball, name)
        for name, figure in self.hops._asdict().items():
            yield f"ball.{name}", figure
        for name, figure in self.kicks._asdict().items():
            yield f"kicks.{name}", figure
        yield "noise.ball_noise", self.ball.noise
        for name, figure in self.noise._asdict().items():
            yield f"noise.{name}", figure
        yield "noise.object_offset", self.cameras.size
        for camera, offset in self.cameras.offsets.items():
            yield f"camera {camera}.x", offset.x
            yield f"camera {camera}.y", offset.y
        yield "delay", self.delay
        for robot in self.robots:
            for name, figure in robot.figures.items():
                yield f"{robot.robot}.{name}", figure


def parts_of(seen: Observations) -> int:
    """Return how many parts the work of :func:`identify` has: the ball and each robot."""
    return 1 + len(seen.robots)


def identify(seen: Observations, on_part: Callable[[], None] = lambda: None) -> Identification:
    """Identify the ball, the robots, delay and noise from what cameras saw and what robots were sent.

    A minute of ordinary play is enough for most figures.

    Args:
        seen: the observations.
        on_part: called after each part of the work, of which there are :func:`parts_of`.

    Returns:
        every figure with its 95 % interval; those that were not seen enough say so.

    Raises:
        ValueError: there are hardly any pictures.
    """
    if len(seen) < _LEAST_PICTURES:
        raise ValueError(f"holds {counted(len(seen), 'picture')}, too few to identify anything")
    cameras = identify_cameras(seen.views)
    seen = without_offsets(seen, cameras)
    noise = identify_noise(seen)
    free = stretches(seen)
    ball = identify_ball(seen, free)
    # The mean of several cameras has less noise than a detection.
    ball = ball._replace(noise=scaled(ball.noise, 1.0 / sqrt(seen.alone)))
    hops = identify_hops(seen, free, model_of(ball), ball.noise.value if ball.noise.seen else _USUAL_NOISE)
    on_part()
    usual = noise.robot_noise.value if noise.robot_noise.seen else _USUAL_NOISE
    robots = []
    for place in range(len(seen.robots)):
        own = seen.commanded(place)
        robots.append(identify_robot(seen, place) if own else identify_opponent(seen, place, usual))
        on_part()
    delay = _together([robot.figures["delay"] for robot in robots])
    kicks = identify_kicks(seen, ball.kicks, delay.value - seen.age if delay.seen else None)
    seconds = float(seen.times[-1] - seen.times[0])
    return Identification(seconds, ball, hops, kicks, noise, cameras, delay, tuple(robots))


_USUAL_NOISE = 0.001
"""Noise of a position where it was not seen [m]."""


def _together(figures: list[Estimate]) -> Estimate:
    """Return the mean of figures that robots share, weighted by how well each is known."""
    known = [figure for figure in figures if figure.seen]
    if not known:
        return unseen(0, "s")
    values = np.array([figure.value for figure in known])
    errors = np.array([max(figure.half_width, 1e-6) / 1.96 for figure in known])
    weights = 1.0 / errors**2
    mean = float(np.sum(weights * values) / np.sum(weights))
    # Where robots differ by more than their errors, it is the robots that differ.
    excess = float(np.sum(weights * (values - mean) ** 2)) / max(len(values) - 1, 1)
    half = 1.96 * sqrt(max(excess, 1.0) / float(np.sum(weights)))
    half = max(half, float(errors.min()) * 1.96) if len(values) > 1 else half
    return not_negative(Estimate(mean, mean - half, mean + half, len(values), True, "s"))


def as_json(identified: Identification) -> dict[str, object]:
    """Return all figures as data for other programs: value, low, high, count, seen and unit, by name."""
    return {
        "seconds": identified.seconds,
        "figures": {
            name: {
                "value": float(it.value) if it.seen else None,
                "low": float(it.low) if it.seen else None,
                "high": float(it.high) if it.seen else None,
                "count": int(it.count),
                "seen": bool(it.seen),
                "unit": it.unit,
            }
            for name, it in identified.figures()
        },
    }
