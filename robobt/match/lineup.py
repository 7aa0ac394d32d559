"""The line-up: the goalkeeper's number and the number of robots, as the game controller says."""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterator, Sequence
from math import copysign

from robobt.match.players import Player
from robobt.motion.path_planner import travel
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, distance
from robobt.world.presence import SUBSTITUTION_REACH, in_substitution_area
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_log = logging.getLogger(__name__)

_BENCH_SPACING = 0.3
"""Distance between robots that have left the field [m]."""

_BENCH_CLEARANCE = STOP_DISTANCE + 2.0 * ROBOT_RADIUS
"""Least distance of a robot that has left from the ball [m]."""

_BEHIND_WALL = 0.3
"""Distance behind the wall of a robot that was taken off [m]."""

_RETURN_SPACING = 2.0 * ROBOT_RADIUS + 0.05
"""Least distance from other robots for a robot that is put back [m]."""


class Lineup:
    """One team's robots, each with the tree that moves it.

    ``players`` are the robots with their trees from the scenario; ``keeper`` is the goalkeeper's number, None
    without one.

    Attributes:
        players: the player that moves each robot now, by the robot's number.
    """

    def __init__(self, players: Sequence[Player], keeper: int | None) -> None:
        self.players = {player.robot.number: player for player in players}
        self._keeper = keeper
        self._unknown: int | None = None
        self._leaving: frozenset[int] = frozenset()
        self._away: frozenset[int] = frozenset()

    def follow(self, view: Frame) -> frozenset[int]:
        """Apply the game controller's data on this team; return the numbers of robots that have to leave.

        The robot that it names as the goalkeeper exchanges trees with the previous goalkeeper. If there are
        too many robots, those with the highest numbers leave, the goalkeeper last.
        """
        status = view.game.status(view.team)
        if status.keeper is not None and status.keeper != self._keeper and self._keeper is not None:
            self._make_keeper(status.keeper)
        excess = 0 if status.max_robots is None else len(view.own) - status.max_robots
        leaving: frozenset[int] = frozenset()
        if excess > 0:
            numbers = [robot.id for robot in view.own if robot.id in self.players]
            leaving = frozenset(sorted(numbers, key=lambda it: (it == self._keeper, -it))[:excess])
        if leaving != self._leaving:
            self._leaving = leaving
            self._forget_roles()
        return leaving

    @property
    def complete(self) -> bool:
        """Whether all robots play: none has to leave and none is off the field."""
        return not self._leaving and not self._away

    def carried(self, view: Frame) -> Iterator[tuple[int, Point]]:
        """Return the robots that handlers move now, and their new places in their team's view.

        A robot that has to leave is taken behind the wall where it left the field. A robot that may play
        again is put back there once there is room.
        """
        field = view.field
        wall, margin = field.outer[1], (field.half_width + field.outer[1]) / 2
        self._away = frozenset(robot.id for robot in view.own if abs(robot.y) > wall)
        for me in view.own:
            if me.id in self._leaving and me.id not in self._away and in_substitution_area(field, me):
                yield me.id, (me.x, copysign(wall + _BEHIND_WALL, me.y))
            elif me.id in self._away - self._leaving:
                place = (me.x, copysign(margin, me.y))
                if all(distance(place, other.position) > _RETURN_SPACING for other in view.others(me.id)):
                    yield me.id, place

    def _make_keeper(self, number: int) -> None:
        old, new = self._keeper, number
        assert old is not None
        if new not in self.players:
            if new != self._unknown:
                self._unknown = new
                _log.warning("the game controller's goalkeeper is %d, which does not play here", new)
            return
        _log.info("goalkeeper is %d in place of %d", new, old)
        first, second = self.players[old], self.players[new]
        for player in (first, second):
            player.runner.stop()
        first.robot, second.robot = second.robot, first.robot
        self.players[old], self.players[new] = second, first
        self._keeper = new
        self._forget_roles()

    def _forget_roles(self) -> None:
        """Let the trees choose again who goes for the ball; robots register when they are ticked."""
        team = next(iter(self.players.values())).store.team
        team.attackers.clear()
        team.marks.clear()
        team.kept.clear()
        team.attacker = team.followed = None


def leave(view: Frame, me: RobotState, leaving: Collection[int]) -> RobotCommand:
    """Drive off the field over the nearer touch line, next to the half-way line in the own half.

    ``leaving`` has the numbers of all robots that leave; on each side they stand in order of their numbers.
    If the ball is near one of their places, they all stand in the order from the end of the substitution
    area, or over the other touch line: beside the ball they could not stay during a stop, and others could
    not fetch it.
    """
    field, ball = view.field, view.ball.position
    beside = [robot.id for robot in view.own if robot.id in leaving and robot.y * me.y > 0.0]
    mine = sum(number < me.id for number in beside)
    count = mine + 1 + sum(number > me.id for number in beside)
    y = copysign((field.half_width + field.outer[1]) / 2, me.y)
    row = [(max(-SUBSTITUTION_REACH, -_BENCH_SPACING * (place + 0.5)), y) for place in range(count)]
    end = ROBOT_RADIUS - SUBSTITUTION_REACH - 0.5 * _BENCH_SPACING
    rows = row, [(end - x, y) for x, _ in row], [(x, -y) for x, _ in row]
    clear = (places for places in rows if all(distance(place, ball) > _BENCH_CLEARANCE for place in places))
    return travel(view, me, next(clear, row)[mine], 0.0, me.limits, avoid_ball=True)
