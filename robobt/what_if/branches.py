"""Branches of a moment: the match is set up once, and played on from there for a few seconds, many times."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np

from robobt.match.checkpoint import Checkpoint
from robobt.match.loop import MatchLoop
from robobt.match.players import Player
from robobt.match.referee.events import RefereeEvent
from robobt.match.refereeing import referee_settings
from robobt.match.results.teams import TeamResult, TeamStatistics
from robobt.match.scenario.scenario import Scenario
from robobt.signals import check
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.what_if.decisions import BallDecision
from robobt.what_if.errors import BranchErrors, ErrorSizes
from robobt.what_if.follow import LogFollower, LogWatch
from robobt.what_if.logged import LoggedMatch
from robobt.what_if.pictured import BranchRecording
from robobt.what_if.resumed import ResumedReferee
from robobt.what_if.standing import standing
from robobt.what_if.start import logged_start
from robobt.world.answer import compensated
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import STARTED, Team
from robobt.world.rules import ball_out, owner
from robobt.world.state import Frame, RobotId
from robobt.worlds import sim_world

WARM_UP = 1.0
"""Part of the log before the moment that trees and referee are shown, so that they know what they did [s]."""

LEAVE = 0.3
"""Distance of the ball from its logged place from which the game has left the log [m]."""


@dataclass(slots=True, frozen=True)
class Branch:
    """What came of a branch.

    Attributes:
        goals: of each team.
        expected: expected goals of each team's shots; a goal without one, such as an own goal, counts 1.
        stands: chance of the best shot at the end, positive where blue would take it, 0 after a goal or when
            play was stopped.
        ball: the ball's place at the end [m].
        followed: how long the game stayed in the log [s].
        lasted: how long it lasted [s]; less than asked for where play was stopped.
    """

    goals: Mapping[Team, int]
    expected: Mapping[Team, float]
    stands: float
    ball: tuple[float, float]
    followed: float
    lasted: float

    def lead(self, team: Team) -> int:
        """Return the goals of ``team`` minus those of its opponents."""
        return self.goals[team] - self.goals[team.other]

    def value(self, team: Team) -> float:
        """Return the expected goals of ``team`` minus its opponents': those of shots, and how it stands."""
        stands = self.stands if team is Team.BLUE else -self.stands
        return self.expected[team] - self.expected[team.other] + stands


