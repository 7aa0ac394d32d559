"""The end of a trial: when it is over, and its outcome."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from math import ceil

from robobt.match.referee.events import EventKind
from robobt.match.scenario.scenario import Scenario
from robobt.world.game import GameState, Restart, Stage, Team
from robobt.world.rules import ALL_AROUND, ball_out, has_ball, scorer
from robobt.world.state import BallState, Frame, RobotId

_REST_SPEED = 0.05
"""A ball slower than this is at rest [m/s]."""


class Outcome(StrEnum):
    """How a trial ended."""

    GOAL_BLUE = "goal_blue"
    GOAL_YELLOW = "goal_yellow"
    SAVED = "saved"
    """A goalkeeper has the ball or has kicked it."""
    OUT = "out"
    REST = "rest"
    """The ball is at rest after a kick."""
    TIME = "time"
    SCORE = "score"
    """A team has reached the score limit."""
    PLACED = "placed"
    """A ball placement succeeded."""
    NOT_PLACED = "not_placed"
    FULL_TIME = "full_time"
    """The referee has ended the match."""


class EndJudge:
    """Checks a scenario's end conditions, on true frames seen from blue's side.

    Without a referee it also counts the goals.

    Args:
        scenario: the scenario with the end conditions.
        refereed: whether a referee or game controller decides and keeps the score.
        hold: whether the end conditions apply; without them only the referee ends a match.

    Attributes:
        scores: goals of each team.
    """

    def __init__(self, scenario: Scenario, refereed: bool = False, hold: bool = True) -> None:
        ends = scenario.ends
        free = scenario.referee is None and not refereed
        self.scores = {Team.BLUE: 0, Team.YELLOW: 0}
        self._referee = not free
        self._ends, self._hold = ends, hold
        self._goal_ends = free if ends.goal is None else ends.goal
        self._out_ends = free if ends.ball_out is None else ends.ball_out
        self._keepers = {RobotId(team, number) for team, number in scenario.goalkeepers().items()}
        # Half a period early, because frames of a world that runs at its own pace are not aligned with ticks.
        self._last = (ceil(ends.time_limit / scenario.period - 1e-9) - 0.5) * scenario.period
        self._ball_before: BallState | None = None
        self._was_out = False
        self._placing: Team | None = None
        self._held_since: float | None = None
        self._rest_since: float | None = None

    def judge(
        self, truth: Frame, game: GameState, kicks: int, kicked: Sequence[RobotId] = ()
    ) -> Outcome | None:
        """Return the outcome if the match is over at this frame, else None.

        ``kicks`` counts the kicks so far, ``kicked`` has the robots that kicked since the last frame.
        """
        goal_by = self._goal_by(truth, game)
        if not self._hold:
            return Outcome.FULL_TIME if game.stage is Stage.POST_GAME else None
        if goal_by is not None and self._goal_ends:
            return Outcome.GOAL_BLUE if goal_by is Team.BLUE else Outcome.GOAL_YELLOW
        limit = self._ends.score_limit
        if limit is not None and max(self.scores.values()) >= limit:
            return Outcome.SCORE
        if game.stage is Stage.POST_GAME:
            return Outcome.FULL_TIME
        placed = self._placed(game)
        if placed is not None and self._ends.placement:
            return placed
        if self._was_out and self._out_ends and goal_by is None:
            return Outcome.OUT
        held, rest = self._ends.held_by_goalkeeper, self._ends.ball_at_rest
        if held is not None:
            if any(robot in self._keepers for robot in kicked):
                return Outcome.SAVED
            if _lasted(self._since_held(truth), held, truth.time):
                return Outcome.SAVED
        if rest is not None and _lasted(self._since_rest(truth, kicks), rest, truth.time):
            return Outcome.REST
        return Outcome.TIME if truth.time >= self._last else None

    def _placed(self, game: GameState) -> Outcome | None:
        """Return how a ball placement ended at this frame, or None if none ended."""
        placing = game.restart_team if game.restart is Restart.BALL_PLACEMENT else None
        before, self._placing = self._placing, placing
        if before is None or placing is before:
            return None
        return Outcome.PLACED if EventKind.PLACEMENT_SUCCEEDED in game.events else Outcome.NOT_PLACED

    def _goal_by(self, truth: Frame, game: GameState) -> Team | None:
        """Return the team that has scored since the last frame."""
        before = self._ball_before or truth.ball
        self._ball_before = truth.ball
        self._was_out = ball_out(truth.field, truth.ball.position)
        if self._referee:
            before_blue, before_yellow = self.scores[Team.BLUE], self.scores[Team.YELLOW]
            self.scores[Team.BLUE], self.scores[Team.YELLOW] = game.blue_score, game.yellow_score
            if game.blue_score > before_blue:
                return Team.BLUE
            return Team.YELLOW if game.yellow_score > before_yellow else None
        team = scorer(truth.field, before, truth.ball)
        if team is not None:
            self.scores[team] += 1
        return team

    def _since_held(self, truth: Frame) -> float | None:
        robots = truth.robots()
        keepers = [robots[keeper] for keeper in self._keepers if keeper in robots]
        if not any(has_ball(keeper, truth.ball, ALL_AROUND) for keeper in keepers):
            self._held_since = None
        elif self._held_since is None:
            self._held_since = truth.time
        return self._held_since

    def _since_rest(self, truth: Frame, kicks: int) -> float | None:
        if not kicks or truth.ball.speed > _REST_SPEED:
            self._rest_since = None
        elif self._rest_since is None:
            self._rest_since = truth.time
        return self._rest_since


def _lasted(since: float | None, duration: float, now: float) -> bool:
    return since is not None and now - since >= duration - 1e-9
