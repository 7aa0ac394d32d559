"""One match: observe once, tick every robot's tree once, send the commands once."""

from __future__ import annotations

import logging
from collections.abc import Callable, Container, Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from robobt.config.closing import Closing
from robobt.config.process import OwnProcess
from robobt.config.wording import counted
from robobt.match.capture import MatchCapture
from robobt.match.checkpoint import Checkpoint
from robobt.match.ends import EndJudge, Outcome
from robobt.match.lineup import Lineup, leave
from robobt.match.players import Driver, Player, make_players, run_tree, shut_down
from robobt.match.recording.capture import Capture
from robobt.match.referee.events import RefereeEvent
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.results.delays import delay_results
from robobt.match.results.measures import Measures, Trace
from robobt.match.results.results import MatchResult
from robobt.match.results.teams import TeamStatistics
from robobt.match.scenario.scenario import Scenario
from robobt.match.views import KeptView
from robobt.signals import check, let_go
from robobt.skills.aim.raters.shot_predictor import load_shot_predictors
from robobt.skills.ball.learned_control import load_shipped_policies
from robobt.tree import Behaviour
from robobt.world.answer import compensated
from robobt.world.command import RobotCommand
from robobt.world.compiled import timing_compilation
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.presence import without_absent
from robobt.world.protocol import ReportedEvent, World
from robobt.world.records import shared_view
from robobt.world.rules import own_side
from robobt.world.state import Frame, RobotId

_log = logging.getLogger(__name__)

_MAY_READ = "a skill may only read the frame, and acts through self.store.command"

WorldFactory = Callable[[Scenario], World]
"""Makes the world of a match. Raises ``ScenarioError`` if the scenario does not fit the world."""


