"""Protects a team's view of the field from changes by its robots' trees."""

from __future__ import annotations

from operator import attrgetter
from typing import Any

from robobt.world.game import GameState, TeamStatus
from robobt.world.state import BallState, Frame, RobotState

_FRAME_FIELDS = tuple(Frame.__dataclass_fields__)
_BALL_FIELDS = tuple(BallState.__dataclass_fields__)
_ROBOT_FIELDS = tuple(RobotState.__dataclass_fields__)
_GAME = tuple(GameState.__dataclass_fields__)
_STATUS_FIELDS = tuple(TeamStatus.__dataclass_fields__)
_frame, _ball, _game, _status = (
    attrgetter(*_FRAME_FIELDS),
    attrgetter(*_BALL_FIELDS),
    attrgetter(*_GAME),
    attrgetter(*_STATUS_FIELDS),
)


class KeptView:
    """Detects and undoes a tree's changes to the view that it shares with its team-mates' trees.

    Game, field and limits are read-only and shared by the whole match, both teams and all later ticks; a
    skill can still change them with ``object.__setattr__`` or ``vars``.
    """

    def __init__(self) -> None:
        self._settings: dict[int, object] = {}
        self._values: list[dict[str, Any]] = []
        self._values_before: list[dict[str, Any]] = []

    def take(self, view: Frame) -> None:
        """Store the state of this view."""
        self._view, self._the_ball, self._game, self._made = view, view.ball, view.game, view.made
        self._robots, self._size = (*view.own, *view.opponents), len(view.own)
        self._teams = view.game.blue, view.game.yellow
        settings: dict[int, object] = {id(it.limits): it.limits for it in self._robots}
        settings[id(view.field)], settings[id(view.ball_model)] = view.field, view.ball_model
        if settings.keys() != self._settings.keys():
            # These objects are mostly the same for a whole match and for several robots.
            self._settings = settings
            self._values = [vars(it) for it in settings.values()]
            self._values_before = [dict(values) for values in self._values]
        self._before = self._read()

    def mend(self) -> list[str] | None:
        """Restore changed fields; return their names ("ball.x"), or None without a change.

        A change within a field, such as in a list, has no name.
        """
        try:
            if self._read() == self._before and self._settings_hold():
                return None
        except Exception:
            # An attribute was deleted, or its new value does not compare to a boolean.
            pass
        frame, ball, robots, game, blue, yellow, _ = self._before
        changed = _restore(self._view, "", _FRAME_FIELDS, frame)
        changed += _restore(self._the_ball, "ball.", _BALL_FIELDS, ball)
        changed += _restore(self._game, "game.", _GAME, game)
        for team, status, values in zip(("blue", "yellow"), self._teams, (blue, yellow), strict=True):
            changed += _restore(status, f"game.{team}.", _STATUS_FIELDS, values)
        for i, (robot, values) in enumerate(zip(self._robots, robots, strict=True)):
            place = f"own[{i}]." if i < self._size else f"opponents[{i - self._size}]."
            changed += _restore(robot, place, _ROBOT_FIELDS, values)
        for it, now, before in zip(self._settings.values(), self._values, self._values_before, strict=True):
            changed += [
                f"{type(it).__name__}.{name}"
                for name, value in before.items()
                if now.get(name, _MISSING) is not value
            ]
            now.clear()
            now.update(before)
        self._made.clear()
        _restore(self._view, "", ("made",), (self._made,))
        return changed

    def _read(self) -> tuple[Any, ...]:
        # This is far quicker than copies for every robot, and than comparing the objects. It is written out
        # because the interpreter then caches attribute lookups, which attrgetter repeats every time.
        robots: list[tuple[object, ...]] = [
            (it.id, it.x, it.y, it.heading, it.vx, it.vy, it.omega, it.ball_contact, it.limits)
            for it in self._robots
        ]
        blue, yellow = self._teams
        view, game = self._view, self._game
        return (
            _frame(view),
            _ball(self._the_ball),
            robots,
            _game(game),
            _status(blue),
            _status(yellow),
            id(view.made),
        )

    def _settings_hold(self) -> bool:
        if self._values == self._values_before:
            return True
        for now, before in zip(self._values, self._values_before, strict=True):
            # They also keep values there that they compute at first use.
            if now != before and {key: now[key] for key in before} != before:
                return False
            before.update(now)
        return True


def _restore(target: object, prefix: str, names: tuple[str, ...], values: tuple[object, ...]) -> list[str]:
    """Set attributes and return the prefixed names of those that had another value."""
    changed = []
    for name, value in zip(names, values, strict=True):
        # By identity, because a value that a skill put there may not support comparison.
        if getattr(target, name, _MISSING) is not value:
            changed.append(prefix + name)
        object.__setattr__(target, name, value)
    return changed


_MISSING = object()
