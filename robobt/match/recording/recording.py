"""A recorded match and its queries."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from robobt.match.recording.header import Event, RecordedNode, RecordingHeader, RobotFlag
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.sketch import Shape
from robobt.world.state import BallState, Frame, RobotId, RobotState

T = TypeVar("T")
K = TypeVar("K")

Timeline: TypeAlias = list[tuple[int, T]]
"""Values by the tick from which they hold."""


@dataclass(slots=True)
class Poses:
    """Ball and robots at every tick, in world coordinates (blue defends -x).

    Attributes:
        ball: (T, 6) x, y [m], vx, vy [m/s], z [m], vz [m/s]; NaN where it was not known.
        robots: (T, K, 6) x, y [m], heading [rad], vx, vy [m/s], omega [rad/s]; NaN off the field.
        contact: (T, K) whether the ball was in the robot's mouth.
    """

    ball: NDArray[np.float32]
    robots: NDArray[np.float32]
    contact: NDArray[np.bool_]


@dataclass(slots=True)
class SeenPictures:
    """What cameras saw, neither filtered nor predicted, in world coordinates.

    Attributes:
        times: (P,) when the pictures were taken, by the recording's clock [s].
        ages: (P,) time from then to the tick that saw them first [s].
        cameras: (P,) number of the camera.
        ball: (P, 2) x, y [m]; NaN where no ball was seen.
        robots: (P, K, 3) x, y [m], heading [rad]; NaN where a robot was not seen.
    """

    times: NDArray[np.float64]
    ages: NDArray[np.float64]
    cameras: NDArray[np.int64]
    ball: NDArray[np.float32]
    robots: NDArray[np.float32]


@dataclass(slots=True)
class Recording:
    """A recorded match, in world coordinates (blue defends -x).

    T is the number of ticks, K the number of robots in the header. Asking for a robot that is not in the
    recording raises :exc:`KeyError`, for a tick without frame or command :exc:`IndexError`.

    Attributes:
        path: the file.
        header: the constant part of the recording.
        times: (T,) times of the ticks [s], never decreasing.
        truth: the true frames.
        observed: the frames that the trees saw, None if they were the true ones at every tick.
        flags: (T, K) :class:`RobotFlag`.
        commands: (T, K, 5) vx, vy [m/s], omega [rad/s], kick speed [m/s], kick angle [rad], in the
            robot's own frame; 0 where no command was sent.
        letters: for each robot one letter per node whenever its tree changed: S, F, R for a node that was
            ticked, s, f, r for a status kept from an earlier tick, - for no status.
        feedback: for each robot the new feedback of nodes, by their place.
        written: new values that skills wrote into a store, by robot ("blue 3") or team ("blue") and entry.
        drawn: by robot the changed drawings of its skills in the recorded layers, in its team's view, and by
            "field" those of the world; see :mod:`robobt.world.sketch`.
        games: the referee's state, whenever it changed.
        touches: the robot that touched the ball last, whenever it changed.
        events: events in the order of recording.
        outcome: the outcome of the match, None if its recorder was not closed.
        pictures: what cameras saw; None where that is not known, or the truth (see the header).
        cameras: x, y and height above the ground of cameras whose place is known, by number [m].
    """

    path: Path
    header: RecordingHeader
    times: NDArray[np.float64]
    truth: Poses
    observed: Poses | None
    flags: NDArray[np.uint8]
    commands: NDArray[np.float32]
    letters: list[Timeline[str]]
    feedback: list[Timeline[dict[int, str]]]
    written: dict[str, Timeline[dict[str, JsonValue]]]
    drawn: dict[str, Timeline[list[Shape]]]
    games: Timeline[GameState]
    touches: Timeline[RobotId | None]
    events: list[Event]
    outcome: dict[str, JsonValue] | None
    pictures: SeenPictures | None = None
    cameras: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    _slots: dict[RobotId, int] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def complete(self) -> bool:
        """Whether the recording reached its end; the recording of a killed match did not."""
        return self.outcome is not None

    @property
    def statuses(self) -> list[Timeline[str]]:
        """For each robot one letter per node (S, F, R, or - for no status) whenever a status changed."""
        return [
            _without_repeats([(tick, letters.upper()) for tick, letters in tree]) for tree in self.letters
        ]

    def __len__(self) -> int:
        return len(self.times)

    def frame(self, tick: int) -> Frame:
        """Return the true frame at a tick, from blue's side, with the file's precision."""
        return self._frame(tick, self.truth)

    def observation(self, tick: int) -> Frame:
        """Return the frame that the trees saw at a tick, from blue's side, with the file's precision."""
        return self._frame(tick, self.observed or self.truth)

    def command(self, robot: RobotId, tick: int) -> RobotCommand | None:
        """Return the command sent to the robot at a tick, or None."""
        slot = self.slot(robot)
        flags = RobotFlag(int(self.flags[tick, slot]))
        if RobotFlag.COMMANDED not in flags:
            return None
        trigger = KickTrigger.NOW if RobotFlag.KICK_NOW in flags else KickTrigger.ON_CONTACT
        vx, vy, omega, kick, angle = self.commands[tick, slot].tolist()
        return RobotCommand(vx, vy, omega, kick, trigger, RobotFlag.DRIBBLER in flags, angle)

    def letters_at(self, robot: RobotId, tick: int) -> str:
        """Return one letter per node of the robot's tree at a tick, as in :attr:`letters`."""
        return _latest(self.letters[self.slot(robot)], tick, "-" * len(self.nodes(robot)))

    def statuses_at(self, robot: RobotId, tick: int) -> str:
        """Return one letter per node of the robot's tree at a tick (S, F, R, -), in the header's order."""
        return self.letters_at(robot, tick).upper()

    def ticked_path(self, robot: RobotId, tick: int) -> list[str]:
        """Return the ids of a robot's nodes that were ticked and had a status at a tick, parents first."""
        letters = self.letters_at(robot, tick)
        return [node.path for node, it in zip(self.nodes(robot), letters, strict=True) if it in "SFR"]

    def feedback_at(self, robot: RobotId, tick: int) -> dict[int, str]:
        """Return, by place, the last feedback up to a tick of a robot's nodes that have a status."""
        feedback = _gathered(self.feedback[self.slot(robot)], tick)
        return {place: text for place, text in feedback.items() if text}

    def failures_at(self, robot: RobotId, tick: int) -> dict[str, str]:
        """Return the robot's nodes that failed at a tick, by id, each with its reason."""
        letters, feedback = self.letters_at(robot, tick), self.feedback_at(robot, tick)
        return {
            node.path: feedback.get(place, "")
            for place, node in enumerate(self.nodes(robot))
            if letters[place] == "F"
        }

    def written_at(self, owner: RobotId | Team, tick: int) -> dict[str, JsonValue]:
        """Return the values that skills have written up to a tick, by entry.

        ``owner`` is a robot, for its store, or a team, for the shared store. Places and directions are in
        that team's view, with its own goal at -x.
        """
        if not isinstance(owner, Team):
            self.slot(owner)
        return _gathered(self.written.get(str(owner), []), tick)

    def slot(self, robot: RobotId) -> int:
        """Return the robot's place in the header and in the arrays."""
        if not self._slots:
            self._slots.update({entry.id: slot for slot, entry in enumerate(self.header.robots)})
        slot = self._slots.get(robot)
        if slot is not None:
            return slot
        there = ", ".join(str(entry.id) for entry in self.header.robots)
        raise KeyError(f"robot {robot} is not in {self.path}; there are {there}")

    def nodes(self, robot: RobotId) -> tuple[RecordedNode, ...]:
        """Return the nodes of the robot's tree, parents first; none if no tree was recorded."""
        return self.header.robots[self.slot(robot)].tree

    def _frame(self, tick: int, poses: Poses) -> Frame:
        tick = range(len(self))[tick]
        ball = BallState(*poses.ball[tick].tolist())
        rows, contacts = poses.robots[tick].tolist(), poses.contact[tick].tolist()
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        for robot, row, contact in zip(self.header.robots, rows, contacts, strict=True):
            if isfinite(row[0]):
                x, y, heading, vx, vy, omega = row
                state = RobotState(robot.number, x, y, heading, vx, vy, omega, contact, robot.limits)
                teams[robot.team].append(state)
        own, opponents = (tuple(sorted(robots, key=lambda robot: robot.id)) for robots in teams.values())
        return Frame(
            float(self.times[tick]),
            self.header.field,
            ball,
            own,
            opponents,
            Team.BLUE,
            self.header.period,
            _latest(self.games, tick, OPEN_PLAY),
            _latest(self.touches, tick, None),
            self.header.ball_model,
        )


def _without_repeats(changes: Timeline[str]) -> Timeline[str]:
    return [change for i, change in enumerate(changes) if not i or change[1] != changes[i - 1][1]]


def _latest(changes: Timeline[T], tick: int, default: T) -> T:
    place = bisect_right(changes, tick, key=_when)
    return changes[place - 1][1] if place else default


def _gathered(changes: Timeline[dict[K, T]], tick: int) -> dict[K, T]:
    gathered: dict[K, T] = {}
    for _, change in changes[: bisect_right(changes, tick, key=_when)]:
        gathered.update(change)
    return gathered


def _when(change: tuple[int, object]) -> int:
    return change[0]
