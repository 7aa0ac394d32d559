"""Settings of a team's tactics, and the record of them that compiled code reads."""

from __future__ import annotations

from pydantic import Field

from robobt.config.validation import Settings
from robobt.world.ball_model import BallModel
from robobt.world.compiled import FloatArray, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry


class TacticsSettings(Settings):
    """Settings for how the robots of a team share out tasks, places, passes and shots.

    The chances of shots and passes are hand-chosen functions, not calibrated probabilities.
    """

    # Who goes for the ball.
    switch_gain: float = Field(
        0.3,
        ge=0,
        le=10,
        description="another robot becomes the attacker if it can have the ball this much sooner [s]",
    )
    fresh_gain: float = Field(1.3, ge=0, le=10, description="switch_gain while the attacker is new [s]")
    fresh_for: float = Field(1.0, ge=0, le=60, description="how long an attacker is new [s]")
    restart_gain: float = Field(
        1.5, ge=0, le=60, description="switch_gain before a restart, where there is no hurry [s]"
    )
    held_gain: float = Field(0.3, ge=0, le=10, description="bonus for the robot that has the ball [s]")
    meant_gain: float = Field(0.4, ge=0, le=10, description="bonus for the receiver of a pass [s]")
    behind_ball: float = Field(
        0.3, ge=0, le=10, description="largest penalty of a robot beyond a resting ball [s]"
    )
    behind_below: float = Field(
        0.5, ge=0, le=10, description="ball speed below which that penalty applies [m/s]"
    )
    own_reach: float = Field(
        0.12,
        ge=0,
        le=5,
        description="no field player attacks a ball in the own defence area or this close to it [m]",
    )
    their_reach: float = Field(
        0.06,
        ge=0,
        le=5,
        description="no field player attacks a ball this close to the other team's defence area [m]",
    )
    shot_from: float = Field(
        4.5,
        ge=0,
        le=20,
        description="speed to their goal from which a ball counts as a shot and no new robot chases it [m/s]",
    )
    meeting_from: float = Field(
        0.5, ge=0, le=10, description="ball speed from which the attacker's meeting point is shared [m/s]"
    )

    # Possession.
    ours_margin: float = Field(
        0.1, ge=0, le=5, description="head start at the ball that changes possession [s]"
    )
    ours_after: float = Field(
        0.5, ge=0, le=60, description="how long a change has to last before the team acts on it [s]"
    )
    turns_after: float = Field(
        1.2, ge=0, le=60, description="least time between two changes of possession [s]"
    )
    ahead_from: float = Field(
        0.6, ge=0, le=10, description="distance from the half-way line at which the ball changes halves [m]"
    )
    # With grSim's limits (5 and 4.15), 85 of 100 searches found no pass worth trying, although four of five
    # passes that were played arrived.
    quickest: float = Field(
        3.0, gt=0, le=20, description="highest speed and acceleration assumed of opponents [m/s, m/s^2]"
    )

    # Tasks and places.
    pass_lasts: float = Field(
        3.0, ge=0, le=60, description="longest time for which a kicked pass counts as on its way [s]"
    )
    intent_lasts: float = Field(1.0, ge=0, le=60, description="how long a chosen pass stays intended [s]")
    meant_for: float = Field(
        1.0, ge=0, le=60, description="how long the receiver of an intended pass waits [s]"
    )
    keep_gain: float = Field(0.8, ge=0, le=60, description="bonus for the place of the present task [s]")
    long_way: float = Field(
        0.15, ge=0, le=10, description="weight of the squared travel times when places are shared out [1/s]"
    )
    same_place: float = Field(
        0.4,
        ge=0,
        le=5,
        description="a receiver this close to it takes the place beside the ball at a restart [m]",
    )
    facing: float = Field(
        0.5, ge=0, le=3.2, description="heading error to the ball allowed for waiting robots [rad]"
    )
    wall_lead: float = Field(
        0.15, ge=0, le=2, description="how far ahead in time the wall predicts the ball [s]"
    )
    mark_from: float = Field(0.8, ge=-10, le=10, description="opponents are marked up to this x [m]")
    mark_gap: float = Field(
        0.3, ge=0, le=5, description="distance from an opponent to its marker, between centres [m]"
    )
    mark_stays: float = Field(
        0.5, ge=0, le=10, description="a marked opponent counts as this much nearer to the goal [m]"
    )
    mark_off_ball: float = Field(
        0.5, ge=0, le=10, description="opponents closer to the ball than this are not marked [m]"
    )
    mark_goalward: float = Field(
        0.7, ge=0, le=10, description="weight of the direction to the goal beside that to the ball"
    )

    # Supporters.
    support_every: float = Field(0.25, ge=0, le=10, description="time between two searches for places [s]")
    apart: float = Field(
        1.6, gt=0, le=10, description="least distance between supporters, and to the ball [m]"
    )
    stay: float = Field(1.25, ge=0, le=10, description="factor on the value of the places chosen last")
    spacing: float = Field(0.5, ge=0.1, le=2, description="distance between the points considered [m]")
    edge: float = Field(0.3, ge=0, le=2, description="distance of these points from the lines [m]")
    origin_from: float = Field(
        1.0, ge=0, le=10, description="ball speed from which places are rated from the pass's target [m/s]"
    )
    short: float = Field(
        0.45, gt=0, le=5, description="distance of the team-mate beside the ball of an own restart [m]"
    )
    short_gain: float = Field(
        0.15,
        ge=0,
        le=5,
        description="additional space that the other side of that ball must have for a change [m]",
    )
    short_line: float = Field(0.15, ge=0, le=2, description="distance of that place from the lines [m]")
    short_area: float = Field(
        0.3, ge=0, le=2, description="distance of that place from the defence areas [m]"
    )

    # Passes.
    shortest: float = Field(1.4, ge=0, le=10, description="shortest pass [m]")
    shortest_restart: float = Field(
        0.35, ge=0, le=10, description="shortest pass from an own restart, where no opponent may be near [m]"
    )
    longest_chip: float = Field(
        6.0, ge=0, le=20, description="longest chipped pass [m]: what a chip within the rules' speed reaches"
    )
    area_gap: float = Field(
        0.15, ge=0, le=2, description="distance from a pass's target to the defence areas [m]"
    )
    area_gap_restart: float = Field(
        0.3, ge=0, le=2, description="that distance at an own restart, where no hull may be within 0.2 m [m]"
    )
    longest_wait: float = Field(
        1.2, ge=0, le=10, description="longest wait for a receiver that is not there yet [s]"
    )
    slowest_pass: float = Field(2.0, gt=0, le=20, description="slowest kick of a pass [m/s]")
    fastest_pass: float = Field(5.8, gt=0, le=20, description="fastest kick of a pass [m/s]")
    receive_speed: float = Field(
        2.2, ge=0, le=20, description="highest speed of a pass at its receiver [m/s]"
    )
    redirect_speed: float = Field(
        3.2, ge=0, le=20, description="speed at the receiver of a pass for a one-touch shot [m/s]"
    )
    shortest_redirect: float = Field(1.8, ge=0, le=10, description="shortest pass for a one-touch shot [m]")
    redirect_worth: float = Field(
        0.25, ge=0, le=1, description="least value of the ball at the end of a pass for a one-touch shot"
    )
    redirect_turn: float = Field(0.2, ge=0, le=5, description="time to turn to the goal before a shot [s]")
    turn_rate: float = Field(4.0, gt=0, le=50, description="turning rate of a passer into the pass [rad/s]")
    chip_touch_downs: int = Field(
        4,
        ge=1,
        le=20,
        description="number of touch-downs of a chip before it is received: it then hardly hops",
    )
    chip_rises: float = Field(
        0.2, ge=0, le=2, description="distance after which a chipped ball is above robots [m]"
    )
    chip_falls: float = Field(
        0.15, ge=0, le=2, description="distance before its first touch-down over which robots can stop it [m]"
    )
    chip_taken: float = Field(
        0.9, ge=0, le=1, description="chance that the receiver takes a chip that reaches it"
    )
    reaction: float = Field(0.15, ge=0, le=2, description="reaction time of an opponent to a kick [s]")
    margin: float = Field(
        0.12, gt=0, le=5, description="head start over an opponent that gives a chance of 0.73 [s]"
    )

    # Shots.
    shot_speed: float = Field(6.3, gt=0, le=20, description="speed of a shot [m/s]")
    fastest: float = Field(
        6.45, gt=0, le=20, description="speed of a kicked ball, sideways speed included [m/s]"
    )
    widest: float = Field(
        1.15,
        ge=0,
        le=3.2,
        description="largest angle by which a ball is redirected with one touch [rad]",
    )
    inset: float = Field(0.05, ge=0, le=0.4, description="distance from a post to the outermost aim [m]")
    spread: float = Field(
        0.045, gt=0, le=2, description="standard deviation of the distance at which a robot stops a shot [m]"
    )
    near_goal: float = Field(
        2.2,
        ge=0,
        le=10,
        description="opponents closer to their goal than this stay between it and the ball [m]",
    )
    keeps: float = Field(
        0.75, ge=0, le=10, description="opponents closer than this to its middle count as goalkeepers [m]"
    )
    sees: float = Field(
        0.12, ge=0, le=2, description="how long before the kick goalkeepers start to move to the aim [s]"
    )
    free: float = Field(
        1.5, gt=0, le=20, description="head start at the ball for full, or half, possession by one robot [s]"
    )

    # With the ball.
    anew_after: float = Field(
        0.3, ge=0, le=10, description="an interruption of the choice longer than this resets it [s]"
    )
    kept_for: float = Field(
        0.25, ge=0, le=5, description="time for which a ball that has left the mouth still counts as held [s]"
    )
    kept_within: float = Field(0.25, ge=0, le=2, description="largest distance at which that applies [m]")
    run_up_below: float = Field(
        0.3, ge=0, le=10, description="ball speed below which the robot may take a run-up [m/s]"
    )
    run_up_lead: float = Field(0.8, ge=0, le=10, description="head start needed for a run-up [s]")
    pressed: float = Field(
        0.35, ge=0, le=5, description="opponents closer to the ball than this count as pressure [m]"
    )
    holds: float = Field(
        0.5, ge=0, le=10, description="how far ahead the ball's value at its present place is rated [s]"
    )
    better: float = Field(
        1.15, ge=0, le=10, description="largest factor by which a pass has to exceed that value"
    )
    in_time: float = Field(
        0.1,
        ge=0,
        le=5,
        description="the passer waits for a receiver later than this; an earlier one meets the ball [s]",
    )
    late: float = Field(1.0, ge=0, le=60, description="time after which a restart is taken with any kick [s]")
    into_space: float = Field(
        1.5, gt=0, le=10, description="length of the kick with neither shot nor pass [m]"
    )

    # Receiving.
    armed: float = Field(0.7, ge=0, le=5, description="the kicker waits for a ball nearer than this [m]")
    bounced: float = Field(
        0.05, ge=0, le=1, description="how long a ball that bounced off is still kicked [s]"
    )
    redirect_from: float = Field(1.2, ge=0, le=20, description="slowest ball for a one-touch shot [m/s]")
    redirect_within: float = Field(
        1.5, ge=0, le=10, description="latest arrival of a ball for a one-touch shot [s]"
    )
    flies: float = Field(0.05, ge=0, le=5, description="greatest height of a ball for a one-touch shot [m]")
    hops: float = Field(
        0.5, ge=0, le=20, description="greatest vertical speed of a ball for a one-touch shot [m/s]"
    )
    catch_within: float = Field(
        0.25,
        ge=0,
        le=5,
        description="distance to the ball's line within which the robot catches the ball [m]",
    )
    catch_area: float = Field(
        0.3, ge=0, le=5, description="least distance of that place from the own defence area [m]"
    )
    astray: float = Field(
        0.6, ge=0, le=10, description="a pass that misses its target by more than this is met elsewhere [m]"
    )
    planned_within: float = Field(3.0, ge=0, le=60, description="longest time to the target [s]")
    stays_within: float = Field(
        0.5,
        ge=0,
        le=5,
        description="distance to the ball's line within which the robot keeps its place along it [m]",
    )
    receive_facing: float = Field(
        0.35, ge=0, le=3.2, description="heading error allowed to a distant ball [rad]"
    )


