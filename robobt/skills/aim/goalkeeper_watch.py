"""What the match so far says about the opponents' goalkeeper."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import atan2, exp, hypot, inf
from typing import NamedTuple, TypeAlias

import numpy as np

from robobt.world.game import Team
from robobt.world.geometry import FloatArray, distance, line_crossing_x
from robobt.world.state import RECEIVED_HEIGHT, Frame, RobotState

LEAST_WEIGHT = 0.002
"""Least probability of a kind of goalkeeper: two surprising shots revive it."""

LEAST_LIKELIHOOD = 0.02
"""No outcome of a shot is taken for less likely: a kick may go astray."""

ChancesByKind: TypeAlias = Callable[["SeenShot"], FloatArray]
"""Returns the chance of a goal of a shot against each kind of goalkeeper, (K,)."""


def updated(weights: FloatArray, chances: FloatArray, scored: bool) -> FloatArray:
    """Return the probabilities of the kinds of goalkeepers after one more shot, by Bayes' rule.

    Args:
        weights: those before the shot, (K,).
        chances: the chance of a goal against each kind, (K,).
        scored: whether the shot scored.
    """
    likely = np.clip(chances if scored else 1.0 - chances, LEAST_LIKELIHOOD, 1.0)
    return _normal(weights * likely)


class Speeds(NamedTuple):
    """How fast a kind of goalkeeper drives [m/s].

    Attributes:
        usual: top speed that it uses, so that its robot must be capable of it.
        most: speed that it hardly ever exceeds.
    """

    usual: float
    most: float


SPEEDS = {
    "fitted": Speeds(0.9, 1.05),
    "robobulls": Speeds(1.0, 1.35),
    "half_speed": Speeds(1.125, 1.25),
    "full_speed": Speeds(2.25, inf),
}
"""Speeds by kind, as 40 attacks against each from ``deployed_full``'s starts (seed 555) show them."""

_BLUR = 0.05
"""Over which excess a speed becomes unlikely [m/s]."""
_ABOVE_LIMIT = 1.1
"""A robot may be faster than its limits say by this factor."""
_FRAMES = 3
"""Number of frames in a row over which a speed has to be held: one may be noise."""
_HOME = 1.5
"""Farther than this from its goal's middle a robot is not keeping it [m]."""
_KICK_GAP = 0.2
"""Ball to the centre of a robot that may have kicked it [m]."""
_KICK_GAIN, _LEAST_SPEED = 1.5, 2.0
"""A ball that gains this speed at once, and has that afterwards, was shot [m/s]."""
_STOPPED = 0.3
"""A shot slower than this towards the goal line is over [m/s]."""
_LONGEST = 3.0
"""A shot is over after this time [s]."""


@dataclass(slots=True, frozen=True)
class SeenShot:
    """A shot of the own team.

    Attributes:
        frame: the last frame before the kick.
        shooter: the robot that kicked, in that frame.
        y: where the ball's line crosses the opponents' goal line [m].
        scored: whether it scored.
    """

    frame: Frame
    shooter: RobotState
    y: float
    scored: bool