class Branches:
    """Plays branches of a logged match.

    Args:
        logged: the match.
        scenario: what the robots play in the branches; by default what played in the match.
        seconds: how long a branch lasts [s].
        leave: distance of the ball from its logged place from which the game has left the log [m].
        errors: sizes of the errors by which branches differ.
        warm_up: part of the log before the moment that trees and referee are shown [s].

    Attributes:
        tick: number of the tick of the present moment.
    """

    def __init__(
        self,
        logged: LoggedMatch,
        scenario: Scenario | None = None,
        *,
        seconds: float = 3.0,
        leave: float = LEAVE,
        errors: ErrorSizes | None = None,
        warm_up: float = WARM_UP,
    ) -> None:
        self.logged, self.scenario = logged, scenario or logged.scenario
        self.errors = ErrorSizes() if errors is None else errors
        self.tick = 0
        recording = logged.recording
        period = self.scenario.period
        self._length, self._warm_up = max(1, round(seconds / period)), round(warm_up / period)
        self._match = MatchLoop(self.scenario, 0, sim_world, referee=lambda _scenario, _field: None)
        self._robots = [robot.id for robot in recording.header.robots]
        self._players: dict[RobotId, Player] = {}
        self._followers = {robot: LogFollower(recording, robot) for robot in self._robots}
        self._watch = LogWatch(logged, leave)
        self._field: FieldGeometry = recording.header.field
        self._rater = ExpectedGoal(goalkeeper="fitted")
        self._fresh = self._match.checkpoint()
        self._restored: Checkpoint | None = None

    def close(self) -> None:
        """Shut the trees down."""
        self._match.close()

    def begin(self, tick: int) -> None:
        """Set the match up as it was at a tick.

        Raises:
            WhatIfError: it cannot be played on from there.
        """
        self.logged.check_moment(tick)
        recording = self.logged.recording
        self._fresh.restore()
        self.tick = tick
        self._referee = ResumedReferee(self._field, referee_settings(self.scenario))
        self._figures = TeamStatistics()
        for before in range(max(0, tick - self._warm_up), tick):
            frame = recording.frame(before)
            self._referee.watch(frame)
            self._figures.update(frame, frame.game)
            self._match.decide(recording.observation(before))
        # Only now: if the log names another goalkeeper, two players have exchanged their robots.
        self._players = {player.robot: player for player in self._match.players}
        self._placement, self._holder = logged_start(self.logged.recording, tick)
        self._restored = self._match.checkpoint(self._referee, self._figures)

    def play(
        self,
        seed: int,
        trial: int,
        *,
        follow: Collection[Team] = (),
        decision: BallDecision | None = None,
        record: BranchRecording | None = None,
    ) -> Branch:
        """Play one branch of the present moment.

        Args:
            seed: seed of all branches.
            trial: number of the branch; the same number has the same errors, whatever is decided.
            follow: teams that follow the log until the game has left it.
            decision: what a robot decides otherwise; it then goes on with its play.
            record: records it.

        Returns:
            What came of it.
        """
        check()
        assert self._restored is not None, "begin() comes first"
        self._restored.restore()
        generator = np.random.default_rng([seed, trial])
        errors = BranchErrors(self.errors, generator, self._robots)
        match, world = self._match, self._match.world
        world.reset(errors.start(self._placement, self._holder, self._field), int(generator.integers(2**31)))
        for robot in self._absent(self.tick):
            world.take_robot(robot)
        for robot, player in self._players.items():
            player.driver = self._followers[robot] if robot.team in follow else None
        if decision is not None:
            decision.begin(self._players[decision.robot])
        following, followed = bool(follow), 0
        first = self.logged.game(self.tick)
        before = self._figures.result()
        truth, step = world.truth(), 0
        events: tuple[RefereeEvent, ...] = ()
        with record or nullcontext():
            for step in range(self._length + 1):
                tick = self.tick + step
                truth = world.truth()
                if step == 0:
                    truth.game = first
                    game = self._referee.begin(truth)
                else:
                    judged = self._referee.update(truth)
                    game, events = judged.game, judged.events
                truth.game = game
                self._figures.update(truth, game, events)
                over = game.command not in STARTED or step == self._length
                commands: Mapping[RobotId, RobotCommand] = {}
                frame = truth
                if not over:
                    if following and self._watch.left(truth, tick):
                        following = False
                        self._release(follow)
                    followed += following
                    frame = world.observe()
                    frame.game = game
                    for follower in self._followers.values():
                        follower.tick = tick
                    commands = match.decide(frame)
                if record is not None:
                    record.take(truth, frame, commands, events, tick)
                if over:
                    break
                world.act(compensated(errors.execute(commands), frame))
        # A log may begin with a score, which nothing before the moment has shown then.
        scores = {Team.BLUE: first.blue_score, Team.YELLOW: first.yellow_score}
        result = self._figures.result()
        goals = {team: result[team.value].goals - scores[team] for team in Team}
        return self._outcome(before, truth, step, followed, goals)

    @property
    def first_error(self) -> str | None:
        """The first failure of a robot's tree in any branch, and whose; None without one."""
        failed = self._match.measures.robots.items()
        return next((f"{robot}: {one.first_error}" for robot, one in failed if one.first_error), None)

    def really(self) -> Branch:
        """Return what really followed the present moment in the log, as if it were a branch.

        It ends with the log where that is shorter.
        """
        assert self._restored is not None, "begin() comes first"
        self._restored.restore()
        recording, before = self.logged.recording, self._figures.result()
        last = min(self._length, len(recording) - 1 - self.tick)
        frame, step = recording.frame(self.tick), 0
        goals = dict.fromkeys(Team, 0)
        for step in range(last + 1):
            frame = recording.frame(self.tick + step)
            self._figures.update(frame, frame.game)
            stopped = frame.game.command not in STARTED
            if step == last or stopped or ball_out(self._field, frame.ball.position):
                goals = self.logged.goals(self.tick, self.tick + step)
            if stopped or any(goals.values()):
                break
        return self._outcome(before, frame, step, step, goals)

    def recording(self, path: str, title: str) -> BranchRecording:
        """Return a recording of a branch, with the log drawn beside it.

        Args:
            path: the file, which ends in ``.robobt.arrows`` or ``.html``.
            title: name of the recording.
        """
        return BranchRecording(path, title, self.logged, self._players.values())

    def holder(self) -> RobotId | None:
        """Return the robot that has the ball at the present moment."""
        return owner(self.logged.recording.frame(self.tick))

    def _release(self, follow: Collection[Team]) -> None:
        for robot, player in self._players.items():
            if robot.team in follow and player.driver is self._followers[robot]:
                player.driver = None

    def _absent(self, tick: int) -> list[RobotId]:
        rows = self.logged.recording.truth.robots[tick]
        return [robot for robot, row in zip(self._robots, rows, strict=True) if not np.isfinite(row[0])]

    def _outcome(
        self,
        before: Mapping[str, TeamResult],
        truth: Frame,
        steps: int,
        followed: int,
        goals: Mapping[Team, int],
    ) -> Branch:
        after, period = self._figures.result(), self.scenario.period
        expected = {}
        for team in Team:
            now, then = after[team.value], before[team.value]
            expected[team] = now.expected_goals - then.expected_goals
            if goals[team] and now.shots_on_goal == then.shots_on_goal:
                expected[team] += goals[team]
        stopped = truth.game.command not in STARTED or any(goals.values())
        return Branch(
            goals=goals,
            expected=expected,
            stands=0.0 if stopped else standing(truth, self._rater, Team.BLUE),
            ball=truth.ball.position,
            followed=followed * period,
            lasted=steps * period,
        )
