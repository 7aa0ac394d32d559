"""A team's view of the field, kept as it is whatever its robots' trees do to it."""

from __future__ import annotations

from operator import attrgetter

from robobt.world.state import BallState, Frame, RobotState

_FRAME = tuple(Frame.__dataclass_fields__)
_BALL = tuple(BallState.__dataclass_fields__)
_ROBOT = tuple(RobotState.__dataclass_fields__)
_frame, _ball = attrgetter(*_FRAME), attrgetter(*_BALL)


class KeptView:
    """Notices and undoes what a tree has done to the view that it shares with its team-mates'."""

    def __init__(self, view: Frame) -> None:
        self._view, self._the_ball = view, view.ball
        self._robots = (*view.own, *view.opponents)
        self._before = self._read()

    def mend(self) -> bool:
        """Put back what was changed; whether anything was."""
        try:
            if self._read() == self._before:
                return False
        except Exception:
            # An attribute was deleted, or has become what does not compare to a truth.
            pass
        frame, ball, robots = self._before
        _restore(self._view, _FRAME, frame)
        _restore(self._the_ball, _BALL, ball)
        for robot, values in zip(self._robots, robots, strict=True):
            _restore(robot, _ROBOT, values)
        self._view.made.clear()
        return True

    def _read(self) -> tuple[tuple[object, ...], tuple[object, ...], list[tuple[object, ...]]]:
        # Far quicker than copies for every robot, and than comparing the objects. Written out, for there the
        # interpreter remembers where an attribute is found, which attrgetter looks up each time.
        robots: list[tuple[object, ...]] = [
            (it.id, it.x, it.y, it.heading, it.vx, it.vy, it.omega, it.ball_contact, it.limits)
            for it in self._robots
        ]
        return _frame(self._view), _ball(self._the_ball), robots


def _restore(target: object, names: tuple[str, ...], values: tuple[object, ...]) -> None:
    for name, value in zip(names, values, strict=True):
        setattr(target, name, value)
