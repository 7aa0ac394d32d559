"""The controller: it decides the consequences of events on the field."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from robobt.match.referee.events import Decision, EventKind, RefereeEvent
from robobt.match.referee.openings import opening_of
from robobt.match.referee.positions import ball_placed, needs_placement, ready, spot_free, stop_clear
from robobt.match.referee.requests import Requests
from robobt.match.referee.restarts import PLACEMENT_COMMANDS, PREPARE, goal_kick, kickoff, penalty
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.state import MatchState
from robobt.match.referee.verdicts import HIGHEST_GOAL, PENALTY_BREACHES, After, resumption_after
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import Point, distance
from robobt.world.presence import without_absent
from robobt.world.state import Frame

_SPOT_PATIENCE = 3.0
"""The ball is placed by hand after this time even if a robot stands on the spot [s]."""

HALT_TIME = 2.0
"""Duration of a HALT, in which robots have to brake [s]. Source: SSL rules."""

_CLOCK_ROUNDING = 1e-9
"""Tolerance for times, which are sums of control periods [s]."""

_PLACING, _PREPARING = frozenset(PLACEMENT_COMMANDS.values()), frozenset(PREPARE.values())


class Controller:
    """Decides the state of the game; the same frames and events give the same decisions.

    Blue always defends -x. What people decide is left out: challenges, forced time-outs, robots taken off.

    Args:
        field: the field, which tells the division.
        settings: times and limits, by default as in the rules.
        generator: draws the team that places the ball for a forced start, and the spot of a random opening.

    Attributes:
        state: the state of the match.
        requests: the teams' requests.
        after: returns the restart after an event, None if play goes on; by default as in the rules.
    """

    def __init__(
        self, field: FieldGeometry, settings: RefereeSettings, generator: np.random.Generator
    ) -> None:
        self.state = MatchState(field, settings, generator)
        self.requests = Requests(self.state)
        self._settings, self._field, self._generator = settings, field, generator
        self.after: After = partial(resumption_after, field)
        self._place: Point | None = None
        self._begun = False

    @property
    def game(self) -> GameState:
        """The state of the game."""
        return self.state.game

    def update(self, frame: Frame, events: Sequence[RefereeEvent]) -> Decision:
        """Decide on the next frame, seen from blue's side, with its ``events``."""
        state, self._place = self.state, None
        frame = without_absent(frame, state.game)
        state.ball = frame.ball.position
        if self._begun:
            state.pass_time(frame.time - state.time)
            for event in events:
                self._take(event)
            if state.since < state.time:
                self._judge(frame)
        else:
            self._begun = True
            state.time = frame.time
            self._open(frame)
        state.tell()
        told, state.events = tuple(state.events), []
        return Decision(state.game, told, self._place)

    # Handling of events.

    def _take(self, event: RefereeEvent) -> None:
        state, kind, team = self.state, event.kind, event.team
        if kind is EventKind.TOO_MANY_ROBOTS and team is not None and state.records[team.other].continues:
            return
        if kind is EventKind.BOT_INTERFERED_PLACEMENT and team is not None:
            state.record(event, counts=state.placing.interfere(team))
            if state.game.command in _PLACING:
                state.deadline = state.placing.deadline
            return
        state.record(event)
        if kind is EventKind.PLACEMENT_SUCCEEDED:
            if state.game.command in _PLACING and state.placing.team is team:
                state.placing.succeed(state.following)
                state.wait()
        elif kind is EventKind.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA and team is not None:
            self._too_close(team, event)
        elif not state.running or self._take_in_penalty(event):
            return
        elif kind is EventKind.POSSIBLE_GOAL and team is not None:
            if self._goal_counts(event):
                self._goal(team, event)
            else:
                state.record(replace(event, kind=EventKind.INVALID_GOAL))
                state.stop(goal_kick(self._field, team.other, event.y))
        elif kind is EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT and state.game.restart is not None:
            state.deadline = state.time + state.kick_time
        else:
            self._stop_after(event)

    def _stop_after(self, event: RefereeEvent) -> None:
        resumption = self.after(event, self.state.ball)
        if resumption is not None:
            self.state.stop(resumption)

    def _take_in_penalty(self, event: RefereeEvent) -> bool:
        """Handle an event that ends a penalty kick; return False for any other event."""
        state, kind, team = self.state, event.kind, event.team
        kicking = state.game.penalty
        if kicking is None:
            return False
        if kind is EventKind.POSSIBLE_GOAL and team is kicking and self._goal_counts(event):
            self._goal(kicking, event)
        elif kind is EventKind.POSSIBLE_GOAL:
            state.record(replace(event, kind=EventKind.INVALID_GOAL))
            self._fail_penalty(kicking)
        elif kind is EventKind.PENALTY_KICK_FAILED:
            self._fail_penalty(kicking)
        elif kind in PENALTY_BREACHES and team is kicking:
            state.note(EventKind.PENALTY_KICK_FAILED, kicking, kind.value)
            self._fail_penalty(kicking)
        elif kind in PENALTY_BREACHES and team is kicking.other:
            self._goal(kicking, event)
        else:
            return False
        return True

    def _goal_counts(self, event: RefereeEvent) -> bool:
        assert event.team is not None
        record, told = self.state.records[event.team], event.details
        robots, height = told.get("num_robots_by_team"), told.get("max_ball_height")
        return not (
            (isinstance(robots, int) and robots > record.max_robots)
            or (isinstance(height, float) and height > HIGHEST_GOAL)
            or self.state.discipline.fouled_lately(event.team, event.time)
        )

    def _goal(self, team: Team, event: RefereeEvent) -> None:
        state = self.state
        state.records[team].score += 1
        scorer = event.robot if event.team is team else None
        state.record(replace(event, kind=EventKind.GOAL, team=team, robot=scorer, details={}))
        shoot_out = state.stages.shoot_out
        state.stop(penalty(self._field, state.stages.turn) if shoot_out else kickoff(team.other))

    def _fail_penalty(self, kicking: Team) -> None:
        state = self.state
        if state.stages.shoot_out:
            state.stop(penalty(self._field, state.stages.turn))
        else:
            state.stop(goal_kick(self._field, kicking.other, state.ball[1]))

    def _too_close(self, team: Team, event: RefereeEvent) -> None:
        """Punish a robot near the opponents' defence area: first by their free kick, then by a HALT."""
        state, record = self.state, self.state.records[team]
        if state.running:
            self._stop_after(event)
            record.too_close = 1
            return
        if state.game.command is not RefereeCommand.STOP:
            return
        record.too_close += 1
        resumption = self.after(event, state.ball)
        if resumption is not None and state.following.restart not in (Restart.KICKOFF, Restart.PENALTY):
            state.following = resumption
            state.placing.begin(resumption)
        if record.too_close > 1:
            record.too_close = 0
            state.halt(HALT_TIME)
        else:
            state.wait()

    # The condition that each command waits for.

    def _judge(self, frame: Frame) -> None:
        state = self.state
        command = state.game.command
        over = state.deadline is not None and state.time >= state.deadline - _CLOCK_ROUNDING
        if state.running:
            self._judge_kick(over)
        elif command is RefereeCommand.STOP:
            self._judge_stop(frame)
        elif command in _PREPARING:
            self._judge_preparation(frame)
        elif over and command in _PLACING:
            event, state.following = state.placing.fail(frame, state.following)
            state.record(event)
            state.wait()
        elif over:
            state.end_halt()

    def _judge_kick(self, over: bool) -> None:
        state, game = self.state, self.state.game
        moved = distance(state.ball, state.kick_spot) > self._settings.in_play_distance
        if over and game.penalty is not None:
            state.note(EventKind.PENALTY_KICK_FAILED, game.penalty, "its time is over")
            self._fail_penalty(game.penalty)
        elif game.restart is not None and (moved or over):
            state.free_ball()

    def _judge_preparation(self, frame: Frame) -> None:
        state, spot = self.state, self.state.following.spot
        if distance(state.ball, spot) > self._settings.in_play_distance:
            # A robot has moved the ball, so it is put back.
            state.stop(state.following)
        elif self._impatient or self._lasted(
            ready(frame, self._field, state.game, state.following), self._settings.stop_time
        ):
            state.allow(RefereeCommand.NORMAL_START)

    def _judge_stop(self, frame: Frame) -> None:
        state, settings, following = self.state, self._settings, self.state.following
        over = state.stages.over((state.records[Team.BLUE].score, state.records[Team.YELLOW].score))
        if over is not None and (state.stages.shoot_out or following.restart is not Restart.PENALTY):
            self._end_stage(over)
            return
        if self.requests.serve():
            return
        clear = self._ball_ready(frame)
        if state.game.command is not RefereeCommand.STOP:
            return
        clear = clear and (
            self._impatient or settings.placement == "by_hand" or stop_clear(frame, state.game, following)
        )
        wait = 0.0 if state.placing.done else settings.stop_time
        if self._lasted(clear, wait) and state.elapsed >= state.least - _CLOCK_ROUNDING:
            state.resume()

    def _ball_ready(self, frame: Frame) -> bool:
        """Return whether the ball is where it has to be in a STOP; arrange its placement if not."""
        state, spot = self.state, self.state.following.spot
        if not state.placing.by_hand:
            if not needs_placement(frame, self._field, spot):
                return True
            team = state.placing.choose(state.following, state.time)
            if team is not None:
                state.place_by(team)
            return False
        delay = self._settings.placement_delay
        if state.elapsed < delay:
            return False
        if ball_placed(frame, spot):
            return True
        if spot_free(frame, spot) or state.elapsed > delay + _SPOT_PATIENCE:
            self._place = spot
        return False

    @property
    def _impatient(self) -> bool:
        longest = self._settings.kickoff_wait
        return longest is not None and self.state.elapsed >= longest - _CLOCK_ROUNDING

    def _lasted(self, clear: bool, seconds: float) -> bool:
        """Return whether play could have continued for this time [s]; ``clear`` says whether it could now."""
        state = self.state
        if not clear:
            state.clear = None
            return False
        if state.clear is None:
            state.clear = state.time
        return state.time - state.clear >= seconds - _CLOCK_ROUNDING

    def _end_stage(self, following: Stage) -> None:
        state = self.state
        state.stages.stage = following
        state.halt(None if following is Stage.POST_GAME else self._settings.half_time)

    def _open(self, frame: Frame) -> None:
        state = self.state
        opening = opening_of(self._settings, self._field, frame, self._generator)
        state.stages.stage = opening.stage
        if opening.command is RefereeCommand.FORCE_START:
            state.play()
            return
        state.stop(opening.resumption)
        if opening.command in _PLACING:
            team = opening.resumption.team
            assert team is not None
            state.place_by(state.placing.order(team, state.time))
            return
        state.placing.by_hand = True
        if opening.resumption.restart is Restart.KICKOFF and ball_placed(frame, state.following.spot):
            state.resume()
