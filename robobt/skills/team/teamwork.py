"""Who goes for the ball and who marks whom, agreed once a frame by the first robot that asks.

Robots enter themselves in the team's store when they first ask, so a team may
have any size. Choices stay until another is clearly better, so that two robots
do not take turns.
"""

from __future__ import annotations

from math import hypot, inf

from robobt.skills.store import TeamStore
from robobt.world.game import Restart
from robobt.world.rules import has_ball, in_own_defense_area, in_their_defense_area, owner
from robobt.world.state import Frame, RobotId, RobotState

SWITCH_GAIN = 0.15
"""Another robot goes for the ball when it is there so much sooner [s]."""

_PACE = 2.0
"""Speed that a robot makes on its way to the ball, starts and stops included [m/s]."""

_ROLLS = 0.3
_AHEAD = (0.0, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0)
"""When a rolling ball is looked for [s]."""

_DETOUR = 0.3
"""Most that it takes a robot to get behind the ball first [s]."""

_HELD = 0.5
"""How much sooner a robot counts that has the ball [s]."""

_MARK_GAIN = 0.3
"""Another robot marks an opponent when it is so much nearer to it [m]."""

_REACH = 0.06
"""Nobody but a goalkeeper goes for a ball in a defence area or this near to one [m]."""

MARK_FROM = 0.5
"""Opponents are marked up to this x: the own half and a little more [m]."""


def attacker(frame: Frame, team: TeamStore) -> int | None:
    """Return the number of the robot that goes for the ball; None when nobody may."""
    if team.agreed_on is not frame:
        team.agreed_on = frame
        follow_restart(frame, team)
        team.attacker = _choose_attacker(frame, team)
        team.marks = _choose_marks(frame, team) if team.markers else {}
    return team.attacker


def marked(frame: Frame, team: TeamStore, number: int) -> RobotState | None:
    """Return the opponent that the own robot with this number marks, None without one."""
    attacker(frame, team)
    opponent = team.marks.get(number)
    if opponent is None:
        return None
    return next((robot for robot in frame.opponents if robot.id == opponent), None)


def has_kicked(frame: Frame, team: TeamStore, number: int) -> bool:
    """Return whether that robot took a restart and may not touch the ball before another has.

    Who goes for the ball is not asked: a team may agree on that otherwise.
    """
    if team.agreed_on is not frame and team.plan.frame is not frame:
        follow_restart(frame, team)
    return team.kicker == number


def follow_restart(frame: Frame, team: TeamStore) -> None:
    """Remember who took the own restart until somebody else has touched the ball."""
    game = frame.game
    if game.penalty is not None:
        # Whoever takes it may touch the ball as often as it likes.
        team.kicker, team.restart_pending = None, False
        return
    if game.restart is not None:
        team.kicker = None
        team.restart_pending = game.may_touch and game.restart_team is frame.team
        return
    touched = frame.last_touch or owner(frame)
    if team.restart_pending:
        team.restart_pending = False
        if game.in_play:
            ours = touched is not None and touched.team is frame.team
            team.kicker = touched.number if touched is not None and ours else team.attacker
    elif team.kicker is not None and (
        not game.in_play or (touched is not None and touched != RobotId(frame.team, team.kicker))
    ):
        team.kicker = None


def _choose_attacker(frame: Frame, team: TeamStore) -> int | None:
    ball, field = frame.ball, frame.field
    if frame.game.penalty is frame.team and frame.game.may_touch and team.attacker is not None:
        return team.attacker
    placing = frame.game.restart is Restart.BALL_PLACEMENT
    if not placing and (
        in_own_defense_area(field, ball.x, ball.y, _REACH)
        or in_their_defense_area(field, ball.x, ball.y, _REACH)
    ):
        return None
    best: int | None = None
    least = present = inf
    for robot in frame.own:
        if robot.id == team.kicker or robot.id not in team.attackers:
            continue
        if ball.x > team.attackers[robot.id] and not placing:
            continue
        time = _time_to_ball(frame, robot)
        if robot.id == team.attacker:
            present = time
        if time < least:
            best, least = robot.id, time
    return team.attacker if present < least + SWITCH_GAIN else best


def _time_to_ball(frame: Frame, robot: RobotState) -> float:
    """Estimate when the robot can be at the ball, wherever that will be, with the goal before it [s]."""
    ball, game = frame.ball, frame.game
    x, y = ball.x, ball.y
    if not game.in_play and game.placement is not None and game.restart is not Restart.BALL_PLACEMENT:
        x, y = game.placement
    elif has_ball(robot, ball):
        return -_HELD
    elif abs(ball.vx) + abs(ball.vy) > _ROLLS:
        return min(
            [
                max(ahead, hypot(x + ahead * ball.vx - robot.x, y + ahead * ball.vy - robot.y) / _PACE)
                for ahead in _AHEAD
            ]
        )
    return hypot(robot.x - x, robot.y - y) / _PACE + min(_DETOUR, max(0.0, robot.x - x))


def _choose_marks(frame: Frame, team: TeamStore) -> dict[int, int]:
    """Assign opponents, those nearest to the own goal first, each to the nearest free marker."""
    goal_x, goal_y = frame.field.our_goal
    holder = owner(frame)
    free = [robot for robot in frame.own if robot.id in team.markers and robot.id != team.attacker]
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
