"""Where robots may be and how fast they may drive while the ball is not in play."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from robobt.match.referee.fouls import SPEED_TOLERANCE
from robobt.match.referee.restarts import Resumption
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import FieldGeometry
from robobt.world.game import Restart, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import own_side
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

_SPOT_TOLERANCE = 0.05
"""A ball further from its spot than this is put down anew [m]."""

_AT_REST = 0.05
"""A ball slower than this lies still [m/s]."""

_STANDING = 0.3
"""Robots slower than this stand ready [m/s]."""

_PENALTY_GAP = 1.0
"""Everybody but kicker and keeper stays this far behind the ball at a penalty kick [m]."""


def ball_placed(frame: Frame, spot: Point) -> bool:
    """Return whether the ball lies at rest at ``spot``."""
    return distance(frame.ball.position, spot) <= _SPOT_TOLERANCE and frame.ball.speed < _AT_REST


def spot_free(frame: Frame, spot: Point) -> bool:
    """Return whether no robot stands where the ball has to be put."""
    clear = ROBOT_RADIUS + BALL_RADIUS + 0.02
    return all(hypot(robot.x - spot[0], robot.y - spot[1]) > clear for robot in frame.robots().values())


def stop_violations(frame: Frame, settings: RefereeSettings) -> Iterator[RobotId]:
    """Find robots that are too fast while the game is stopped."""
    most = settings.stop_speed
    for identity, robot in frame.robots().items():
        if most is not None and robot.speed > most + SPEED_TOLERANCE:
            yield identity


def crowding(frame: Frame, settings: RefereeSettings, kicking: Team | None) -> Iterator[RobotId]:
    """Find opponents of the kicking team that are too close to the ball while a restart is taken."""
    least = settings.stop_distance
    for identity, robot in frame.robots().items():
        if least is not None and identity.team is not kicking and _ball_distance(robot, frame.ball) < least:
            yield identity


def ready(frame: Frame, field: FieldGeometry, settings: RefereeSettings, restart: Resumption) -> bool:
    """Return whether everybody stands where the rules demand it at a kick-off or penalty."""
    team = restart.team
    if team is None:
        return True
    kickers = 0
    for identity, robot in frame.robots().items():
        if robot.speed > _STANDING:
            return False
        if restart.restart is Restart.KICKOFF:
            fair = robot.x * own_side(identity.team) > 0.0
            if hypot(robot.x, robot.y) < field.center_radius + ROBOT_RADIUS:
                fair = identity.team is team
                kickers += 1
        elif identity == settings.keeper(team.other):
            fair = abs(abs(robot.x) - field.half_length) <= ROBOT_RADIUS
        else:
            behind = (restart.spot[0] - robot.x) * -own_side(team)
            fair = behind >= _PENALTY_GAP
            if not fair and identity.team is team and behind > 0.0:
                fair = True
                kickers += 1
        if not fair or kickers > 1:
            return False
    return True


def _ball_distance(robot: RobotState, ball: BallState) -> float:
    """Return the distance from the robot's hull to the ball's centre [m]."""
    return hypot(robot.x - ball.x, robot.y - ball.y) - ROBOT_RADIUS
