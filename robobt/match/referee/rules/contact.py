"""Crashes and pushing between robots."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, hypot

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import RepeatLimit, Rule, event, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.geometry import Point, wrap_angle
from robobt.world.rules import in_defense_area
from robobt.world.state import RobotId, RobotState

_EQUAL_SPEEDS = 0.3
"""Both robots are at fault in a crash when their speeds differ by less than this. Source: SSL rules [m/s]."""

_BRAKED = 3.0 * 0.1
"""Speed subtracted for each robot, because it may have begun to brake unseen.

Source: AutoReferee, for 0.1 s; 3 m/s² as the league's robots accelerate [m/s].
"""

_PUSHING, _PUSHED = 0.19, 0.2
"""Distance between centres below which robots touch, and pushed distance above which it is a push [m].
Source: AutoReferee."""

_PUSH_ANGLE = 0.7
"""Largest angle between the direction to the pushed robot and its movement [rad]. Source: AutoReferee."""

_FOLLOWS = 0.05
"""Least speed of a pusher towards the pushed robot, which does not move towards the pusher [m/s]."""

Pair = tuple[int, int]
"""A pair of numbers: a blue and a yellow robot."""


class Crash(Rule):
    """Two robots may not collide at more than ``limit`` [m/s] along the line of their centres.

    The faster robot is at fault, or both if their speeds hardly differ. The greater of the speeds in this and
    the last frame counts, because in the frame of contact the robots may already have stopped each other.
    """

    phases = frozenset(PlayPhase) - {PlayPhase.HALT}

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._again = RepeatLimit()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report two robots every two seconds."""
        for blue, yellow in scene.touching:
            pair, speed = (blue, yellow), _closing(blue, yellow)
            if scene.before is not None:
                earlier = (
                    _robot(scene.before.own, blue) or blue,
                    _robot(scene.before.opponents, yellow) or yellow,
                )
                before = _closing(*earlier)
                if before > speed:
                    pair, speed = earlier, before
            if speed > self._limit and self._again.ready((blue.id, yellow.id), scene.time):
                yield _crash(scene, *pair, speed)


def _crash(scene: RefereeScene, blue: RobotState, yellow: RobotState, speed: float) -> RefereeEvent:
    lead = blue.speed - yellow.speed
    at = ((blue.x + yellow.x) / 2, (blue.y + yellow.y) / 2)
    along = atan2(yellow.y - blue.y, yellow.x - blue.x)
    angle = wrap_angle(atan2(blue.vy - yellow.vy, blue.vx - yellow.vx) - along)
    if abs(lead) < _EQUAL_SPEEDS:
        return team_event(
            scene,
            EventKind.BOT_CRASH_DRAWN,
            None,
            None,
            at,
            bot_yellow=yellow.id,
            bot_blue=blue.id,
            crash_speed=speed,
            speed_diff=abs(lead),
            crash_angle=angle,
        )
    violator, victim = (blue, yellow) if lead > 0.0 else (yellow, blue)
    identity = RobotId(Team.BLUE if lead > 0.0 else Team.YELLOW, violator.id)
    return event(
        scene,
        EventKind.BOT_CRASH_UNIQUE,
        identity,
        at,
        victim=victim.id,
        crash_speed=speed,
        speed_diff=abs(lead),
        crash_angle=angle,
    )


class Pushing(Rule):
    """A robot may not push an opponent over 0.2 m, or into the opponent's own defence area.

    If both push there is no offence.
    """

    phases = frozenset({PlayPhase.PLAY, PlayPhase.PENALTY})

    def __init__(self) -> None:
        self._began: dict[Pair, tuple[Point, Point]] = {}

    def enter(self, _: RefereeScene) -> None:
        """Forget earlier contacts."""
        self._began.clear()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a push and reset its count."""
        began: dict[Pair, tuple[Point, Point]] = {}
        for blue, yellow in scene.touching:
            if hypot(yellow.x - blue.x, yellow.y - blue.y) > _PUSHING:
                continue
            pair = blue.id, yellow.id
            starts = began[pair] = self._began.get(pair, (blue.position, yellow.position))
            for team, pusher, pushed, start in (
                (Team.BLUE, blue, yellow, starts[1]),
                (Team.YELLOW, yellow, blue, starts[0]),
            ):
                way = hypot(pushed.x - start[0], pushed.y - start[1])
                if not _pushes(pusher, pushed, start, way):
                    continue
                at_home = in_defense_area(scene.field, team.other, pushed.x, pushed.y)
                was_at_home = in_defense_area(scene.field, team.other, *start)
                if way > _PUSHED or (at_home and not was_at_home):
                    began[pair] = blue.position, yellow.position
                    yield event(
                        scene,
                        EventKind.BOT_PUSHED_BOT,
                        RobotId(team, pusher.id),
                        pushed.position,
                        victim=pushed.id,
                        pushed_distance=way,
                    )
        self._began = began


def _pushes(pusher: RobotState, pushed: RobotState, start: Point, way: float) -> bool:
    """Return whether one robot drives at the other, which moves away in that direction."""
    dx, dy = pushed.x - pusher.x, pushed.y - pusher.y
    gap = hypot(dx, dy)
    if gap == 0.0 or way == 0.0:
        return False
    towards = (pusher.vx * dx + pusher.vy * dy) / gap
    against = (pushed.vx * dx + pushed.vy * dy) / gap
    if towards < _FOLLOWS or against < 0.0:
        return False
    travelled = atan2(pushed.y - start[1], pushed.x - start[0])
    return abs(wrap_angle(travelled - atan2(dy, dx))) <= _PUSH_ANGLE


def _closing(one: RobotState, other: RobotState) -> float:
    """Return the speed at which two robots that may have braked come together [m/s]."""
    dx, dy = other.x - one.x, other.y - one.y
    gap = hypot(dx, dy)
    if gap == 0.0:
        return 0.0
    first, second = _left(one.speed), _left(other.speed)
    vx, vy = one.vx * first - other.vx * second, one.vy * first - other.vy * second
    return (vx * dx + vy * dy) / gap


def _left(speed: float) -> float:
    """Return the share of a speed that braking may have left of it."""
    return max(0.0, 1.0 - _BRAKED / speed) if speed > 0.0 else 0.0


def _robot(robots: Iterable[RobotState], like: RobotState) -> RobotState | None:
    return next((robot for robot in robots if robot.id == like.id), None)