class MatchLoop(Closing):
    """A match in a world that is given, played tick by tick.

    Args:
        scenario: the scenario to play.
        seed: seed of the placement and the world; the same seed gives the same match, bit for bit.
        world_factory: makes the world.
        record: file to record the match to; its name ends in ``.robobt.arrows``.
        trial: number of the trial, which is only recorded.
        referee: makes the referee; by default the scenario's own. It is closed with the match.
        layers: drawing layers of skills to record.

    Attributes:
        world: the world of the match.
        players: the robots, in the scenario's order, blue first.
        measures: the figures so far.
        game: the state of the game at the last frame.
        events: what the referee has reported so far.
        referee: the referee, or None if there is none or it runs elsewhere.
        outcome: how the match ended, None while it is played.

    Raises:
        ScenarioError: the scenario does not fit the world, or its objects find no place.
        OSError: the recording cannot be written.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        world_factory: WorldFactory,
        record: str | Path | None = None,
        trial: int = 0,
        referee: RefereeFactory = own_referee,
        layers: Container[str] = (),
    ) -> None:
        self.scenario, self.seed, self.trial = scenario, seed, trial
        self.world = world_factory(scenario)
        asked = scenario.referee is not None or referee is not own_referee
        if asked and self.world.refereed:
            raise scenario.error(
                "the scenario has a referee of its own, but a game controller decides there; "
                "set 'referee: false', or play with 'robobt match --referee none'",
                "referee",
            )
        placement_seed, world_seed = np.random.SeedSequence(seed).spawn(2)
        placement = scenario.place(np.random.default_rng(placement_seed))
        if self.world.paced:
            # A real field does not wait for this process.
            self.be_ready()
        self.world.reset(placement, int(world_seed.generate_state(1)[0]))
        self.players = make_players(scenario, self.world.observe())
        self.measures = Measures({player.robot: None for player in self.players})
        self.game: GameState = OPEN_PLAY
        self.events: list[ReportedEvent] = []
        self.outcome: Outcome | None = None
        keepers = scenario.goalkeepers()
        self._lineups = {
            team: Lineup([player for player in self.players if player.robot.team is team], keepers.get(team))
            for team in Team
        }
        self._kept = {team: KeptView() for team in Team}
        self._field = self.world.truth().field
        self.referee = referee(scenario, self._field)
        refereed = self.referee is not None or self.world.refereed
        self._teams = TeamStatistics() if refereed else None
        self._judge = EndJudge(scenario, refereed, self.world.scenario_ends)
        self._trace = Trace()
        self._commands: dict[RobotId, RobotCommand] = {}
        self._only_own_code = self._check_code()
        self._spoilers: set[tuple[RobotId | Team, str]] = set()
        self._ball_placed = False
        self._time = 0.0
        # A recording may continue in another file later, when the working folder may have changed.
        path = None if record is None else Path(record).absolute()
        try:
            self._captured = MatchCapture(scenario, trial, seed, self.world, self.players, path, layers)
        except BaseException:
            shut_down(self.players)
            raise

    def __repr__(self) -> str:
        standing = "playing" if self.outcome is None else self.outcome.value
        return (
            f"<Match of {self.scenario.name!r}, seed {self.seed}: {standing} at {self._time:.2f} s, "
            f"{counted(len(self.players), 'robot')}>"
        )

    def play(self) -> MatchResult:
        """Play to the end and return the result."""
        started = perf_counter()
        with self, timing_compilation() as compiling:
            while self.tick():
                pass
            return self.result(perf_counter() - started - compiling())

    def be_ready(self) -> None:
        """Load everything that is otherwise loaded at first use, which would delay a match in real time."""
        load_shot_predictors()
        load_shipped_policies()

    def capture(self) -> Capture:
        """Return the capture of every tick from now on, for recorders and viewers."""
        return self._captured.get()

    def checkpoint(self, *others: object) -> Checkpoint:
        """Return the present state of trees and line-ups, and of ``others``; the world's is not in it."""
        return Checkpoint(self.players, self._lineups, self._kept, *others)

    def change_tree(self, player: Player, tree: Behaviour, play: str) -> None:
        """Let the robot of ``player`` play another tree from now on; ``play`` is the tree's name."""
        before = player.runner
        player.runner = run_tree(player.robot, tree, player.store, before.on_error, player.names)
        self._only_own_code = self._check_code()
        before.stop()
        before.shutdown()
        self._captured.change_tree(before, player, play)

    def set_driver(self, player: Player, driver: Driver | None) -> None:
        """Let ``driver`` move the robot of ``player`` in place of its tree, or with None its tree again."""
        player.driver = driver
        self._only_own_code = self._check_code()

    def close(self) -> None:
        """Close the referee, finish the recording and shut the trees down; ``with`` does it too."""
        let_go()
        if self.referee is not None:
            self.referee.close()
        scores = self._judge.scores
        told: dict[str, object] = {"blue": scores[Team.BLUE], "yellow": scores[Team.YELLOW]}
        self._captured.close(None if self.outcome is None else {"outcome": self.outcome.value, **told})
        shut_down(self.players)

    def tick(self) -> bool:
        """Play one control period; return False if the match is over, in which case no robot has acted.

        Raises:
            TreeError: a tree raised, and the scenario's ``on_error`` is "raise"; robot and node are named.
        """
        check()
        truth = self.world.truth()
        self._time = truth.time
        events: Sequence[ReportedEvent]
        if self.referee is not None:
            events = self._follow_referee(truth)
        else:
            # A world may have a referee of its own: the league's game controller.
            self.game, events = truth.game, self.world.reported()
        self._note_events(events)
        truth.game = self.game
        self.measures.update(truth, self.game, self._commands, self.world.seen_kicks())
        if self._teams is not None:
            self._teams.update(truth, self.game, events)
        packed = truth.packed()
        self._trace.update(packed, self.game)
        self.outcome = self._judge.judge(truth, self.game, self.measures.kicks, self.measures.kicked)
        frame = truth
        if self.outcome is None:
            # The referee may have placed the ball since the true frame was taken, and a user's skill could
            # change frames that it has kept.
            if self._ball_placed or not self.world.shows_truth or not self._only_own_code:
                frame = self.world.observe()
                frame.game = self.game
            self._commands = self.decide(frame)
        else:
            self._trace.event(self.outcome)
            self._commands = {}
        ended = None if self.referee is not None else self.outcome
        self._captured.tick(truth, self._commands, frame, packed, self.measures.kicked, ended)
        if self.outcome is not None:
            return False
        self._carry(frame)
        self.world.act(compensated(self._commands, frame))
        return True

    def result(self, wall_time: float = 0.0) -> MatchResult:
        """Return the figures so far, after ``wall_time`` [s]; an unfinished match counts as out of time."""
        outcome = Outcome.TIME if self.outcome is None else self.outcome
        measures = self.measures
        return MatchResult(
            scenario=self.scenario.name,
            trial=self.trial,
            seed=self.seed,
            outcome=outcome.value,
            time=self._time,
            blue_score=self._judge.scores[Team.BLUE],
            yellow_score=self._judge.scores[Team.YELLOW],
            in_play=measures.in_play / max(1, measures.ticks),
            ticks=measures.ticks,
            robots={
                str(it.robot): replace(measures.robots[it.robot], always_failed=it.failing or None)
                for it in self.players
            },
            trace=self._trace.hexdigest(),
            wall_time=wall_time,
            teams={} if self._teams is None else self._teams.result(),
            delays=delay_results(self.world.delays()),
        )

    def decide(self, frame: Frame) -> dict[RobotId, RobotCommand]:
        """Tick every tree once on this frame and return each robot's command, without changing the world.

        A robot that is not seen is not ticked and stands still. What a tree with users' code may have changed
        is looked at, and restored, when it has been ticked; robobt's own code changes nothing.
        """
        commands: dict[RobotId, RobotCommand] = {}
        process = None if self._only_own_code else OwnProcess()
        halted = frame.game.halted
        # Make both views before any tree is ticked, because they may share the frame's objects.
        views = [(team, shared_view(frame, team)) for team, lineup in self._lineups.items() if lineup.players]
        for team, everybody in views:
            lineup, kept = self._lineups[team], self._kept[team]
            # Trees do not see a robot that has left the field, but it is still driven.
            view = without_absent(everybody, everybody.game)
            if process is not None:
                kept.take(view)
            leaving = lineup.follow(everybody)
            if process is not None:
                # It may have interrupted skills, which can change objects that this view shares.
                kept.mend()
            for me in everybody.own if leaving else ():
                if me.id in leaving:
                    commands[lineup.players[me.id].robot] = leave(everybody, me, leaving)
            for me in view.own:
                player = lineup.players.get(me.id)
                if player is None or me.id in leaving:
                    continue
                if process is None or (player.runner.own and player.driver is None):
                    command = player.decide(view, me)
                else:
                    try:
                        command = player.decide(view, me)
                    finally:
                        strayed = process.hold()
                    self._mend(kept, player.robot)
                    if strayed:
                        self._complain(player.robot, "the working folder", "", "name files by whole paths")
                if command is None:
                    self._note_failure(player)
                    command = RobotCommand()
                commands[player.robot] = command
            if process is not None:
                self._mend(kept, team)
        if halted:
            # Robots stop whatever their trees say, because not every play checks the referee.
            return {robot: RobotCommand() for robot in commands}
        return commands

    def _check_code(self) -> bool:
        """Return whether only robobt's own code runs in all trees, which move all robots."""
        return all(player.runner.own and player.driver is None for player in self.players)

    def _mend(self, kept: KeptView, who: RobotId | Team) -> None:
        """Restore a team's view, and warn of changes by a robot, or by one of a team's."""
        if (changed := kept.mend()) is not None:
            named = f" ({changed[0]})" if changed else ""
            self._complain(who, "the frame", named, _MAY_READ)

    def _complain(self, who: RobotId | Team, changed: str, field: str, advice: str) -> None:
        """Warn once per robot, or team, that a skill changed something read-only."""
        if (who, changed) not in self._spoilers:
            self._spoilers.add((who, changed))
            said = f"a skill of its tree changed {changed}{field}, which was restored; {advice}"
            _log.warning("%s: %s", who, said)

    def _carry(self, frame: Frame) -> None:
        """Move robots that have left the field or come back, as their handlers would."""
        for team, lineup in self._lineups.items():
            if lineup.complete:
                continue
            side = -own_side(team)
            for number, (x, y) in lineup.carried(frame.seen_by(team)):
                self.world.carry_robot(RobotId(team, number), side * x, side * y)

    def _note_failure(self, player: Player) -> None:
        figures = self.measures.robots[player.robot]
        figures.errors += 1
        if figures.first_error is None:
            figures.first_error = player.problem
        self._trace.event(f"error {player.robot}")

    def _follow_referee(self, truth: Frame) -> tuple[RefereeEvent, ...]:
        assert self.referee is not None
        decision = self.referee.update(truth)
        self.game = decision.game
        self._ball_placed = decision.place_ball is not None
        if decision.place_ball is not None:
            self.world.place_ball(*decision.place_ball)
        return decision.events

    def _note_events(self, events: Sequence[ReportedEvent]) -> None:
        self.events += events
        for event in events:
            self._trace.event(f"{event.kind} {event.robot}")
            self._captured.note(event)
