"""Plays of RoboBulls, the team of the paper's authors, as its published code behaves.

Scenarios and commands name them by this file, as ``paper/robobulls.py:robobulls_goalkeeper``.
"""

from __future__ import annotations

from robobt.motion import ROBOBULLS_LIMITS
from robobt.plays import first_of, play, when
from robobt.skills import (
    AimUpfield,
    BallAimedAtGoal,
    BallAtDefenseEdge,
    BallRestsInDefense,
    BestFieldPosition,
    BlockShot,
    CoverNearPost,
    DribbleTo,
    FetchBall,
    GoToBall,
    HasBall,
    KickAsRobobulls,
    PassIsSteady,
    PickUpBall,
    Rater,
    ReturnToGoal,
    SelectClearance,
    SelectPass,
    SelectShot,
    ShotComing,
    ShotIsSteady,
)
from robobt.tree import Behaviour, FailureIsSuccess
from robobt.world import RobotLimits

_QUICK = 1.5
"""How much faster the goalkeeper drives in danger."""


@play
def robobulls_go_to_ball_and_shoot(*, rater: Rater = "segment_clearance") -> Behaviour:
    """Kick the ball at the opponent's goal, with the way behind it: the baseline row of Table 4.

    Args:
        rater: the shot rater that chooses the point to shoot at, by name or with settings.
    """
    return when("go to ball and shoot", SelectShot(rater=rater), KickAsRobobulls())


@play
def robobulls_attack_main(
    *,
    rater: Rater = "segment_clearance",
    max_distance: float | None = None,
    shot_speed: float = 7.5,
    steady: float = 0.9,
) -> Behaviour:
    """Play ``attack_main`` with RoboBulls' kick, limits and counters.

    Source: RoboBulls' published code, AttackMain.

    Args:
        rater: the shot rater, by name or with settings.
        max_distance: no shots from farther than this from the goal [m]; None for no limit.
        shot_speed: kick speed of a shot [m/s].
        steady: how long a shot or pass must have been open [s].
    """
    look = SelectShot(rater=rater, max_distance=max_distance)
    return first_of(
        "attack main",
        when(
            "score",
            FailureIsSuccess("look for a shot", look),
            ShotIsSteady(rise=steady, fall=steady),
            KickAsRobobulls(kick_speed=shot_speed),
        ),
        when(
            "pass",
            FailureIsSuccess("look for a pass", SelectPass()),
            PassIsSteady(rise=steady, fall=steady),
            KickAsRobobulls(),
        ),
        when("dribble", HasBall(), BestFieldPosition(), DribbleTo()),
        when("get the ball", GoToBall(limits=ROBOBULLS_LIMITS), PickUpBall()),
    )


@play
def robobulls_goalkeeper(*, speed_factor: float = 1.0) -> Behaviour:
    """Keep the ball out of the own goal as the play ``goalkeeper`` does, but cover the near post.

    It drives at most 2.25 m/s, or 1.5 m/s without danger, with RoboBulls' accelerations, and clears with
    RoboBulls' kick. Source: RoboBulls' published code, Goalie.

    Args:
        speed_factor: factor on its top speed; 0.5 is the paper's half-speed goalkeeper.

    Raises:
        ValueError: the factor is not above 0.
    """
    if not speed_factor > 0.0:
        raise ValueError(f"speed_factor must be above 0, not {speed_factor}")
    quick, calm = _limits(_QUICK * speed_factor), _limits(speed_factor)

    def block() -> BlockShot:
        return BlockShot(limits=quick, dribbler=False, dive=False)

    return first_of(
        "goalkeeper",
        when("aim", BallAimedAtGoal(), block()),
        when("shot", ShotComing(min_speed=0.01), block()),
        when("fetch", BallAtDefenseEdge(), FetchBall(limits=calm)),
        when(
            "clear",
            BallRestsInDefense(),
            first_of("where to", SelectClearance(), AimUpfield()),
            KickAsRobobulls(limits=calm, goalkeeper=True),
        ),
        CoverNearPost(limits=quick),
        ReturnToGoal(limits=calm),
    )


def _limits(factor: float) -> RobotLimits:
    """Apply the factor of RoboBulls' pilot, which scales only the top speed."""
    return ROBOBULLS_LIMITS.model_copy(update={"max_speed": ROBOBULLS_LIMITS.max_speed * factor})
