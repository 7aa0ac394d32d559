"""Settings of Score-On-Goalkeeper."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.learning.envs.score_on_goalkeeper.rewards import ScoreReward
from robobt.learning.envs.settings import OrderedSettings, Span, TaskSettings
from robobt.models.actions import SCORE_ACTION, ActionScaling

Kind = Literal["line", "angle", "aim", "rush", "shipped", "fitted"]


class KeeperSettings(OrderedSettings):
    """The opposing goalkeepers; one is drawn for each episode.

    ``shipped`` is the play ``goalkeeper``; ``fitted`` is fitted to real shots, with its own speed and place
    (extra "shots"); the others are in :mod:`robobt.learning.opponents.keepers`.
    """

    kinds: tuple[Kind, ...] = Field(
        ("line", "angle", "aim", "rush"), min_length=1, max_length=20, description="one of them is drawn"
    )
    speed: Span = Field((1.0, 3.0), description="top speed [m/s]")
    out: Span = Field((0.12, 0.6), description="distance in front of the goal line [m]")

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        if self.speed[0] <= 0.0 or self.out[0] < 0.0:
            raise ValueError("speed must be above 0 and out not negative")
        return self


class ScoreStarts(OrderedSettings):
    """Starts of episodes; None for a range takes the attacked half up to near the defence area."""

    held: float = Field(0.6, ge=0, le=1, description="share that starts with the ball in the mouth")
    robot_x: Span | None = None
    robot_y: Span | None = None
    easy: bool = Field(
        True,
        description="x is more often near the goal than far from it, and the heading more often towards it",
    )
    robot_speed: Span = Field((0.0, 0.0), description="in any direction, without the ball [m/s]")
    ball_speed: Span = Field((0.0, 0.5), description="in any direction, of a free ball [m/s]")
    keeper_y: Span = Field((-0.5, 0.5), description="y coordinate of the goalkeeper [m]")


class ScoreOnGoalkeeperSettings(TaskSettings):
    """Score-On-Goalkeeper: get the ball and score."""

    action: ActionScaling = SCORE_ACTION
    time_limit: int = Field(334, ge=1, le=100_000, description="ticks to the end of an episode")
    decide_every: int = Field(2, ge=1, le=20, description="ticks for which an action holds")
    keepers: KeeperSettings = KeeperSettings()
    held_by_keeper: int = Field(
        8, ge=1, le=1000, description="ticks in the goalkeeper's mouth after which the ball is lost"
    )
    saved: bool = Field(False, description="whether a ball that the goalkeeper touches is lost at once")
    dribbling: float | None = Field(
        None, gt=0, le=20, description="longest distance with the ball in the mouth, by the rules 1 [m]"
    )
    reward: ScoreReward = ScoreReward()
    starts: ScoreStarts = ScoreStarts()

    @model_validator(mode="after")
    def _kicks(self) -> Self:
        if self.action.kind != "drive_and_kick":
            raise ValueError("action: Score-On-Goalkeeper needs drive_and_kick actions")
        return self