DEFAULT_TACTICS = TacticsSettings()


class AppliedTactics(TacticsSettings):
    """The settings, with the field's and the ball's numbers for which they are used.

    Attributes:
        half_length, half_width, half_goal, defense_depth, defense_width: sizes of the field [m].
        slide, roll: decelerations of the ball [m/s^2].
        share: share of a kick's speed that remains once the ball rolls. chip_speed, chip_lands,
            chip_lands_at, chip_rolls: for a chip of 1 m, its speed [m/s], when and where it first touches
            down [s, m], and when it rolls [s].
    """

    half_length: float
    half_width: float
    half_goal: float
    defense_depth: float
    defense_width: float
    slide: float
    roll: float
    share: float
    chip_speed: float
    chip_lands: float
    chip_lands_at: float
    chip_rolls: float


TACTICS = numbers_dtype(AppliedTactics)
"""The record of :func:`applied`'s numbers."""


def applied(tactics: TacticsSettings, field: FieldGeometry, model: BallModel) -> FloatArray:
    """Return the numbers of :class:`AppliedTactics` as compiled functions take them."""
    chip = model.chip_speed(1.0, tactics.chip_touch_downs)
    # Times grow with the root of the distance, distances in proportion. A chip of 25 m hops often enough.
    downs = model.touch_downs(5.0 * chip)
    lands, lands_at = downs[0][0] / 5.0, downs[0][1] / 25.0
    rolls = downs[min(tactics.chip_touch_downs, len(downs)) - 1][0] / 5.0
    return numbers_of(
        AppliedTactics.model_construct(
            **tactics.__dict__,
            half_length=field.half_length,
            half_width=field.half_width,
            half_goal=field.goal_width / 2.0,
            defense_depth=field.defense_depth,
            defense_width=field.defense_width,
            slide=model.slide_deceleration,
            roll=model.roll_deceleration,
            share=model.switch_share,
            chip_speed=chip,
            chip_lands=lands,
            chip_lands_at=lands_at,
            chip_rolls=rolls,
        )
    )
