"""Assignment of attacker and markers as in the team of November 2026.

The first robot that asks in a frame decides for all. Robots register at their first request, so a team may
have any size. Choices stay until another is clearly better, so that two robots do not alternate.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot, inf

from robobt.skills.kicker import follow_restart
from robobt.skills.store import TeamStore
from robobt.world.game import Restart
from robobt.world.rules import has_ball, in_own_defense_area, in_their_defense_area, owner
from robobt.world.state import Frame, RobotId, RobotState

SWITCH_GAIN = 0.15
"""Another robot takes over the ball if it arrives this much sooner [s]."""

_PACE = 2.0
"""Mean speed of a robot on its way to the ball, including start and stop [m/s]."""

_ROLLING_BALL_SPEED = 0.3
_LOOK_AHEAD_TIMES = (0.0, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0)
"""Times at which a rolling ball's position is predicted [s]."""

_LONGEST_DETOUR = 0.3
"""Longest additional time for a robot to get behind the ball first [s]."""

_HOLDER_BONUS = 0.5
"""Bonus for the robot that has the ball [s]."""

_MARK_GAIN = 0.3
"""Another robot takes over marking an opponent if it is this much closer [m]."""

_AREA_REACH = 0.06
"""Only a goalkeeper goes for a ball in a defence area or this close to one [m]."""

MARK_FROM = 0.5
"""Opponents are marked up to this x: the own half and a little more [m]."""


@dataclass(slots=True)
class Agreement:
    """The team's state of the assignment.

    Attributes:
        farthest: for each robot that may go for the ball, the largest x of the ball at which it does [m].
        markers: numbers of the robots that mark opponents.
        frame: the frame for which it was computed.
    """

    farthest: dict[int, float] = field(default_factory=dict)
    markers: set[int] = field(default_factory=set)
    frame: Frame | None = None


def enter_attacker(team: TeamStore, number: int, farthest: float | None) -> None:
    """Register a robot to go for the ball if the ball's x is at most ``farthest`` [m], None for any x."""
    agreed = team.shared(Agreement)
    if number not in agreed.farthest:
        agreed.farthest[number] = inf if farthest is None else farthest
        team.attackers.add(number)
        _agree_anew(team)


def enter_marker(team: TeamStore, number: int) -> None:
    """Register a robot to mark opponents."""
    agreed = team.shared(Agreement)
    if number not in agreed.markers:
        agreed.markers.add(number)
        _agree_anew(team)


def _agree_anew(team: TeamStore) -> None:
    team.shared(Agreement).frame = team.followed = None


def attacker(frame: Frame, team: TeamStore) -> int | None:
    """Return the number of the robot that goes for the ball, or None.

    If the team also has robots that share out tasks (``team_player``), their attacker goes.
    """
    agreed = team.shared(Agreement)
    if agreed.frame is not frame and team.plan.frame is not frame:
        agreed.frame = frame
        follow_restart(frame, team)
        team.attacker = _choose_attacker(frame, team, agreed.farthest)
        team.marks = _choose_marks(frame, team, agreed.markers) if agreed.markers else {}
    return team.attacker


def marked(frame: Frame, team: TeamStore, number: int) -> RobotState | None:
    """Return the opponent that the own robot with this number marks, None without one."""
    attacker(frame, team)
    opponent = team.marks.get(number)
    if opponent is None:
        return None
    return next((robot for robot in frame.opponents if robot.id == opponent), None)


def _choose_attacker(frame: Frame, team: TeamStore, farthest: dict[int, float]) -> int | None:
    ball, field = frame.ball, frame.field
    if frame.game.penalty is frame.team and frame.game.may_touch and team.attacker is not None:
        return team.attacker
    placing = frame.game.restart is Restart.BALL_PLACEMENT
    if not placing and (
        in_own_defense_area(field, ball.x, ball.y, _AREA_REACH)
        or in_their_defense_area(field, ball.x, ball.y, _AREA_REACH)
    ):
        return None
    best: int | None = None
    least = present = inf
    for robot in frame.own:
        if robot.id == team.kicker or robot.id not in farthest:
            continue
        if ball.x > farthest[robot.id] and not placing:
            continue
        time = _time_to_ball(frame, robot)
        if robot.id == team.attacker:
            present = time
        if time < least:
            best, least = robot.id, time
    return team.attacker if present < least + SWITCH_GAIN else best


def _time_to_ball(frame: Frame, robot: RobotState) -> float:
    """Estimate when the robot can be behind the predicted ball, facing the goal [s]."""
    ball, game = frame.ball, frame.game
    x, y = ball.x, ball.y
    if not game.in_play and game.placement is not None and game.restart is not Restart.BALL_PLACEMENT:
        x, y = game.placement
    elif has_ball(robot, ball):
        return -_HOLDER_BONUS
    elif abs(ball.vx) + abs(ball.vy) > _ROLLING_BALL_SPEED:
        return min(
            [
                max(ahead, hypot(x + ahead * ball.vx - robot.x, y + ahead * ball.vy - robot.y) / _PACE)
                for ahead in _LOOK_AHEAD_TIMES
            ]
        )
    return hypot(robot.x - x, robot.y - y) / _PACE + min(_LONGEST_DETOUR, max(0.0, robot.x - x))


def _choose_marks(frame: Frame, team: TeamStore, markers: set[int]) -> dict[int, int]:
    """Assign opponents, those nearest to the own goal first, each to the nearest free marker."""
    goal_x, goal_y = frame.field.our_goal
    holder = owner(frame)
    free = [robot for robot in frame.own if robot.id in markers and robot.id != team.attacker]
    threats = [
        (hypot(robot.x - goal_x, robot.y - goal_y), robot)
        for robot in frame.opponents
        if robot.x < MARK_FROM and (holder is None or holder != RobotId(frame.team.other, robot.id))
    ]
    threats.sort(key=lambda threat: threat[0])
    marks: dict[int, int] = {}
    for _, threat in threats:
        if not free:
            break
        nearest = min(free, key=lambda mate: _mark_cost(team, mate, threat))
        free.remove(nearest)
        marks[nearest.id] = threat.id
    return marks


def _mark_cost(team: TeamStore, mate: RobotState, threat: RobotState) -> float:
    kept = _MARK_GAIN if team.marks.get(mate.id) == threat.id else 0.0
    return hypot(mate.x - threat.x, mate.y - threat.y) - kept
