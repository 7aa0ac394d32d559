"""The reasons for which the official controller waits, in words, because it does not report them.

Source: ssl-game-controller, ``engine/process_continue_next_command.go``.
"""

from __future__ import annotations

from math import hypot

from robobt.config.wording import counted
from robobt.match.referee.positions import NEAR_SPOT, PLACEMENT_AREA_GAP, STILL_BALL_SPEED, penalty_problems
from robobt.match.referee.restarts import penalty
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import distance
from robobt.world.presence import without_absent
from robobt.world.rules import ball_out, in_defense_area, own_side
from robobt.world.state import ROBOT_RADIUS, Frame

_NEAR_BALL = 0.54
"""No robot's centre may be nearer to the ball in STOP [m]."""


def ball_problems(field: FieldGeometry, frame: Frame, game: GameState) -> list[str]:
    """Return why the ball's place prevents play from continuing; empty if it is right."""
    ball, problems = frame.ball, []
    if ball.speed >= STILL_BALL_SPEED:
        problems.append("the ball rolls")
    if game.placement is not None and distance(ball.position, game.placement) > NEAR_SPOT:
        problems.append(f"the ball is {distance(ball.position, game.placement):.2f} m from its place")
    if any(in_defense_area(field, team, ball.x, ball.y, PLACEMENT_AREA_GAP) for team in Team):
        problems.append("the ball is too near to a defence area")
    if ball_out(field, ball.position):
        problems.append("the ball is out of the field")
    return problems


def waits_for(field: FieldGeometry, frame: Frame, game: GameState) -> list[str]:
    """Return why a STOP or the preparation of a kick-off or penalty kick does not continue, in words.

    The frame is a true one, seen from blue's side.
    """
    frame = without_absent(frame, game)
    robots = frame.robots()
    kicking = game.restart_team
    if game.restart is Restart.PENALTY and kicking is not None and game.command is not RefereeCommand.STOP:
        return list(penalty_problems(frame, field, game, penalty(field, kicking).spot, kicking))
    if game.restart is Restart.KICKOFF and game.command is not RefereeCommand.STOP:
        return [
            f"{robot} is not in its own half"
            for robot, state in robots.items()
            if state.x * own_side(robot.team) < ROBOT_RADIUS
        ]
    if game.command is not RefereeCommand.STOP:
        return []
    problems = ball_problems(field, frame, game)
    for robot, state in robots.items():
        gap = hypot(state.x - frame.ball.x, state.y - frame.ball.y)
        taker = game.restart is Restart.FREE_KICK and robot.team is game.restart_team
        if gap < _NEAR_BALL and not taker:
            problems.append(f"{robot} is {gap:.2f} m from the ball")
    for team in Team:
        most, there = game.status(team).max_robots, sum(robot.team is team for robot in robots)
        if most is not None and there > most:
            problems.append(f"{team.value} has {counted(there, 'robot')} and may have {most}")
    return problems
