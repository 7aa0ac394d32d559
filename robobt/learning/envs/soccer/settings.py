"""Settings of the tasks with several robots."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings
from robobt.learning.envs.score_on_goalkeeper.settings import KeeperSettings
from robobt.learning.envs.settings import OrderedSettings, Span, TaskSettings
from robobt.learning.envs.soccer.rewards import SoccerReward
from robobt.learning.opponents.play_settings import GivenPlay
from robobt.models.actions import SCORE_ACTION, ActionScaling

Role = Literal[
    "learner",
    "goalkeeper",
    "play",
    "challenge",
    "still",
    "press",
    "mark",
    "wall",
    "attack",
    "pass",
    "redirect",
]
Aim = Literal["score", "save", "keep", "pass", "hold"]
AIMS = ("score", "save", "keep", "pass", "hold")
LEARNER: Role = "learner"
GOALKEEPER: Role = "goalkeeper"
PLAY_ROLE: Role = "play"
KEEPING = ("goalkeeper", "fitted_goalkeeper", "refereed_goalkeeper", "team_goalkeeper", "goalkeeper_2026_11")
"""Plays of goalkeepers."""


class SoccerStarts(OrderedSettings):
    """Starts of episodes: robots and ball anywhere in their ranges, with any heading, at rest.

    Goalkeepers stand in front of the middle of their goals.
    """

    blue_x: Span = Field((-3.0, 2.5), description="[m]")
    yellow_x: Span = Field((-2.5, 3.0), description="[m]")
    y: Span = Field((-2.5, 2.5), description="of all robots and the ball [m]")
    ball_x: Span = Field((-2.5, 2.5), description="[m]")
    ball_speed: Span = Field((0.0, 0.5), description="in any direction, of a free ball [m/s]")
    coming: float = Field(
        0.0,
        ge=0,
        le=1,
        description="share of starts in which the ball rolls towards blue's first field player, from afar",
    )
    held: float = Field(0.0, ge=0, le=1, description="share of starts with the ball in a mouth")
    holder: Literal["blue", "yellow", "either"] = Field(
        "blue", description="team whose first field player then has the ball"
    )
    apart: float = Field(0.35, ge=0.2, le=2, description="least distance between robots, and to the ball [m]")


class SoccerRules(Settings):
    """Ends of an episode, besides a goal, the ball over a line and the time limit.

    With ``restarts`` a ball over a line, a ball carried too far, a learner in the other team's area and a
    double touch do not end an episode: they stop play, which continues with a restart of the league.
    """

    restarts: bool = Field(
        False,
        description="whether a ball out and faults lead to restarts instead of ending the episode",
    )
    double_touch: bool = Field(
        False, description="whether the kicker of a restart may not touch the ball before another robot has"
    )

    held_by: int | None = Field(
        8, ge=1, le=1000, description="ticks in the other team's mouths after which the ball is lost"
    )
    areas: bool = Field(True, description="a learner's centre in the other team's defence area is a fault")
    dribbling: float | None = Field(
        None, gt=0, le=20, description="longest distance with the ball in one mouth, by the rules 1 [m]"
    )
    let_go: float | None = Field(
        None,
        gt=0,
        le=20,
        description="carried distance after which a learner is made to release the ball, as in plays [m]",
    )
    longest_hold: int | None = Field(
        None, ge=1, le=1000, description="most ticks in a row in blue's mouths; None for no limit"
    )
    hold: int = Field(
        8, ge=1, le=1000, description="ticks in a mouth that count as held, for the aim ``hold``"
    )
    pass_length: float = Field(0.8, ge=0.2, le=10, description="least length of a pass [m]")

    @property
    def told(self) -> int:
        """Number of entries of an observation on restarts."""
        return int(self.restarts) + int(self.double_touch)

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        if self.double_touch and not self.restarts:
            raise ValueError("double_touch: there is nothing to touch twice without restarts")
        if self.let_go is not None and self.dribbling is not None and self.let_go >= self.dribbling:
            raise ValueError(f"let_go: {self.let_go:g} m is too late, dribbling allows {self.dribbling:g} m")
        return self


class SoccerSettings(TaskSettings):
    """Any mix of learned and scripted robots: blue attacks towards +x, yellow towards -x."""

    action: ActionScaling = SCORE_ACTION
    time_limit: int = Field(334, ge=1, le=100_000, description="ticks to the end of an episode")
    decide_every: int = Field(2, ge=1, le=20, description="ticks for which an action holds")
    blue: tuple[Role, ...] = Field(("learner",), min_length=1, max_length=11, description="who plays")
    yellow: tuple[Role, ...] = Field((), max_length=11, description="the opponents of the learners")
    plays: tuple[GivenPlay, ...] = Field(
        (),
        description="plays of the robots with the role play, in order, blue's first: a play's name, or with "
        "parameters {play: NAME, params: {...}}",
    )
    aim: Aim = Field(
        "score",
        description="success: blue's goal, none against it, the ball kept, a pass of blue's, the ball held",
    )
    mates: int | None = Field(None, ge=0, le=10, description="seen; None for as many as there are")
    opponents: int | None = Field(None, ge=0, le=11, description="seen; None for as many as there are")
    player_speed: float = Field(2.0, gt=0, le=10, description="top speed of scripted field players [m/s]")
    keepers: KeeperSettings = KeeperSettings()
    rules: SoccerRules = SoccerRules()
    reward: SoccerReward = SoccerReward()
    starts: SoccerStarts = SoccerStarts()

    @property
    def roles(self) -> tuple[Role, ...]:
        """Roles of all robots in an arena, blue's first."""
        return (*self.blue, *self.yellow)

    @property
    def keeping(self) -> tuple[bool, ...]:
        """Which robots start in their goals."""
        plays, blue = iter(self.plays), len(self.blue)
        by_play = [role == PLAY_ROLE and next(plays).play in KEEPING for role in self.roles]
        return tuple(
            role == GOALKEEPER or (index >= blue and by_play[index]) for index, role in enumerate(self.roles)
        )

    @property
    def learners(self) -> tuple[int, ...]:
        """Indices of the robots that learn."""
        return tuple(index for index, role in enumerate(self.roles) if role == LEARNER)

    @property
    def two_alike(self) -> bool:
        """Whether two teams of equal size play, both with learners."""
        return LEARNER in self.blue and LEARNER in self.yellow and len(self.blue) == len(self.yellow)

    @property
    def ball_speed(self) -> float:
        """See :attr:`TaskSettings.ball_speed`."""
        return self.starts.ball_speed[1]

    @property
    def sides(self) -> tuple[int, int]:
        """Largest number of robots in a learner's own team and in the other team."""
        sizes = [(len(self.blue), len(self.yellow)), (len(self.yellow), len(self.blue))]
        learning = [LEARNER in self.blue, LEARNER in self.yellow]
        seen = [size for size, learns in zip(sizes, learning, strict=True) if learns] or sizes[:1]
        own, others = (max(column) for column in zip(*seen, strict=True))
        return own, others

    @property
    def places(self) -> tuple[int, int]:
        """Numbers of team-mates and opponents that each learner sees."""
        own, others = self.sides
        return (
            own - 1 if self.mates is None else self.mates,
            others if self.opponents is None else self.opponents,
        )

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        if self.action.kind != "drive_and_kick":
            raise ValueError("action: tasks of several robots need drive_and_kick actions")
        played = self.roles.count(PLAY_ROLE)
        if len(self.plays) != played:
            raise ValueError(f"plays: names {len(self.plays)}, for {played} robots with the role play")
        if not self.learners:
            raise ValueError("blue, yellow: nobody is a learner")
        if self.blue.count(GOALKEEPER) > 1 or self.yellow.count(GOALKEEPER) > 1:
            raise ValueError("blue, yellow: a team has one goalkeeper at most")
        if (GOALKEEPER in self.blue and not self.yellow) or (not self.blue and GOALKEEPER in self.yellow):
            raise ValueError("blue: a goalkeeper has nobody to mind")
        if self.aim == "pass" and len(self.blue) < 2:
            raise ValueError("aim: to pass takes two")
        return self
