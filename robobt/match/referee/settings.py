"""What the referee checks, and its times."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from robobt.config.validation import Settings
from robobt.world.game import Team
from robobt.world.rules import CARRY_DISTANCE, IN_PLAY_DISTANCE, STOP_DISTANCE, STOP_SPEED
from robobt.world.state import RobotId


class RefereeSettings(Settings):
    """What the referee checks and how long things take, in simulated seconds.

    The distances and speeds are the rules' own; the pauses are short, because
    nobody has to carry the ball. A check whose value is None or false is off.
    """

    opening: Literal["kickoff", "force_start"] = Field("kickoff", description="how the match begins")
    stop_time: float = Field(0.3, ge=0, le=60, description="shortest STOP before a restart [s]")
    placement_delay: float = Field(
        0.0, ge=0, le=60, description="from STOP until the ball lies at the restart's place [s]"
    )
    kickoff_wait: float = Field(
        2.0, ge=0, le=60, description="longest wait for positions at a kick-off or penalty [s]"
    )
    kick_timeout: float = Field(10.0, gt=0, le=60, description="a restart not taken by then is over [s]")
    in_play_distance: float = Field(
        IN_PLAY_DISTANCE, gt=0, le=0.5, description="the ball is in play after moving this far [m]"
    )
    double_touch: bool = Field(True, description="the kicker may not touch the ball twice")
    defense_areas: bool = Field(True, description="who may touch the ball in the defence areas")
    aimless_kick: bool = Field(True, description="no kick from the own half over the far goal line")
    max_dribble: float | None = Field(
        CARRY_DISTANCE, gt=0, le=50, description="longest way with the ball [m]"
    )
    max_ball_speed: float | None = Field(6.5, gt=0, le=50, description="fastest kick [m/s]")
    crash_speed: float | None = Field(1.5, gt=0, le=20, description="closing speed of a crash [m/s]")
    pushing: bool = Field(False, description="no robot shoves another; AutoReferee does not look either")
    keeper_hold_time: float | Literal["rules"] | None = Field(
        "rules", description="longest stay of the ball in a defence area; by the rules 5 or 10 s [s]"
    )
    no_progress_time: float | Literal["rules"] | None = Field(
        "rules", description="ball at rest for so long; by the rules 5 or 10 s [s]"
    )
    no_progress_distance: float = Field(0.1, gt=0, le=5, description="what counts as at rest [m]")
    stop_speed: float | None = Field(STOP_SPEED, gt=0, le=20, description="fastest robot in STOP [m/s]")
    stop_distance: float | None = Field(
        STOP_DISTANCE, gt=0, le=5, description="robot's hull to ball in STOP [m]"
    )
    grace: float = Field(2.0, ge=0, le=60, description="time to slow down and clear the ball [s]")
    half_length: float | None = Field(
        None, gt=0, le=36000, description="length of a half; none: one half without end [s]"
    )
    half_time: float = Field(0.0, ge=0, le=3600, description="HALT between the halves [s]")
    blue_keeper: int = Field(0, ge=0, le=31, description="number of blue's goalkeeper")
    yellow_keeper: int = Field(0, ge=0, le=31, description="number of yellow's goalkeeper")

    def keeper(self, team: Team) -> RobotId:
        """Return ``team``'s goalkeeper."""
        return RobotId(team, self.blue_keeper if team is Team.BLUE else self.yellow_keeper)
