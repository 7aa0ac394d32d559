"""Delayed observations, predicted by delays that are measured while the robots play."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from math import inf
from statistics import fmean

from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch, MeasuredDelay
from robobt.world.detections import Detections
from robobt.world.limits import RobotLimits
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import Placement, World
from robobt.world.state import Frame, RobotId, RobotState

_MOST_PICTURES = 64
"""Number of pictures that are kept for records."""


class MeasuredWorld(PredictedWorld):
    """A world whose frames are predicted by the robots' whole delays, which it measures.

    Nobody has to know how late the world is. Until a delay is measured, ``watch`` says what to expect.

    Args:
        world: the world that is seen late, or whose robots obey late.
        watch: measures the delays from the times that the world's cameras claim; from the times of frames
            where the world has no cameras.
        gaps: as for :class:`~robobt.world.prediction.PredictedWorld`.
    """

    def __init__(self, world: World, watch: DelayWatch, gaps: bool = False) -> None:
        super().__init__(world, 0.0, 0.0, gaps)
        self._watch = watch
        self._pictures: deque[Detections] = deque(maxlen=_MOST_PICTURES)
        self._captured: dict[int, float] = {}
        self._shown_after: list[float] = []
        self._age = 0.0

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`robobt.world.World.reset`; delays that are known stay so."""
        super().reset(placement, seed)
        self._pictures.clear()
        self._captured.clear()
        self._watch.interrupt()

    def observe(self) -> Frame:
        """Return what the world reports, predicted to the moment at which the next command takes effect."""
        self._shown_after.clear()
        return super().observe()

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`robobt.world.World.act`."""
        self._watch.sent(self._now, commands)
        super().act(commands)

    def detections(self) -> Sequence[Detections]:
        """See :meth:`robobt.world.World.detections`."""
        pictures = list(self._pictures)
        self._pictures.clear()
        return pictures

    def delays(self) -> Mapping[RobotId, MeasuredDelay | None]:
        """See :meth:`robobt.world.World.delays`."""
        return self._watch.measured(self._age)

    def _look(self) -> Frame:
        """Look, and compare where robots are seen with what they were commanded."""
        seen, pictures = self.world.observe(), self.world.detections()
        if not pictures and not self._captured:
            for robot, state in seen.robots().items():
                self._watch.see(robot, seen.time, state.x, state.y, state.heading)
        for picture in pictures:
            if picture.captured <= self._captured.get(picture.camera, -inf):
                continue
            self._captured[picture.camera] = picture.captured
            self._pictures.append(picture)
            self._age = seen.time - picture.captured
            for robot, (x, y, heading) in picture.robots.items():
                self._watch.see(robot, picture.captured, x, y, heading)
        return seen

    def _delay(self, robot: RobotId, limits: RobotLimits) -> float:
        delay = max(0.0, self._age + self._watch.expected(robot))
        self._shown_after.append(delay - limits.reaction)
        return delay

    def _ball_age(self, robots: tuple[RobotState, ...]) -> float:  # noqa: ARG002
        return fmean(self._shown_after) if self._shown_after else 0.0

    def _present(self) -> float:
        # Robots are predicted as if the picture were of now and their commands came later by its age.
        return self._now + self._age
