"""The state of a match under the controller, and its transitions.

Source: RoboCup SSL rules of 2026, and the league's game controller for what they leave open; command and
stage numbers are those of its messages.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from robobt.match.referee.discipline import Discipline
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.placing import Placing
from robobt.match.referee.restarts import PLACEMENT_COMMANDS, TIME_OUT, Resumption, kickoff, penalty
from robobt.match.referee.settings import RefereeSettings, in_seconds
from robobt.match.referee.stages import Stages
from robobt.world.division import division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import STARTED, GameState, RefereeCommand, Restart, Stage, Team, TeamStatus
from robobt.world.geometry import Point

PREPARATION_TIME = 10.0
"""Time to prepare a kick-off or penalty kick, and again to take it [s]. Source: SSL rules."""

_TIME_OUTS = {command: team for team, command in TIME_OUT.items()}

_TOLD_EVERY = 0.1
"""Interval at which the remaining times are updated if nothing else changes [s]."""


class MatchState:
    """The controller's state and transitions, in world coordinates and frame time.

    Attributes:
        game: the state of the game as sent to the teams.
        records: fouls, cards and budgets of each team.
        discipline: counts the fouls.
        stages: the stage of the match.
        placing: the ball placement.
        following: the restart after this stop.
        events: the events of this frame.
        ball: position of the ball [m].
        time: the present time [s].
        since: time of the present command [s].
        least: least duration of the present STOP [s].
        deadline: end of the present action [s], None without a limit.
        clear: time since which play could continue [s], None while something prevents it.
        kick_spot: the ball's position when the kick was allowed [m].
    """

    def __init__(
        self, field: FieldGeometry, settings: RefereeSettings, generator: np.random.Generator
    ) -> None:
        self.field, self.settings, self.division = field, settings, division_of(field)
        self.game = GameState(
            RefereeCommand.HALT, stage=Stage.NORMAL_FIRST_HALF_PRE, may_touch=False, placement=None
        )
        self.discipline = Discipline(settings, self.division)
        self.records = self.discipline.records
        self.stages = Stages(settings)
        self.placing = Placing(settings, self.division, self.records, generator)
        self.following = Resumption((0.0, 0.0))
        self.events: list[RefereeEvent] = []
        self.ball: Point = (0.0, 0.0)
        self.time = self.since = self.least = 0.0
        self.deadline: float | None = None
        self.clear: float | None = None
        self.kick_spot: Point = (0.0, 0.0)
        self._names: tuple[str, ...] = ()
        self._told: GameState | None = None
        self._said: tuple[TeamStatus, TeamStatus, tuple[str, ...]] | None = None
        self._told_at = 0.0

    @property
    def elapsed(self) -> float:
        """How long the present command has lasted [s]."""
        return self.time - self.since

    @property
    def running(self) -> bool:
        """Whether a team may play the ball."""
        return self.game.command in STARTED

    def pass_time(self, seconds: float) -> None:
        """Advance the match's clock [s]."""
        self.time += seconds
        command = self.game.command
        if command in STARTED:
            self.stages.played += seconds
            for record in self.records.values():
                record.play_on(seconds)
        elif command in _TIME_OUTS:
            self.records[_TIME_OUTS[command]].time_out_left -= seconds

    def record(self, event: RefereeEvent, *, counts: bool = True) -> None:
        """Note an event; a foul that ``counts`` may cost a card."""
        self.events.append(event)
        self._names += (event.kind.value,)
        if counts:
            for card in self.discipline.count(event):
                self.record(card)

    def note(self, kind: EventKind, team: Team | None, reason: str | None = None) -> RefereeEvent:
        """Record an event of the controller itself, at the ball's position; return it."""
        details = {} if reason is None else {"reason": reason}
        event = RefereeEvent(self.time, kind, team, None, *self.ball, details)
        self.record(event)
        return event

    # Commands.

    def give(self, command: RefereeCommand, deadline: float | None = None) -> None:
        """Give a command whose action ends at ``deadline`` [s]."""
        self.since, self.clear, self.deadline, self.least = self.time, None, deadline, 0.0
        self.game = replace(self.game, command=command)

    def stop(self, following: Resumption) -> None:
        """Give a STOP, after which ``following`` is taken."""
        self.following = following
        self.placing.begin(following)
        for record in self.records.values():
            record.too_close = 0
        self.wait()

    def wait(self, least: float = 0.0) -> None:
        """Give a STOP of at least ``least`` [s] for the next restart."""
        following = self.following
        self.give(RefereeCommand.STOP)
        self.least = least
        self.game = replace(
            self.game,
            restart=following.restart,
            restart_team=following.team,
            may_touch=False,
            placement=following.spot,
            upcoming=following.command,
            penalty=None,
        )

    def halt(self, seconds: float | None) -> None:
        """Give a HALT of this duration [s]; None for no end."""
        self.give(RefereeCommand.HALT, None if seconds is None else self.time + seconds)
        self.game = replace(self.game, restart=None, restart_team=None, may_touch=False, placement=None)

    def time_out(self, team: Team) -> None:
        """Begin a team's time-out."""
        record = self.records[team]
        record.wants_time_out = False
        record.time_outs -= 1
        self.give(TIME_OUT[team], self.time + record.time_out_left)
        self.game = replace(self.game, restart=None, restart_team=None, may_touch=False, placement=None)

    def end_halt(self) -> None:
        """Give a STOP after a HALT or time-out, and start the next stage after a break."""
        for record in self.records.values():
            record.substituting = False
        if self.stages.in_break:
            self.stages.end_break()
            for record in self.records.values():
                record.begin_half()
                if self.stages.stage is Stage.EXTRA_FIRST_HALF_PRE:
                    record.begin_extra_time()
            self.following = self.after_break()
            self.placing.begin(self.following)
        self.wait(self.settings.stop_after_halt)

    def after_break(self) -> Resumption:
        """Return how a stage begins."""
        if self.stages.shoot_out:
            return penalty(self.field, self.stages.turn)
        return kickoff(self.stages.kickoff_team)

    def place_by(self, team: Team) -> None:
        """Let a team place the ball."""
        self.give(PLACEMENT_COMMANDS[team], self.placing.deadline)
        self.game = replace(self.game, restart=Restart.BALL_PLACEMENT, restart_team=team, may_touch=True)

    def resume(self) -> None:
        """Continue after a STOP."""
        following = self.following
        if following.command is RefereeCommand.FORCE_START:
            self.play()
        elif following.restart is Restart.FREE_KICK:
            self.allow(following.command)
        else:
            self.give(following.command, self.time + PREPARATION_TIME)
            kicking = following.team if following.restart is Restart.PENALTY else None
            self.game = replace(self.game, upcoming=RefereeCommand.NORMAL_START, penalty=kicking)

    def allow(self, command: RefereeCommand) -> None:
        """Let the restart be taken."""
        self._begin_play()
        self.kick_spot = self.ball
        if self.stages.shoot_out:
            self.stages.begin_attempt()
        self.give(command, self.time + self.kick_time)
        self.game = replace(self.game, may_touch=True, upcoming=None)

    def play(self) -> None:
        """Free the ball for both teams."""
        self._begin_play()
        self.give(RefereeCommand.FORCE_START)
        self.free_ball()

    def free_ball(self) -> None:
        """Note that the restart has been taken or its time is over; a penalty kick continues."""
        if self.game.penalty is None:
            self.deadline = None
        self.game = replace(
            self.game, restart=None, restart_team=None, may_touch=True, placement=None, upcoming=None
        )

    @property
    def kick_time(self) -> float:
        """Time to take the next restart [s]."""
        if self.following.restart is Restart.PENALTY:
            return PREPARATION_TIME
        if self.settings.kick_timeout == "rules" and self.following.restart is Restart.KICKOFF:
            return PREPARATION_TIME
        return in_seconds(self.settings.kick_timeout, self.division)

    def _begin_play(self) -> None:
        self.stages.begin_play()
        self._names = ()

    # The state sent to the teams.

    def tell(self) -> None:
        """Update the game state."""
        blue, yellow = self.records[Team.BLUE], self.records[Team.YELLOW]
        game, said = self.game, (blue.status(), yellow.status(), self._names)
        if game is self._told and said == self._said and self.time - self._told_at < _TOLD_EVERY:
            return
        self._said, self._told_at = said, self.time
        self.game = GameState(
            game.command,
            self.stages.stage,
            blue.score,
            yellow.score,
            game.restart,
            game.restart_team,
            game.may_touch,
            game.placement,
            penalty=game.penalty,
            blue=said[0],
            yellow=said[1],
            events=said[2],
            upcoming=game.upcoming,
            action_time=None if self.deadline is None else self.deadline - self.time,
            stage_time=self.stages.left,
        )
        self._told = self.game