@dataclass(slots=True)
class GoalkeeperWatch:
    """Follows the opponents' goalkeeper, and the own team's shots at its goal, through a match.

    One object for each team, :meth:`robobt.skills.store.TeamStore.shared`. Its memory follows from the frames
    alone.

    Attributes:
        shots: the own team's shots that are over, oldest first.
        fastest: highest speed of the goalkeeper that was held over three frames [m/s].
        limit: top speed of its robot, as far as known [m/s].
    """

    shots: list[SeenShot] = field(default_factory=list)
    fastest: float = 0.0
    limit: float = inf
    _frame: Frame | None = None
    _flying: SeenShot | None = None
    _since: float = 0.0
    _keeper: int | None = None
    _speeds: list[float] = field(default_factory=list)
    _known: dict[str, tuple[int, FloatArray]] = field(default_factory=dict)

    def follow(self, frame: Frame) -> None:
        """Take in a frame; a frame that was taken in already changes nothing."""
        before, self._frame = self._frame, frame
        if before is frame:
            return
        self._follow_goalkeeper(frame)
        if before is None or frame.time <= before.time:
            self._flying = None
            return
        if self._flying is None:
            self._flying, self._since = _kicked(before, frame), frame.time
        else:
            self._follow_shot(self._flying, frame)

    def weights(self, model: str, kinds: Sequence[str], chances: ChancesByKind) -> FloatArray:
        """Return the probability of each kind of goalkeeper, (K,).

        Before the first shot all kinds are equally likely, but for those that the goalkeeper has been faster
        than, and those that are faster than its robot.

        Args:
            model: whose ``chances`` they are.
            kinds: names of the kinds; of one that is not in :data:`SPEEDS` nothing is known beforehand.
            chances: the model's chances of a shot.
        """
        count, weights = self._known.get(model, (0, np.full(len(kinds), 1.0 / len(kinds))))
        for shot in self.shots[count:]:
            weights = updated(weights, chances(shot), shot.scored)
        self._known[model] = len(self.shots), weights
        return _normal(weights * [self._moves_like(kind) for kind in kinds])

    def _moves_like(self, kind: str) -> float:
        if kind not in SPEEDS:
            return 1.0
        usual, most = SPEEDS[kind]
        if usual > _ABOVE_LIMIT * self.limit:
            return 0.0
        return 1.0 / (1.0 + exp(min((self.fastest - most) / _BLUR, 50.0)))

    def _follow_goalkeeper(self, frame: Frame) -> None:
        keeper = goalkeeper_of(frame)
        if keeper is None or keeper.id != self._keeper:
            self._speeds.clear()
        self._keeper = None if keeper is None else keeper.id
        if keeper is not None:
            self.limit = keeper.limits.max_speed
            self._speeds = [*self._speeds[1 - _FRAMES :], hypot(keeper.vx, keeper.vy)]
            if len(self._speeds) == _FRAMES:
                self.fastest = max(self.fastest, min(self._speeds))

    def _follow_shot(self, shot: SeenShot, frame: Frame) -> None:
        ball, field_, before = frame.ball, frame.field, shot.frame
        over = ball.vx < _STOPPED or frame.time - self._since > _LONGEST
        scored = _score(frame) > _score(before)
        if ball.x > field_.half_length:
            scored = scored or abs(ball.y) < field_.goal_width / 2.0
            over = True
        if scored or over:
            self.shots.append(SeenShot(before, shot.shooter, shot.y, scored))
            self._flying = None


def goalkeeper_of(frame: Frame) -> RobotState | None:
    """Return the opponents' goalkeeper: the one that the game names, else the robot nearest to their goal."""
    goal, named = frame.field.their_goal, frame.game.status(frame.team.other).keeper
    for robot in frame.opponents:
        if robot.id == named:
            return robot
    near = min(frame.opponents, key=lambda robot: distance(robot.position, goal), default=None)
    return near if near is not None and distance(near.position, goal) < _HOME else None


def _score(frame: Frame) -> int:
    return frame.game.blue_score if frame.team is Team.BLUE else frame.game.yellow_score


def _kicked(before: Frame, frame: Frame) -> SeenShot | None:
    """Return the own team's shot on goal that began between two frames."""
    ball, was = frame.ball, before.ball
    if ball.speed < _LEAST_SPEED or ball.speed - was.speed < _KICK_GAIN or ball.z > RECEIVED_HEIGHT:
        return None
    y = line_crossing_x(ball.position, atan2(ball.vy, ball.vx), frame.field.half_length)
    if ball.vx <= 0.0 or y is None or abs(y) >= frame.field.goal_width / 2.0:
        return None
    shooter = _nearest(before.own, was.position)
    if shooter is None or distance(shooter.position, was.position) > _KICK_GAP:
        return None
    return SeenShot(before, shooter, y, scored=False)


def _nearest(robots: Iterable[RobotState], place: tuple[float, float]) -> RobotState | None:
    return min(robots, key=lambda robot: distance(robot.position, place), default=None)


def _normal(weights: FloatArray) -> FloatArray:
    """Return weights as probabilities, none below :data:`LEAST_WEIGHT`."""
    total = float(weights.sum())
    shares = weights / total if total > 0.0 else np.ones(len(weights))
    kept = np.maximum(shares, LEAST_WEIGHT)
    result: FloatArray = kept / kept.sum()
    return result
