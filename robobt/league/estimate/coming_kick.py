"""A ball that a kick on its way will send off before the next command takes effect."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from math import inf

from robobt.league.estimate.ball_track import BallMotion
from robobt.league.estimate.robot_track import RobotMotion, SentCommands
from robobt.world.ball_model import BallModel
from robobt.world.command import KickTrigger
from robobt.world.limits import RobotLimits
from robobt.world.predicted_ball import RobotWay, met_ball
from robobt.world.state import BallState, RobotId, RobotState


def kicked_ball(
    ball: BallMotion,
    since: float,
    until: float,
    at: Callable[[RobotId, float], RobotMotion],
    after: Mapping[RobotId, RobotMotion],
    sent: Mapping[RobotId, SentCommands],
    limits: Callable[[RobotId], RobotLimits],
    holders: Iterable[RobotId],
    without: Container[RobotId],
    model: BallModel,
) -> tuple[RobotId, BallMotion] | None:
    """Return the robot that is about to kick the ball, and the ball as it will be; None if none is.

    Args:
        ball: as it was at ``since``.
        since: time of the ball [s].
        until: time of the ball that is returned [s].
        at: predicts a robot at a time [s].
        after: the robots when their next commands move them.
        sent: commands to the robots.
        limits: of a robot.
        holders: the robots that carry the ball; of several nobody knows where a kick sends it.
        without: the robots whose sensors report no ball; they do not make a kick that is to be made at once.
        model: how the ball rolls.
    """
    kickers = [robot for robot in after if _kicks(sent.get(robot, []), since, until, robot not in without)]
    held = [robot for robot in holders if robot in after]
    if not kickers or len(held) > 1:
        return None
    ways = {
        robot: RobotWay(
            robot,
            _state(robot, at(robot, since), limits(robot)),
            _state(robot, after[robot], limits(robot)),
            since,
            until,
            sent.get(robot, []),
        )
        for robot in {*kickers, *held}
    }
    now = BallState(ball.x, ball.y, ball.vx, ball.vy, ball.z, ball.vz)
    met = met_ball(now, tuple(ways.values()), since, since, until, model, ways[held[0]] if held else None)
    if met.touched is None or met.kept:
        return None
    it = met.ball
    return met.touched.robot, BallMotion(it.x, it.y, it.vx, it.vy, model.switch_share * it.speed, it.z, it.vz)


def _kicks(sent: SentCommands, since: float, until: float, at_once: bool) -> bool:
    """Return whether a command to kick is in force at some time between two [s]; any, or on contact only."""
    ends = (*(it.since for it in sent[1:]), inf)
    # A robot that was sent nothing has one end and no command.
    return any(
        it.command.kick_speed > 0.0
        and it.since < until
        and end > since
        and (at_once or it.command.kick_trigger is KickTrigger.ON_CONTACT)
        for it, end in zip(sent, ends, strict=False)
    )


def _state(robot: RobotId, m: RobotMotion, limits: RobotLimits) -> RobotState:
    return RobotState(robot.number, m.x, m.y, m.heading, m.vx, m.vy, m.omega, limits=limits)
