"""The state of the game: command, stage, score. Held by every frame."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import IntEnum, StrEnum


class Team(StrEnum):
    """Team colour. In world coordinates blue defends -x; every tree sees its own team so."""

    BLUE = "blue"
    YELLOW = "yellow"

    # An enum's own is written in Python, and a team is part of every robot's id.
    __hash__ = str.__hash__

    @property
    def other(self) -> Team:
        """The opponent's colour."""
        return _YELLOW if self is _BLUE else _BLUE


# CPython 3.11 takes forty times as long to find a member in its enumeration as a name of this module.
_BLUE, _YELLOW = Team.BLUE, Team.YELLOW


class RefereeCommand(IntEnum):
    """Commands with the numbers of the league's referee protocol."""

    HALT = 0
    STOP = 1
    NORMAL_START = 2
    FORCE_START = 3
    PREPARE_KICKOFF_YELLOW = 4
    PREPARE_KICKOFF_BLUE = 5
    PREPARE_PENALTY_YELLOW = 6
    PREPARE_PENALTY_BLUE = 7
    DIRECT_FREE_YELLOW = 8
    DIRECT_FREE_BLUE = 9
    TIMEOUT_YELLOW = 12
    TIMEOUT_BLUE = 13
    BALL_PLACEMENT_YELLOW = 16
    BALL_PLACEMENT_BLUE = 17


class Stage(IntEnum):
    """Stages with the numbers of the league's referee protocol."""

    NORMAL_FIRST_HALF_PRE = 0
    NORMAL_FIRST_HALF = 1
    NORMAL_HALF_TIME = 2
    NORMAL_SECOND_HALF_PRE = 3
    NORMAL_SECOND_HALF = 4
    EXTRA_TIME_BREAK = 5
    EXTRA_FIRST_HALF_PRE = 6
    EXTRA_FIRST_HALF = 7
    EXTRA_HALF_TIME = 8
    EXTRA_SECOND_HALF_PRE = 9
    EXTRA_SECOND_HALF = 10
    PENALTY_SHOOTOUT_BREAK = 11
    PENALTY_SHOOTOUT = 12
    POST_GAME = 13


class Restart(StrEnum):
    """How play is about to resume."""

    KICKOFF = "kickoff"
    FREE_KICK = "free_kick"
    PENALTY = "penalty"
    BALL_PLACEMENT = "ball_placement"


BALL_PLACEMENT, KICKOFF = Restart.BALL_PLACEMENT, Restart.KICKOFF


@dataclass(slots=True, frozen=True)
class TeamStatus:
    """A team's data from the game controller.

    Attributes:
        keeper: number of the goalkeeper; None if it is undecided.
        max_robots: robots it may have on the field, cards taken off; None for any number.
        yellow_cards: number of active yellow cards.
        red_cards: number of red cards.
        can_place_ball: whether it may be asked to place the ball.
        substituting: whether its robots may be exchanged by hand now.
    """

    keeper: int | None = None
    max_robots: int | None = None
    yellow_cards: int = 0
    red_cards: int = 0
    can_place_ball: bool = True
    substituting: bool = False


@dataclass(slots=True, frozen=True)
class GameState:
    """The state of the game as of one frame, as the referee decided it.

    Attributes:
        command: the last command.
        stage: the match's stage.
        blue_score, yellow_score: goals.
        restart: the pending restart, or None once the ball is in play.
        restart_team: the team of the restart.
        may_touch: whether ``restart_team`` may take the restart now.
        placement: where the ball has to be placed, or is, for the restart, in the coordinates of the frame
            that holds this state [m].
        penalty: the team of a penalty kick, from its preparation to its end; ``restart`` is None once the
        ball has moved, but all robots except kicker and goalkeeper have to stay behind the ball. blue,
        yellow: the teams, as a game controller reports them.
        events: game events since play was stopped, by the league's names in lower case, oldest first.
        upcoming: the command that will follow this stop or placement, None if unknown.
        action_time: time left for the present action, None without a limit [s]. Two states that
            differ only in their times are equal.
        stage_time: time left in this stage, negative in overtime; None without a game controller [s].
    """

    command: RefereeCommand = RefereeCommand.FORCE_START
    stage: Stage = Stage.NORMAL_FIRST_HALF
    blue_score: int = 0
    yellow_score: int = 0
    restart: Restart | None = None
    restart_team: Team | None = None
    may_touch: bool = True
    placement: tuple[float, float] | None = None
    penalty: Team | None = None
    blue: TeamStatus = TeamStatus()
    yellow: TeamStatus = TeamStatus()
    events: tuple[str, ...] = ()
    upcoming: RefereeCommand | None = None
    action_time: float | None = field(default=None, compare=False)
    stage_time: float | None = field(default=None, compare=False)

    def status(self, team: Team) -> TeamStatus:
        """Return what the game controller says of a team."""
        return self.blue if team is _BLUE else self.yellow

    @property
    def halted(self) -> bool:
        """Whether every robot has to stand still."""
        return self.command in _HALTED

    @property
    def stopped(self) -> bool:
        """Whether robots have to be slow (1.5 m/s) and keep 0.5 m from the ball."""
        return self.command is _STOP

    @property
    def in_play(self) -> bool:
        """Whether the ball is free for both teams."""
        return self.restart is None and self.command in STARTED

    def ball_for(self, team: Team) -> int:
        """Return 1 if only ``team`` may play the ball, 0 if both teams may, else -1."""
        if self.in_play:
            return 0
        return 1 if self.command in STARTED and self.may_touch and self.restart_team is team else -1

    @property
    def next_team(self) -> Team | None:
        """The team of the restart after this stop or placement; None for both teams, or if unknown."""
        return None if self.upcoming is None else _COMMAND_TEAMS.get(self.upcoming)

    def mirrored(self) -> GameState:
        """Return the same state in coordinates turned by 180 degrees."""
        if self.placement is None:
            return self
        return replace(self, placement=(-self.placement[0], -self.placement[1]))


_STOP = RefereeCommand.STOP
# Tuples: hashing an enum's member is a Python call, and every robot asks.
_HALTED = (RefereeCommand.HALT, RefereeCommand.TIMEOUT_BLUE, RefereeCommand.TIMEOUT_YELLOW)
STARTED = (
    RefereeCommand.NORMAL_START,
    RefereeCommand.FORCE_START,
    RefereeCommand.DIRECT_FREE_BLUE,
    RefereeCommand.DIRECT_FREE_YELLOW,
)
"""Commands under which a team may play the ball, and time is counted."""
_COMMAND_TEAMS = {
    command: Team.BLUE if command.name.endswith("_BLUE") else Team.YELLOW
    for command in RefereeCommand
    if command.name.endswith(("_BLUE", "_YELLOW"))
}
OPEN_PLAY = GameState()
"""Free play without a referee, for scenarios without one."""
