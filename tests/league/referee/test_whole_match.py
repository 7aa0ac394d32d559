"""A whole match under the official controller, decided anew by ours on the same frames and events."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from robobt.league.referee.official import OfficialReferee, OfficialRefereeFactory
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Decision, EventKind
from robobt.match.referee.restarts import PLACEMENT_COMMANDS, Resumption
from robobt.match.scenario.scenario import Scenario
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import distance
from robobt.world.state import Frame
from robobt.worlds import sim_world

OFFICIAL = os.environ.get("ROBOBT_GAME_CONTROLLER", "")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not OFFICIAL, reason="ROBOBT_GAME_CONTROLLER does not name the official program"),
]

K = EventKind
DECIDED = {K.GOAL, K.INVALID_GOAL, K.PLACEMENT_FAILED, K.MULTIPLE_FOULS, K.MULTIPLE_CARDS}
"""Events that controllers raise themselves."""

LATE = 0.5
"""The official controller looks at the match every 0.1 to 0.4 s [s]."""

CARD_SLACK = 5.0
"""A card that was over too soon is given so much more time [s]."""

STOPS = {
    K.BALL_LEFT_FIELD_GOAL_LINE,
    K.BALL_LEFT_FIELD_TOUCH_LINE,
    K.AIMLESS_KICK,
    K.POSSIBLE_GOAL,
    K.BOT_DRIBBLED_BALL_TOO_FAR,
    K.ATTACKER_DOUBLE_TOUCHED_BALL,
    K.DEFENDER_IN_DEFENSE_AREA,
    K.KEEPER_HELD_BALL,
    K.NO_PROGRESS_IN_GAME,
    K.TOO_MANY_ROBOTS,
}

Seen = tuple[object, ...]


def seen(game: GameState) -> Seen:
    """What is decided, but for the place of the ball, which is compared by its distance."""
    return (
        game.command,
        game.restart,
        game.restart_team,
        game.may_touch,
        game.blue_score,
        game.yellow_score,
        game.blue.max_robots,
        game.yellow.max_robots,
        game.blue.keeper,
        game.yellow.keeper,
    )


def alike(ours: GameState, theirs: GameState) -> bool:
    told = theirs.command is RefereeCommand.STOP or theirs.restart is Restart.BALL_PLACEMENT
    if told and ours.placement is not None and theirs.placement is not None:
        return seen(ours) == seen(theirs) and distance(ours.placement, theirs.placement) < 0.05
    return seen(ours) == seen(theirs)


@dataclass
class Comparison:
    """Both controllers side by side; where ours differs for longer than ``LATE`` it is brought in line.

    ``decisions`` are the official one's, ``lags`` how much earlier ours took the same ones [s].
    """

    decisions: int = 0
    explained: Counter[str] = field(default_factory=Counter)
    unexplained: list[str] = field(default_factory=list)
    events: Counter[str] = field(default_factory=Counter)
    lags: list[float] = field(default_factory=list)


class Beside:
    """The official referee of a match, with our controller beside it."""

    def __init__(self, official: OfficialReferee, scenario: Scenario, grid: FieldGeometry) -> None:
        self.official, self.told = official, Comparison()
        settings = official._setup.settings
        self.own = Controller(grid, settings, np.random.default_rng(1))
        self._last: GameState | None = None
        self._differs: float | None = None
        self._lately: list[tuple[float, EventKind]] = []

    def update(self, frame: Frame) -> Decision:
        """Let both decide."""
        decision = self.official.update(frame)
        told = self.told
        given = [event for event in decision.events if event.kind not in DECIDED]
        ours = self.own.update(frame, given)
        for who, events in (("ours", ours.events), ("theirs", decision.events)):
            told.events.update(f"{event.kind} {who}" for event in events if event.kind in DECIDED)
        told.events.update(str(event.kind) for event in given)
        self._lately = [one for one in self._lately if frame.time - one[0] < 3.0]
        self._lately += [(frame.time, event.kind) for event in (*decision.events, *ours.events)]
        theirs = decision.game
        if theirs.stage_time is not None and self.own.state.stages.length is not None:
            # Both clocks show the same, whatever was decided before.
            self.own.state.stages.played = self.own.state.stages.length - theirs.stage_time
        if self._last is None or seen(theirs) != seen(self._last):
            told.decisions += 1
        self._last = theirs
        if alike(ours.game, theirs):
            if self._differs is not None:
                told.lags.append(frame.time - self._differs)
            self._differs = None
        elif self._differs is None:
            self._differs = frame.time
        elif frame.time - self._differs > LATE:
            reason = self._reason(ours.game, theirs, frame.time)
            if reason:
                told.explained[reason] += 1
            else:
                kinds = ", ".join(kind for _, kind in self._lately)
                told.unexplained.append(f"{frame.time:.1f} s: {seen(ours.game)}, not {seen(theirs)}: {kinds}")
            self._follow(frame, theirs)
            self._differs = None
        return decision

    def close(self) -> None:
        self.official.close()

    def _reason(self, ours: GameState, theirs: GameState, time: float) -> str | None:
        lately = [kind for _, kind in self._lately]
        if theirs.stage != ours.stage or theirs.stage.name.endswith("_PRE"):
            return "people bring stages on and begin a half after 10 s of STOP; ours does so at once"
        if theirs.command is RefereeCommand.HALT or (
            theirs.upcoming is not None and theirs.upcoming.name.startswith("PREPARE_KICKOFF")
        ):
            return "a goal leads to a HALT and 10 s of STOP there, to a STOP here"
        if seen(replace(ours, blue=theirs.blue, yellow=theirs.yellow)) == seen(theirs):
            return "play is stopped for some 0.1 s less a restart here, so that cards are over sooner"
        places = set(PLACEMENT_COMMANDS.values())
        if (
            ours.command in places
            and theirs.command in places
            and theirs.upcoming is RefereeCommand.FORCE_START
        ):
            return "who places the ball for a forced start is drawn by lot"
        if sum(kind in STOPS for kind in lately) > 1:
            return "of two offences in one second the later one counts there, the earlier one here"
        if K.PLACEMENT_FAILED in lately or (ours.command is RefereeCommand.STOP and theirs.command in places):
            return "a placement lasts 31 s there, the rules' 30 s here"
        return None

    def _follow(self, frame: Frame, game: GameState) -> None:
        """Bring our controller in line with what the official one has decided."""
        state = self.own.state
        restart, team = game.restart, game.restart_team
        if game.upcoming is not None and restart is Restart.BALL_PLACEMENT:
            name = game.upcoming.name
            direct = name.startswith("DIRECT_FREE")
            restart = Restart.FREE_KICK if direct else None
            team = Team.BLUE if name.endswith("BLUE") else Team.YELLOW if direct else None
        spot = game.placement or state.following.spot
        state.following = Resumption(spot, restart, team)
        state.stages.stage = game.stage
        state.placing.begin(state.following)
        for side, score in ((Team.BLUE, game.blue_score), (Team.YELLOW, game.yellow_score)):
            record, most = state.records[side], game.status(side).max_robots
            record.score = score
            while most is not None and record.max_robots > most:
                record.yellow.append(CARD_SLACK)
            while most is not None and record.yellow and record.max_robots < most:
                record.yellow.remove(min(record.yellow))
        if game.command in PLACEMENT_COMMANDS.values() and game.restart_team is not None:
            state.placing.order(game.restart_team, frame.time)
            state.give(game.command, state.placing.deadline)
        elif game.halted:
            state.halt(None)
        else:
            state.give(game.command, None if game.action_time is None else frame.time + game.action_time)
        state.kick_spot = frame.ball.position
        state.game = game


def compare(seconds: float | None, seed: int, name: str = "six_v_six") -> Comparison:
    """Play under the official controller at the rules' times; all of it where ``seconds`` is None."""
    from robobt.cli.option_groups.refereeing import MatchExtent, Refereeing, Who

    scenario, _ = Refereeing(Who.OFFICIAL, Path(OFFICIAL), MatchExtent.FULL).of(load_scenario(name))
    if seconds is not None:
        scenario = scenario.lasting(seconds)
    made: list[Beside] = []

    def make(scenario: Scenario, grid: FieldGeometry) -> Beside:
        made.append(Beside(OfficialRefereeFactory(Path(OFFICIAL))(scenario, grid), scenario, grid))
        return made[-1]

    with MatchLoop(scenario, seed, sim_world, referee=make) as match:
        match.play()
    return made[0].told


def test_both_decide_alike_in_a_match() -> None:
    told = compare(240.0, 5)
    assert told.decisions > 20
    assert len(told.unexplained) <= 0.02 * told.decisions, told.unexplained
