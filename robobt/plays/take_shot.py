"""One shot at a given point, for the collection of shots."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.skills.aim.aim_at_goal_point import AimAtGoalPoint
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.tree import Behaviour, FailureIsSuccess, Sequence


@PLAYS.register("take_shot")
def take_shot(
    *,
    target_y: float = 0.0,
    place_x: float = 0.0,
    place_y: float = 0.0,
    dribble_speed: float = 2.0,
    tolerance: float = 0.0175,
    shot_speed: float | None = None,
    max_turn: float = 4.0,
) -> Behaviour:
    """Carry the ball to a place and shoot from there at a point of the goal line, whatever the chances.

    The shot is not rated, so that the collected data is not biased by a rating.

    Args:
        target_y: y coordinate of the point on the opponent's goal line [m].
        place_x: x coordinate of the place to shoot from [m]; a ball already there is not carried.
        place_y: y coordinate of the place to shoot from [m].
        dribble_speed: top speed with the ball [m/s].
        tolerance: angle by which the kick may be off [rad]; the default is RoboBulls' one degree.
        shot_speed: kick speed of the shot [m/s]; None for the kick's default.
        max_turn: turning rate with the ball [rad/s].
    """
    return Sequence(
        "take shot",
        memory=True,
        children=[
            AimAtGoalPoint(y=target_y),
            FailureIsSuccess("carry", DribbleTo(target=(place_x, place_y), max_speed=dribble_speed)),
            KickToTarget(kick_speed=shot_speed, tolerance=tolerance, max_turn=max_turn),
        ],
    )
