"""The numbers that a team's tactics depend on, as settings and as the record that compiled code reads."""

from __future__ import annotations

from pydantic import Field

from robobt.config.validation import Settings
from robobt.world.ball_model import BallModel
from robobt.world.compiled import FloatArray, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry


class TacticsSettings(Settings):
    """What the robots of a team weigh when they share out tasks, places, passes and shots.

    The chances of shots and passes that follow are hand-chosen forms, not calibrated probabilities.
    """

    # Who goes for the ball.
    switch_gain: float = Field(
        0.3, ge=0, le=10, description="another robot attacks that can have the ball so much sooner [s]"
    )
    fresh_gain: float = Field(1.3, ge=0, le=10, description="switch_gain while the attacker is new [s]")
    fresh_for: float = Field(1.0, ge=0, le=60, description="how long an attacker is new [s]")
    restart_gain: float = Field(
        1.5, ge=0, le=60, description="switch_gain before a restart, where there is no hurry [s]"
    )
    held_gain: float = Field(0.3, ge=0, le=10, description="bonus of the robot that has the ball [s]")
    meant_gain: float = Field(0.4, ge=0, le=10, description="bonus of the receiver of a pass [s]")
    behind_ball: float = Field(
        0.3, ge=0, le=10, description="most that a robot beyond a resting ball counts as later [s]"
    )
    behind_below: float = Field(0.5, ge=0, le=10, description="ball speed below which that counts [m/s]")
    own_reach: float = Field(
        0.12, ge=0, le=5, description="nobody attacks a ball in the own defence area or this near to it [m]"
    )
    their_reach: float = Field(0.06, ge=0, le=5, description="the same of the other team's area [m]")
    shot_from: float = Field(
        4.5,
        ge=0,
        le=20,
        description="a ball faster than this to their goal, and no pass, is a shot: nobody new chases [m/s]",
    )
    meeting_from: float = Field(
        0.5, ge=0, le=10, description="ball speed from which the attacker's meeting point is told [m/s]"
    )

    # Whose ball it is.
    ours_margin: float = Field(
        0.1, ge=0, le=5, description="head start at the ball that changes whose it is [s]"
    )
    ours_after: float = Field(
        0.5, ge=0, le=60, description="how long that has to hold before the team acts on it [s]"
    )
    turns_after: float = Field(1.2, ge=0, le=60, description="least time between two such changes [s]")
    ahead_from: float = Field(
        0.6, ge=0, le=10, description="distance from the half-way line that counts as in that half [m]"
    )
    quickest: float = Field(
        3.0,
        gt=0,
        le=20,
        description="speed and acceleration that opponents are taken to use at most [m/s, m/s^2]: with all "
        "that grSim's robots have (5 and 4.15), 85 of 100 looks found no pass worth trying, though four of "
        "five passes that were played arrived",
    )

    # Tasks and places.
    pass_lasts: float = Field(3.0, ge=0, le=60, description="a kicked pass counts as under way at most [s]")
    intent_lasts: float = Field(1.0, ge=0, le=60, description="a pass that was chosen is meant for [s]")
    meant_for: float = Field(1.0, ge=0, le=60, description="how long a receiver waits that was meant [s]")
    keep_gain: float = Field(0.8, ge=0, le=60, description="bonus at the place of the present task [s]")
    long_way: float = Field(
        0.15, ge=0, le=10, description="weight of the squared travel times when places are shared out [1/s]"
    )
    same_place: float = Field(
        0.4, ge=0, le=5, description="a receiver nearer to it takes the short place of a restart [m]"
    )
    facing: float = Field(0.5, ge=0, le=3.2, description="how far off the ball who waits may look [rad]")
    wall_lead: float = Field(0.15, ge=0, le=2, description="how far ahead of the ball the wall looks [s]")
    mark_from: float = Field(0.8, ge=-10, le=10, description="opponents are marked up to this x [m]")
    mark_gap: float = Field(0.3, ge=0, le=5, description="from an opponent to its marker, centres [m]")
    mark_stays: float = Field(
        0.5, ge=0, le=10, description="a marked opponent counts as so much nearer to the goal [m]"
    )
    mark_off_ball: float = Field(
        0.5, ge=0, le=10, description="opponents nearer to the ball are not marked [m]"
    )
    mark_goalward: float = Field(
        0.7, ge=0, le=10, description="share of the direction to the goal in a marker's, beside the ball's"
    )

    # Supporters.
    support_every: float = Field(0.25, ge=0, le=10, description="between two looks for places [s]")
    apart: float = Field(1.6, gt=0, le=10, description="distance between supporters, and to the ball [m]")
    stay: float = Field(1.25, ge=0, le=10, description="factor on the worth of the places chosen last")
    spacing: float = Field(0.5, ge=0.1, le=2, description="between the points considered [m]")
    edge: float = Field(0.3, ge=0, le=2, description="distance of these points from the lines [m]")
    origin_from: float = Field(
        1.0, ge=0, le=10, description="ball speed from which places are rated from the pass's target [m/s]"
    )
    short: float = Field(
        0.45, gt=0, le=5, description="distance of the mate beside the ball of an own restart [m]"
    )
    short_gain: float = Field(
        0.15, ge=0, le=5, description="room that another side of that ball has to have more [m]"
    )
    short_line: float = Field(0.15, ge=0, le=2, description="distance of that place from the lines [m]")
    short_area: float = Field(0.3, ge=0, le=2, description="and from the defence areas [m]")

    # Passes.
    shortest: float = Field(1.4, ge=0, le=10, description="shortest pass [m]")
    shortest_restart: float = Field(
        0.35, ge=0, le=10, description="the same from an own restart, where no opponent may be near [m]"
    )
    longest_chip: float = Field(
        6.0, ge=0, le=20, description="longest chipped pass [m]: what a chip within the rules' speed reaches"
    )
    area_gap: float = Field(0.15, ge=0, le=2, description="from a pass's target to the defence areas [m]")
    area_gap_restart: float = Field(
        0.3, ge=0, le=2, description="the same at an own restart, where no hull may be within 0.2 m [m]"
    )
    longest_wait: float = Field(1.2, ge=0, le=10, description="for a receiver not there yet, at most [s]")
    slowest_pass: float = Field(2.0, gt=0, le=20, description="slowest kick of a pass [m/s]")
    fastest_pass: float = Field(5.8, gt=0, le=20, description="fastest kick of a pass [m/s]")
    receive_speed: float = Field(2.2, ge=0, le=20, description="of a pass at its receiver, at most [m/s]")
    redirect_speed: float = Field(
        3.2, ge=0, le=20, description="of a pass that is to be sent on with one touch, at its receiver [m/s]"
    )
    shortest_redirect: float = Field(1.8, ge=0, le=10, description="shortest such pass [m]")
    redirect_worth: float = Field(0.25, ge=0, le=1, description="least worth of the ball at its end")
    redirect_turn: float = Field(0.2, ge=0, le=5, description="time to turn to the goal before it [s]")
    turn_rate: float = Field(4.0, gt=0, le=50, description="of a passer into the pass [rad/s]")
    chip_touch_downs: int = Field(
        4, ge=1, le=20, description="times that a chip has touched down where it is received: it hardly hops"
    )
    chip_rises: float = Field(
        0.2, ge=0, le=2, description="way after which a chipped ball is above robots [m]"
    )
    chip_falls: float = Field(
        0.15, ge=0, le=2, description="way before its first touch-down on which robots stop it [m]"
    )
    chip_taken: float = Field(0.9, ge=0, le=1, description="chance that a chip that gets there is taken")
    reaction: float = Field(
        0.15, ge=0, le=2, description="before an opponent moves to a ball that it sees kicked [s]"
    )
    margin: float = Field(
        0.12, gt=0, le=5, description="head start over an opponent that gives a chance of 0.73 [s]"
    )

    # Shots.
    shot_speed: float = Field(6.3, gt=0, le=20, description="of a shot [m/s]")
    fastest: float = Field(
        6.45, gt=0, le=20, description="of a ball that leaves, sideways speed included [m/s]"
    )
    widest: float = Field(
        1.15,
        ge=0,
        le=3.2,
        description="angle between where a ball comes from and where it is kicked at once, at most [rad]",
    )
    inset: float = Field(0.05, ge=0, le=0.4, description="from a post to the outermost aim [m]")
    spread: float = Field(
        0.045, gt=0, le=2, description="standard deviation of what decides whether a robot stops a shot [m]"
    )
    near_goal: float = Field(
        2.2, ge=0, le=10, description="opponents nearer to their goal keep between it and the ball [m]"
    )
    keeps: float = Field(0.75, ge=0, le=10, description="opponents nearer to its middle keep their goal [m]")
    sees: float = Field(
        0.12, ge=0, le=2, description="how long before the kick these begin to move to the aim [s]"
    )
    free: float = Field(
        1.5, gt=0, le=20, description="head start at the ball with which it is a robot's alone, or half [s]"
    )

    # With the ball.
    anew_after: float = Field(0.3, ge=0, le=10, description="a choice not made for so long begins anew [s]")
    kept_for: float = Field(0.25, ge=0, le=5, description="a ball that has left the mouth counts as had [s]")
    kept_within: float = Field(0.25, ge=0, le=2, description="while it is no farther away than this [m]")
    run_up_below: float = Field(0.3, ge=0, le=10, description="a slower ball may have a run-up [m/s]")
    run_up_lead: float = Field(0.8, ge=0, le=10, description="head start that a run-up needs [s]")
    pressed: float = Field(0.35, ge=0, le=5, description="opponents nearer to the ball press [m]")
    holds: float = Field(
        0.5, ge=0, le=10, description="what the ball is worth here is rated so far ahead [s]"
    )
    better: float = Field(1.15, ge=0, le=10, description="times that worth has a pass to be worth, at most")
    in_time: float = Field(
        0.1, ge=0, le=5, description="a receiver later than this is waited for; else it meets the ball [s]"
    )
    late: float = Field(
        1.0, ge=0, le=60, description="after its patience a restart is taken with what there is [s]"
    )
    into_space: float = Field(1.5, gt=0, le=10, description="how far, with neither shot nor pass [m]")

    # Receiving.
    armed: float = Field(0.7, ge=0, le=5, description="the kicker waits for a ball nearer than this [m]")
    bounced: float = Field(0.05, ge=0, le=1, description="a ball that bounced off is still kicked for [s]")
    redirect_from: float = Field(1.2, ge=0, le=20, description="slowest ball sent on with one touch [m/s]")
    redirect_within: float = Field(1.5, ge=0, le=10, description="that is there no later than this [s]")
    flies: float = Field(0.05, ge=0, le=5, description="that is no higher than this [m]")
    hops: float = Field(0.5, ge=0, le=20, description="and rises or falls no faster [m/s]")
    catch_within: float = Field(0.25, ge=0, le=5, description="nearer to the ball's line it catches it [m]")
    catch_area: float = Field(0.3, ge=0, le=5, description="not so near to the own defence area [m]")
    astray: float = Field(0.6, ge=0, le=10, description="a pass off its target by more is met elsewhere [m]")
    planned_within: float = Field(3.0, ge=0, le=60, description="time to the target, at most [s]")
    stays_within: float = Field(
        0.5, ge=0, le=5, description="nearer to the ball's line it stays where it is along it [m]"
    )
    receive_facing: float = Field(0.35, ge=0, le=3.2, description="how far off a far ball it looks [rad]")


DEFAULT_TACTICS = TacticsSettings()


class AppliedTactics(TacticsSettings):
    """The settings, with the numbers of the field and the ball that they are applied to.

    Attributes:
        half_length, half_width, half_goal, defense_depth, defense_width: of the field [m].
        slide, roll: decelerations of the ball [m/s^2].
        share: of a kick's speed that is left once the ball rolls.
        chip_speed, chip_lands, chip_lands_at, chip_rolls: of a chip of 1 m: its speed [m/s], when and
            where it first touches down [s, m], and when it rolls [s].
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
    """Return the numbers of :class:`AppliedTactics`, as compiled functions of tactics take them."""
    chip = model.chip_speed(1.0, tactics.chip_touch_downs)
    # Times grow with the root of the distance, ways with the distance. A chip of 25 m hops often enough.
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
