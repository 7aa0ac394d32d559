"""Observation of the arenas: exact, or with noise, latency and differenced velocities."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.settings import NoiseSettings, TaskSettings
from robobt.learning.envs.starts import split
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.sim.records import size as size_of
from robobt.world.geometry import wrap_angles
from robobt.world.records import BALL, ROBOT, ROBOT_SIZE

CUT_OFF = 4.0
"""Standard deviations at which noise is cut off."""

Observe = Callable[[FloatArray, FloatArray], FloatArray]


class Perception:
    """Observation of arenas with ``robots`` robots each; each arena's generator draws its noise.

    Attributes:
        follows: whether it must observe after every tick, because an observation depends on earlier states.
    """

    def __init__(
        self,
        settings: TaskSettings,
        observe: Observe,
        size: int,
        robots: int,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        n = len(rngs)
        self._observe = observe
        noise = settings.noise
        at, fast = noise.robot_position, noise.velocity
        self._robot_noise = np.array((at, at, noise.heading, fast, fast, noise.turn_rate))
        self._ball_noise = np.array((noise.ball_position, noise.ball_position, fast, fast))
        self._noisy = noise != NoiseSettings()
        self._differenced = settings.velocities == "finite_difference"
        self._period = settings.period
        self._rngs = rngs
        self._drawn = np.zeros((n, robots * ROBOT_SIZE + size_of(BALL)))
        self._last_robots = np.zeros((n, robots, ROBOT_SIZE))
        self._last_balls = np.zeros((n, size_of(BALL)))
        self._late = np.zeros((settings.latency + 1, n, size))
        self._newest = 0
        self._all = np.arange(n)
        self.follows = self._noisy or self._differenced or settings.latency > 0

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
        """Return the first observations of the newly placed arenas ``which``, (m, O)."""
        robots, balls = robots[which], balls[which]
        if self._noisy or self._differenced:
            robots, balls = self._disturbed(robots, balls, which, first=True)
        seen = self._observe(robots, balls)
        if len(self._late) > 1:
            self._late[:, which] = seen
        return seen

    def put(self, robots: FloatArray, balls: FloatArray, moved: NDArray[np.bool_]) -> None:
        """Exclude the jumps of ``moved`` objects (n, R + 1), the last the ball, from velocities."""
        if self._differenced:
            self._last_robots[moved[:, :-1]] = robots[moved[:, :-1]]
            self._last_balls[moved[:, -1]] = balls[moved[:, -1]]

    def _disturbed(
        self, robots: FloatArray, balls: FloatArray, which: IntArray, first: bool
    ) -> tuple[FloatArray, FloatArray]:
        robots, balls = robots.copy(), balls.copy()
        if self._noisy:
            of_robots, of_balls, _ = split(self._draw(which), robots.shape[1])
            robots += self._robot_noise * of_robots
            balls += self._ball_noise * of_balls
            heading = robots.view(ROBOT)["heading"]
            heading[:] = wrap_angles(heading)
        if self._differenced:
            if first:
                robots[..., 3:] = 0.0
                balls[:, 2:] = 0.0
            else:
                moved = robots - self._last_robots[which]
                turned = moved.view(ROBOT)["heading"]
                turned[:] = wrap_angles(turned)
                robots[..., 3:] = moved[..., :3] / self._period
                balls[:, 2:] = (balls[:, :2] - self._last_balls[which, :2]) / self._period
            self._last_robots[which] = robots
            self._last_balls[which] = balls
        return robots, balls

    def _draw(self, which: IntArray) -> FloatArray:
        """Draw a number for every value, (m, 6 R + 4): one kind of noise must not change another's draws."""
        drawn = self._drawn[: len(which)]
        for row, arena in zip(drawn, which.tolist(), strict=True):
            self._rngs[arena].standard_normal(out=row)
        return np.minimum(np.maximum(drawn, -CUT_OFF), CUT_OFF)
