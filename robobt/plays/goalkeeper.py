"""The goalkeeper."""

from __future__ import annotations

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.select_clearance import SelectClearance
from robobt.skills.ball.fetch_ball import FetchBall
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.ball_aimed_at_goal import BallAimedAtGoal
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.defence.block_shot import BlockShot
from robobt.skills.defence.cover_angle import CoverAngle
from robobt.skills.defence.cover_near_post import CoverNearPost
from robobt.skills.defence.return_to_goal import ReturnToGoal
from robobt.skills.defence.shot_coming import ShotComing
from robobt.skills.robobulls.kick_as_robobulls import KickAsRobobulls
from robobt.tree import Behaviour


@PLAYS.register("goalkeeper")
def goalkeeper(*, speed_factor: float = 1.0) -> Behaviour:
    """Keep the ball out of the own goal; the first branch whose condition holds is ticked.

    1. A robot aims at the goal: onto the line of the expected shot.
    2. A shot comes: onto its line.
    3. The ball rests on the edge of the defence area, no opponent near: fetch it.
    4. The ball rests in the defence area: clear it to a team-mate or upfield.
    5. The ball is in front of the goal: between ball and goal.
    6. Otherwise: back to its place in front of the goal.

    Source: RoboBulls' published code, Goalie.

    Args:
        speed_factor: factor on its top speed, with and without the ball; 0.5 is the
            paper's half-speed goalkeeper.
    """
    return keep_goal(
        speed_factor,
        when(
            "clear",
            BallRestsInDefense(),
            where_to_clear(),
            KickToTarget(speed_factor=speed_factor, goalkeeper=True),
        ),
    )


def keep_goal(speed_factor: float, clear: Behaviour, learned: Behaviour | None = None) -> Behaviour:
    """Return the tree of ``goalkeeper`` with a given clearance.

    Args:
        speed_factor: factor on the top speed.
        clear: tree for a ball that rests in the area.
        learned: tree to try first for a ball that does not rest.
    """
    block = (
        when("aim", BallAimedAtGoal(), BlockShot(speed_factor=speed_factor)),
        when("shot", ShotComing(margin=0.1), BlockShot(speed_factor=speed_factor)),
    )
    take = (when("fetch", BallAtDefenseEdge(), FetchBall(speed_factor=speed_factor)), clear)
    first = (*block, *take) if learned is None else (*take, learned, *block)
    return first_of(
        "goalkeeper", *first, CoverAngle(speed_factor=speed_factor), ReturnToGoal(speed_factor=speed_factor)
    )


@PLAYS.register("fitted_goalkeeper")
def fitted_goalkeeper(
    *,
    max_speed: float = 2.25,
    acceleration: float = ROBOBULLS_LIMITS.acceleration,
    braking: float = ROBOBULLS_LIMITS.braking,
    offset: float = 0.0,
) -> Behaviour:
    """Keep the goal as the paper's goalkeeper does, with traits that were fitted to recorded shots.

    It covers the near post where ``goalkeeper`` covers the angle between the posts, drives with RoboBulls'
    limits and clears with RoboBulls' kick.

    Args:
        max_speed: top speed [m/s].
        acceleration: acceleration [m/s^2].
        braking: deceleration with which it plans to stop [m/s^2].
        offset: distance beside the line of a shot, to the left in the ball's direction [m].
    """
    limits = ROBOBULLS_LIMITS.model_copy(
        update={"max_speed": max_speed, "acceleration": acceleration, "braking": braking}
    )

    def block() -> BlockShot:
        return BlockShot(limits=limits, dribbler=False, dive=False, offset=offset)

    return first_of(
        "goalkeeper",
        when("aim", BallAimedAtGoal(), block()),
        when("shot", ShotComing(min_speed=0.01), block()),
        when("fetch", BallAtDefenseEdge(), FetchBall(limits=limits)),
        when(
            "clear",
            BallRestsInDefense(),
            where_to_clear(),
            KickAsRobobulls(limits=limits, goalkeeper=True),
        ),
        CoverNearPost(limits=limits),
        ReturnToGoal(limits=limits),
    )


def where_to_clear() -> Behaviour:
    """Aim at a team-mate, else at free space."""
    return first_of("where to", SelectClearance(), AimUpfield())
