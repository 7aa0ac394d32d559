"""Checks of ball and robot positions before play continues.

Source: the league's game controller, ``engine/process_continue*.go``.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from robobt.match.referee.restarts import Resumption
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, Restart, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import STOP_DISTANCE, area_distance, own_side
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotId

_SPOT_TOLERANCE = 0.05
"""A ball farther from its spot than this is placed again by hand [m]."""

_AT_REST = 0.05
"""A ball slower than this counts as at rest for placement by hand [m/s]."""

STILL_BALL_SPEED = 0.2
"""A ball slower than this does not prevent play from continuing [m/s]."""

NEAR_SPOT = 1.0
"""A ball closer to its spot than this need not be placed [m]."""

PLACEMENT_AREA_GAP = 0.7
"""A ball closer to a defence area than this has to be placed [m]."""

_STOP_BALL_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS - 0.05
"""Least distance of robots' centres from the ball [m]."""

_PENALTY_MARK = 0.15
"""Largest distance of the ball from the mark at a penalty kick [m]."""

_PENALTY_GAP = 1.0
"""Distance behind the ball at a penalty kick for all but kicker and goalkeeper [m]."""


def ball_placed(frame: Frame, spot: Point) -> bool:
    """Return whether the ball is at rest at ``spot``, as after placement by hand."""
    return distance(frame.ball.position, spot) <= _SPOT_TOLERANCE and frame.ball.speed < _AT_REST


def spot_free(frame: Frame, spot: Point) -> bool:
    """Return whether no robot stands where the ball has to be placed."""
    clear = ROBOT_RADIUS + BALL_RADIUS + 0.02
    return all(
        hypot(robot.x - spot[0], robot.y - spot[1]) > clear for robot in (*frame.own, *frame.opponents)
    )


def needs_placement(frame: Frame, field: FieldGeometry, spot: Point) -> bool:
    """Return whether the ball has to be placed before a free kick or forced start at ``spot``."""
    x, y = frame.ball.position
    return (
        frame.ball.speed >= STILL_BALL_SPEED
        or distance((x, y), spot) > NEAR_SPOT
        or not field.contains(x, y)
        or min(area_distance(field, team, x, y) for team in Team) < PLACEMENT_AREA_GAP
    )


def stop_clear(frame: Frame, game: GameState, following: Resumption) -> bool:
    """Return whether the robots' positions allow play to continue after a STOP.

    No team may have too many robots, and no robot (at a free kick no opponent) may be near the ball.
    """
    free_kick = following.team if following.restart is Restart.FREE_KICK else None
    ball = frame.ball
    for team, robots in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents)):
        most = game.status(team).max_robots
        if most is not None and len(robots) > most:
            return False
        if team is free_kick:
            continue
        for robot in robots:
            dx, dy = robot.x - ball.x, robot.y - ball.y
            if dx * dx + dy * dy < _STOP_BALL_DISTANCE * _STOP_BALL_DISTANCE:
                return False
    return True


def ready(frame: Frame, field: FieldGeometry, game: GameState, restart: Resumption) -> bool:
    """Return whether all robots are in position for a kick-off or penalty kick."""
    assert restart.team is not None
    if restart.restart is Restart.KICKOFF:
        return distance(frame.ball.position, restart.spot) <= field.center_radius and all(
            own_side(team) * robot.x >= ROBOT_RADIUS
            for team, robots in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents))
            for robot in robots
        )
    return not any(penalty_problems(frame, field, game, restart.spot, restart.team))


def penalty_problems(
    frame: Frame, field: FieldGeometry, game: GameState, mark: Point, kicking: Team
) -> Iterator[str]:
    """Return what prevents ``kicking`` from taking a penalty kick from ``mark``; empty if all is ready."""
    if distance(frame.ball.position, mark) > _PENALTY_MARK:
        yield f"the ball is {distance(frame.ball.position, mark):.2f} m from the mark"
    defending, forward = kicking.other, -own_side(kicking)
    number, near = game.status(defending).keeper, []
    keeper = None if number is None else RobotId(defending, number)
    if keeper is None or keeper not in frame.robots():
        yield f"{defending.value} has no goalkeeper" + ("" if number is None else f", its number is {number}")
    for robot, state in frame.robots().items():
        if robot == keeper:
            on_line = abs(state.x - forward * field.half_length) <= ROBOT_RADIUS
            if not on_line or abs(state.y) > field.goal_width / 2:
                yield f"{robot} is not on its goal line"
        elif forward * (frame.ball.x - state.x) < _PENALTY_GAP:
            near.append(robot)
    kickers = [robot for robot in near if robot.team is kicking]
    # One of them is the kicker.
    for robot in [robot for robot in near if robot.team is defending] + kickers[1:]:
        yield f"{robot} is not {_PENALTY_GAP:g} m behind the ball"
