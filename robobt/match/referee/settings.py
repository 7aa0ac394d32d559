"""The referee's checks and times."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from robobt.config.validation import Settings
from robobt.world.division import Division
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.rules import CARRY_DISTANCE, IN_PLAY_DISTANCE, STOP_DISTANCE, STOP_SPEED
from robobt.world.state import RobotId

Time = Annotated[float, Field(ge=0)] | Literal["rules"]
"""A time [s], or the time in the rules of the field's division."""


class RefereeSettings(Settings):
    """The referee's checks, and its times in simulated seconds.

    By default distances, speeds and times are those in the rules of the field's division. None or false turns
    a check off.
    """

    opening: Literal["kickoff", "force_start", "free_kick", "penalty", "ball_placement", "shoot_out"] = Field(
        "kickoff", description="how the match begins"
    )
    opening_team: Team = Field(Team.BLUE, description="team of the opening, such as the first kick-off")
    opening_spot: Point | Literal["random"] | None = Field(
        None,
        description="spot of the free kick or ball placement at the opening, in world coordinates; by "
        "default the ball's position [m]",
    )
    placement: Literal["robots", "by_hand"] = Field(
        "robots",
        description="who brings the ball to a free kick: robots as the rules say, or a hand, at once and "
        "without waiting for robots nearby",
    )
    placement_time: float = Field(30.0, gt=0, le=600, description="time for a team to place the ball [s]")
    blue_can_place: bool = Field(True, description="division B: whether blue places the ball")
    yellow_can_place: bool = Field(True, description="division B: whether yellow places the ball")
    stop_time: float = Field(
        2.0, ge=0, le=60, description="time for which positions must be right before play continues [s]"
    )
    stop_after_halt: float = Field(10.0, ge=0, le=600, description="shortest STOP after a HALT [s]")
    placement_delay: float = Field(
        0.0, ge=0, le=60, description="time from STOP until the ball is placed by hand [s]"
    )
    kickoff_wait: float | None = Field(
        None,
        ge=0,
        le=600,
        description="longest wait for robots to get to their positions; none for no limit [s]",
    )
    kick_timeout: Time = Field(
        "rules",
        description="time to take a kick-off or free kick; by the rules 10, 5 or 10 s [s]",
    )
    in_play_distance: float = Field(
        IN_PLAY_DISTANCE, gt=0, le=0.5, description="movement after which the ball is in play [m]"
    )
    double_touch: bool = Field(True, description="the kicker may not touch the ball twice")
    defense_areas: bool = Field(
        True, description="touching the ball in the defence areas, and standing near them"
    )
    aimless_kick: bool = Field(
        True, description="division B: no kick from the own half over the far goal line"
    )
    max_dribble: float | None = Field(
        CARRY_DISTANCE, gt=0, le=50, description="longest distance with the ball [m]"
    )
    max_ball_speed: float | None = Field(6.5, gt=0, le=50, description="fastest kick [m/s]")
    crash_speed: float | None = Field(1.5, gt=0, le=20, description="closing speed of a crash [m/s]")
    pushing: bool = Field(False, description="no robot pushes another; AutoReferee does not check it either")
    keeper_hold_time: Time | None = Field(
        "rules", description="longest stay of the ball in a defence area; by the rules 5 or 10 s [s]"
    )
    no_progress_time: Time | None = Field(
        "rules",
        description="time with the ball at rest that counts as lack of progress; by the rules 5 or 10 s [s]",
    )
    no_progress_distance: float = Field(0.1, gt=0, le=5, description="largest movement of a ball at rest [m]")
    stop_speed: float | None = Field(STOP_SPEED, gt=0, le=20, description="fastest robot in STOP [m/s]")
    stop_distance: float | None = Field(
        STOP_DISTANCE,
        gt=0,
        le=5,
        description="least distance of opponents' hulls from the ball at a restart [m]",
    )
    grace: float = Field(2.0, ge=0, le=60, description="time to slow down and clear the ball [s]")
    max_robots: int | None = Field(
        None, ge=1, le=32, description="robots a team may have; by default the division's 11 or 6"
    )
    yellow_card_time: float = Field(
        120.0, gt=0, le=3600, description="playing time that a yellow card lasts [s]"
    )
    half_length: float | None = Field(
        None, gt=0, le=36000, description="playing time of a half; none for one half without end [s]"
    )
    half_time: float = Field(0.0, ge=0, le=3600, description="HALT between two halves [s]")
    extra_length: float | None = Field(
        None,
        gt=0,
        le=36000,
        description="playing time of a half of overtime after a draw; none for no overtime [s]",
    )
    shoot_out: bool = Field(False, description="whether a shoot-out decides a draw")
    blue_keeper: int = Field(0, ge=0, le=31, description="number of blue's goalkeeper")
    yellow_keeper: int = Field(0, ge=0, le=31, description="number of yellow's goalkeeper")

    @field_validator("opening_spot", mode="before")
    @classmethod
    def _spot_of_a_file(cls, value: object) -> object:
        return tuple(value) if isinstance(value, list) else value

    def keeper(self, team: Team) -> RobotId:
        """Return ``team``'s goalkeeper at the start."""
        return RobotId(team, self.blue_keeper if team is Team.BLUE else self.yellow_keeper)

    def can_place(self, team: Team) -> bool:
        """Return whether ``team`` is asked to place the ball."""
        return self.blue_can_place if team is Team.BLUE else self.yellow_can_place


def in_seconds(setting: Time, division: Division) -> float:
    """Return a time, by default the division's time for a free kick [s]."""
    return division.kick_time if setting == "rules" else setting
