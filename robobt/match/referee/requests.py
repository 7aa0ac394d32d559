"""Requests of teams to the controller: time-outs, substitutions, advantage, another goalkeeper.

Source: RoboCup SSL rules, chapters "Time-outs", "Substitution" and "Goalkeeper"; the league's game controller
for when a request takes effect.
"""

from __future__ import annotations

from robobt.match.referee.events import EventKind
from robobt.match.referee.restarts import corner_kick
from robobt.match.referee.state import MatchState
from robobt.world.game import RefereeCommand, Team
from robobt.world.rules import own_side

SUBSTITUTION_TIME = 20.0
"""Duration of a HALT for substitutions [s]. Source: SSL rules."""


class Requests:
    """The teams' requests; each takes effect when the rules allow it.

    ``state`` is the state of the match.
    """

    def __init__(self, state: MatchState) -> None:
        self._state = state

    def time_out(self, team: Team) -> bool:
        """Request a time-out, which begins at the next STOP; return False if the team has none left."""
        record = self._state.records[team]
        if self._state.stages.shoot_out or record.time_outs < 1 or record.time_out_left <= 0.0:
            return False
        record.wants_time_out = True
        return True

    def end_time_out(self, team: Team) -> bool:
        """End the team's time-out or withdraw its request; return False if there is neither."""
        state, record = self._state, self._state.records[team]
        if record.wants_time_out:
            record.wants_time_out = False
            return True
        running = {Team.BLUE: RefereeCommand.TIMEOUT_BLUE, Team.YELLOW: RefereeCommand.TIMEOUT_YELLOW}
        if state.game.command is not running[team]:
            return False
        state.deadline = state.time
        return True

    def substitution(self, team: Team) -> None:
        """Request a substitution at the next STOP."""
        self._state.records[team].wants_substitution = True

    def advantage(self, team: Team, play_on: bool) -> None:
        """Set whether play continues while the opponents have too many robots."""
        self._state.records[team].continues = play_on

    def keeper(self, team: Team, number: int) -> bool:
        """Name another goalkeeper; return False if the ball is in play and in the team's own half."""
        state = self._state
        if state.running and own_side(team) * state.ball[0] > 0.0:
            return False
        state.records[team].keeper = number
        return True

    def serve(self) -> bool:
        """Carry out the requests, in a STOP; return whether that changed the command."""
        state = self._state
        wanting = [team for team in Team if state.records[team].wants_substitution]
        if wanting:
            for team in wanting:
                record = state.records[team]
                record.wants_substitution, record.substituting = False, True
                state.note(EventKind.BOT_SUBSTITUTION, team)
                record.substitutions -= 1
            exceeding = [team for team in wanting if state.records[team].substitutions < 0]
            for team in exceeding:
                state.note(EventKind.EXCESSIVE_BOT_SUBSTITUTION, team)
            if len(exceeding) == 1:
                state.following = corner_kick(state.field, exceeding[0].other, state.ball[1])
                state.placing.begin(state.following)
            state.halt(SUBSTITUTION_TIME)
            return True
        for team in Team:
            if state.records[team].wants_time_out:
                state.time_out(team)
                return True
        return False
