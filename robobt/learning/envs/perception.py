"""What is observed of the arenas: exactly, or with noise, latency and differenced velocities."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robobt.learning.envs.settings import NoiseSettings, TaskSettings
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.world.geometry import wrap_angles

CUT_OFF = 4.0
"""Standard deviations at which noise is cut off."""

Observe = Callable[[FloatArray, FloatArray], FloatArray]


class Perception:
    """How the state of ``n`` arenas is observed."""

    def __init__(
        self, settings: TaskSettings, observe: Observe, size: int, n: int, rng: np.random.Generator
    ) -> None:
        self._observe = observe
        self._noise = settings.noise
        self._noisy = settings.noise != NoiseSettings()
        self._differenced = settings.velocities == "finite_difference"
        self._period = settings.period
        self._rng = rng
        self._last_robots = np.zeros((n, 1, 6))
        self._last_balls = np.zeros((n, 4))
        self._late = np.zeros((settings.latency + 1, n, size))
        self._newest = 0
        self._all = np.arange(n)

    def look(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """Return the observations after a tick, (n, O)."""
        if self._noisy or self._differenced:
            robots, balls = self._disturbed(robots, balls, self._all, first=False)
        seen = self._observe(robots, balls)
        if len(self._late) == 1:
            return seen
        self._newest = (self._newest + 1) % len(self._late)
        self._late[self._newest] = seen
        late: FloatArray = self._late[(self._newest + 1) % len(self._late)].copy()
        return late

    def start(self, robots: FloatArray, balls: FloatArray, which: IntArray) -> FloatArray:
        """Return the first observations of the arenas ``which``, which have just been placed, (m, O)."""
        robots, balls = robots[which], balls[which]
        if self._noisy or self._differenced:
            robots, balls = self._disturbed(robots, balls, which, first=True)
        seen = self._observe(robots, balls)
        if len(self._late) > 1:
            self._late[:, which] = seen
        return seen

    def _disturbed(
        self, robots: FloatArray, balls: FloatArray, which: IntArray, first: bool
    ) -> tuple[FloatArray, FloatArray]:
        robots, balls, noise = robots.copy(), balls.copy(), self._noise
        if self._noisy:
            robots[..., :2] += self._draw(noise.robot_position, (len(which), 1, 2))
            robots[..., 2] = wrap_angles(robots[..., 2] + self._draw(noise.heading, (len(which), 1)))
            balls[:, :2] += self._draw(noise.ball_position, (len(which), 2))
        if self._differenced:
            if first:
                robots[..., 3:] = 0.0
                balls[:, 2:] = 0.0
            else:
                moved = robots[..., :3] - self._last_robots[which, :, :3]
                moved[..., 2] = wrap_angles(moved[..., 2])
                robots[..., 3:] = moved / self._period
                balls[:, 2:] = (balls[:, :2] - self._last_balls[which, :2]) / self._period
            self._last_robots[which] = robots
            self._last_balls[which] = balls
        elif self._noisy:
            robots[..., 3:5] += self._draw(noise.velocity, (len(which), 1, 2))
            robots[..., 5] += self._draw(noise.turn_rate, (len(which), 1))
            balls[:, 2:] += self._draw(noise.velocity, (len(which), 2))
        return robots, balls

    def _draw(self, deviation: float, shape: tuple[int, ...]) -> FloatArray:
        # Drawn even where it is 0, so that one kind of noise does not change another's draws.
        drawn = self._rng.standard_normal(shape)
        return deviation * np.minimum(np.maximum(drawn, -CUT_OFF), CUT_OFF)
