"""A match that was recorded: what can be asked of it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence as SequenceOf
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from robobt.match.recording.header import Event, RecordedNode, RecordingHeader, RobotFlag
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.geometry import FloatArray
from robobt.world.state import BallState, Frame, RobotId, RobotState

T = TypeVar("T")


@dataclass(slots=True)
class Poses:
    """Ball and robots at every tick, in world coordinates (blue defends -x).

    Attributes:
        ball: (T, 4) x, y [m], vx, vy [m/s]; NaN where it was not known.
        robots: (T, K, 6) x, y [m], heading [rad], vx, vy [m/s], omega [rad/s]; NaN off the field.
        contact: (T, K) whether the ball lay in the robot's mouth.
    """

    ball: FloatArray
    robots: FloatArray
    contact: NDArray[np.bool_]


@dataclass(slots=True)
class Recording:
    """A match that was recorded, in world coordinates (blue defends -x).

    T is the number of ticks, K that of robots in the header.

    Attributes:
        path: the file.
        header: what stayed the same.
        times: (T,) [s], never decreasing.
        ball: (T, 4) x, y [m], vx, vy [m/s]; NaN where it was not known.
        robots: (T, K, 6) x, y [m], heading [rad], vx, vy [m/s], omega [rad/s]; NaN off the field.
        flags: (T, K) :class:`RobotFlag`.
        commands: (T, K, 4) vx, vy [m/s], omega [rad/s], kick speed [m/s], in the robot's own
            frame; NaN where it was sent none.
        observed: what the trees were shown, None where that was the truth at every tick.
        letters: for each robot the ticks at which its tree changed, with one letter a node: S, F, R
            of a node that was ticked, s, f, r where it kept the status of an earlier tick, - without.
        feedback: for each robot the ticks at which nodes said something new, by node.
        outputs: for each robot the ticks at which its skills wrote something new, by entry of the store.
        team_outputs: the same for what the robots of a team share.
        games: the ticks at which the referee's word changed.
        touches: the ticks at which the last touch changed hands.
        events: in the order they were recorded.
        outcome: what the match ended with, None when its recorder was not closed.
    """

    path: Path
    header: RecordingHeader
    times: FloatArray
    ball: FloatArray
    robots: FloatArray
    flags: NDArray[np.uint8]
    commands: FloatArray
    observed: Poses | None
    letters: list[list[tuple[int, str]]]
    feedback: list[list[tuple[int, dict[int, str]]]]
    outputs: list[list[tuple[int, dict[str, Any]]]]
    team_outputs: dict[Team, list[tuple[int, dict[str, Any]]]]
    games: list[tuple[int, GameState]]
    touches: list[tuple[int, RobotId | None]]
    events: list[Event]
    outcome: dict[str, Any] | None

    @property
    def complete(self) -> bool:
        """Whether the recording reached its end; a killed match's did not."""
        return self.outcome is not None

    @property
    def statuses(self) -> list[list[tuple[int, str]]]:
        """For each robot the ticks at which statuses changed, with one letter a node: S, F, R, -."""
        told = []
        for changes in self.letters:
            statuses: list[tuple[int, str]] = []
            for tick, letters in changes:
                if not statuses or letters.upper() != statuses[-1][1]:
                    statuses.append((tick, letters.upper()))
            told.append(statuses)
        return told

    def __len__(self) -> int:
        return len(self.times)

    def frame(self, tick: int) -> Frame:
        """What was on the field at a tick, from blue's side, as exactly as the file holds it.

        Raises:
            IndexError: no such tick.
        """
        contact = (self.flags & RobotFlag.BALL_CONTACT).astype(bool)
        return self._frame(tick, Poses(self.ball, self.robots, contact))

    def observation(self, tick: int) -> Frame:
        """What the trees were shown at a tick, from blue's side, as exactly as the file holds it.

        Raises:
            IndexError: no such tick.
        """
        return self.frame(tick) if self.observed is None else self._frame(tick, self.observed)

    def command(self, robot: RobotId, tick: int) -> RobotCommand | None:
        """What the robot was sent at a tick, None if nothing.

        Raises:
            KeyError: no such robot in this recording.
            IndexError: no such tick.
        """
        slot = self.slot(robot)
        flags = RobotFlag(int(self.flags[tick, slot]))
        if RobotFlag.COMMANDED not in flags:
            return None
        trigger = KickTrigger.NOW if RobotFlag.KICK_NOW in flags else KickTrigger.ON_CONTACT
        vx, vy, omega, kick = self.commands[tick, slot].tolist()
        return RobotCommand(vx, vy, omega, kick, trigger, RobotFlag.DRIBBLER in flags)

    def letters_at(self, robot: RobotId, tick: int) -> str:
        """One letter a node, as in :attr:`letters`.

        Raises:
            KeyError: no such robot in this recording.
        """
        slot = self.slot(robot)
        return _latest(self.letters[slot], tick, "-" * len(self.header.robots[slot].tree))

    def statuses_at(self, robot: RobotId, tick: int) -> str:
        """One letter a node of the robot's tree (S, F, R, - without), in the order of its header.

        Raises:
            KeyError: no such robot in this recording.
        """
        return self.letters_at(robot, tick).upper()

    def ticked_path(self, robot: RobotId, tick: int) -> list[str]:
        """Ids of the nodes that were ticked at this tick and had a status then, parents before children.

        Raises:
            KeyError: no such robot in this recording.
        """
        letters = self.letters_at(robot, tick)
        return [
            node.path for node, letter in zip(self._nodes(robot), letters, strict=True) if letter in "SFR"
        ]

    def feedback_at(self, robot: RobotId, tick: int) -> dict[int, str]:
        """What the nodes of the robot's tree said last while they had a status, by place in the tree.

        Raises:
            KeyError: no such robot in this recording.
        """
        said = _gathered(self.feedback[self.slot(robot)], tick)
        return {place: message for place, message in said.items() if message}

    def failures_at(self, robot: RobotId, tick: int) -> dict[str, str]:
        """The nodes that failed at this tick by their ids, each with the reason that it gave.

        Raises:
            KeyError: no such robot in this recording.
        """
        letters, said = self.letters_at(robot, tick), self.feedback_at(robot, tick)
        nodes = self._nodes(robot)
        return {
            node.path: said.get(place, "")
            for place, (node, letter) in enumerate(zip(nodes, letters, strict=True))
            if letter == "F"
        }

    def outputs_at(self, robot: RobotId, tick: int) -> dict[str, Any]:
        """What the robot's skills have written into its store, as plain data by entry.

        Raises:
            KeyError: no such robot in this recording.
        """
        return _gathered(self.outputs[self.slot(robot)], tick)

    def team_outputs_at(self, team: Team, tick: int) -> dict[str, Any]:
        """What the skills of a team have written into what they share, as plain data by entry."""
        return _gathered(self.team_outputs[team], tick)

    def slot(self, robot: RobotId) -> int:
        """The robot's place in the header and in the arrays.

        Raises:
            KeyError: no such robot in this recording.
        """
        for slot, entry in enumerate(self.header.robots):
            if entry.id == robot:
                return slot
        there = ", ".join(str(entry.id) for entry in self.header.robots)
        raise KeyError(f"robot {robot} is not in {self.path}; there are {there}")

    def _nodes(self, robot: RobotId) -> tuple[RecordedNode, ...]:
        return self.header.robots[self.slot(robot)].tree

    def _frame(self, tick: int, poses: Poses) -> Frame:
        period = self.header.period
        tick = range(len(self))[tick]
        ball = BallState(*poses.ball[tick].tolist())
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        for robot, row, contact in zip(
            self.header.robots, poses.robots[tick].tolist(), poses.contact[tick].tolist(), strict=True
        ):
            if isfinite(row[0]):
                x, y, heading, vx, vy, omega = row
                state = RobotState(robot.number, x, y, heading, vx, vy, omega, contact, robot.limits)
                teams[robot.team].append(state)
        own, opponents = (tuple(sorted(teams[team], key=_number)) for team in (Team.BLUE, Team.YELLOW))
        game = _latest(self.games, tick, OPEN_PLAY)
        touch = _latest(self.touches, tick, None)
        time = float(self.times[tick])
        return Frame(time, self.header.field, ball, own, opponents, Team.BLUE, period, game, touch)


def _number(robot: RobotState) -> int:
    return robot.id


def _latest(changes: SequenceOf[tuple[int, T]], tick: int, default: T) -> T:
    place = bisect_right(changes, tick, key=_when)
    return changes[place - 1][1] if place else default


def _gathered(changes: SequenceOf[tuple[int, dict[Any, T]]], tick: int) -> dict[Any, T]:
    gathered: dict[Any, T] = {}
    for when, change in changes:
        if when > tick:
            break
        gathered.update(change)
    return gathered


def _when(change: tuple[int, Any]) -> int:
    return change[0]
