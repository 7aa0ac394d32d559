"""The ball placement challenge of 2023: eight balls are brought to their spots by robots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from robobt.challenges.challenge import CHALLENGES, ChallengeAttempt, Figures, FixedChallenge
from robobt.match.referee.events import Decision
from robobt.match.referee.rules.placement import PlacedBalls
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point, distance
from robobt.world.state import Frame

STOP_BEFORE = 2.0
"""Length of the STOP before the placement [s]. Source: the challenge's rules of 2023."""

PLACEMENT_TIME = 30.0
"""Time for the placement [s]. Source: SSL rules, chapter "Ball Placement"."""

PLACEMENTS: tuple[tuple[Point, Point, bool], ...] = (
    ((-0.2, -2.8), (-0.2, 2.8), False),
    ((-3.5, -2.25), (0.0, 0.0), False),
    ((-1.5, -2.25), (-0.2, -2.8), False),
    ((-4.4, -2.9), (-0.2, 2.8), False),
    ((-0.5, 0.0), (-4.3, 2.8), False),
    ((-1.0, -3.15), (-3.5, -2.8), True),
    ((-1.0, 3.15), (-3.5, 2.8), True),
    ((-4.55, -0.1), (-0.5, 2.8), True),
)
"""Start and goal of the ball [m], and whether it lies at the boundary. Source: as above, its JSON files."""

_MOVED, _NEAR_GOAL = 0.5, 0.5
"""Distance from the start that counts as moved, and from the goal as near [m]. Source: as above."""

_BALL_RESTS = 0.05
"""A ball slower than this has stopped [m/s]."""


@dataclass(slots=True, frozen=True)
class PlacementReferee:
    """Puts the ball at its start, stops the game, then asks blue to place the ball at a spot.

    Attributes:
        start: where the ball is put, which may lie behind a line [m].
        spot: where it is to be placed [m].
    """

    start: Point
    spot: Point

    def update(self, frame: Frame) -> Decision:
        """Return the state of the game at this frame."""
        left = STOP_BEFORE + PLACEMENT_TIME - frame.time
        upcoming = RefereeCommand.DIRECT_FREE_BLUE
        if frame.time < STOP_BEFORE - 1e-9:
            stopped = GameState(
                RefereeCommand.STOP, may_touch=False, placement=self.spot, upcoming=upcoming, action_time=left
            )
            return Decision(stopped, (), self.start if frame.time == 0.0 else None)
        return Decision(
            GameState(
                RefereeCommand.BALL_PLACEMENT_BLUE,
                restart=Restart.BALL_PLACEMENT,
                restart_team=Team.BLUE,
                placement=self.spot,
                upcoming=upcoming,
                action_time=left,
            )
        )

    def close(self) -> None:
        """Do nothing."""


def _referee_of(start: Point, spot: Point, _scenario: Scenario, _field: FieldGeometry) -> PlacementReferee:
    return PlacementReferee(start, spot)


class PlacementJudge:
    """Counts the points of one placement.

    Args:
        spot: where the ball is to be placed [m].
        boundary: whether the ball starts at the boundary.
    """

    def __init__(self, spot: Point, boundary: bool) -> None:
        self._spot, self._boundary = spot, boundary
        self._balls: PlacedBalls | None = None
        self._since = 0.0
        self._start: Point = (0.0, 0.0)
        self._gap = 0.0
        self.points = dict.fromkeys(
            ("dribbler", "moved", "stopped near", "near", "placed", "off boundary"), 0.0
        )
        self.time: float | None = None

    def see(self, frame: Frame, game: GameState) -> bool:
        """Take in the next true ``frame`` and the ``game`` there; return whether the ball is placed."""
        ball, points = frame.ball, self.points
        if frame.time <= frame.period:
            # The referee puts the ball down after the first frame.
            self._start = ball.position
        elif self._boundary and frame.field.contains(ball.x, ball.y):
            points["off boundary"] = 1.0
        self._gap = distance(ball.position, self._spot)
        if any(robot.ball_contact for robot in frame.own):
            points["dribbler"] = 1.0
        if distance(ball.position, self._start) > _MOVED:
            points["moved"] = 1.0
        if self._gap < _NEAR_GOAL and ball.speed < _BALL_RESTS:
            points["stopped near"] = 1.0
        if game.command is RefereeCommand.BALL_PLACEMENT_BLUE and self._is_placed(frame):
            points["placed"], self.time = 1.0, frame.time - STOP_BEFORE
        return self.time is not None

    def _is_placed(self, frame: Frame) -> bool:
        ball = np.array([frame.ball.position])
        if self._balls is None:
            self._balls, self._since = PlacedBalls(1, frame.period), frame.time
            self._balls.restart(np.array([0]), ball)
        robots = np.array([[robot.position for robot in frame.own]])
        elapsed = np.array([frame.time - self._since])
        return bool(self._balls.see(robots, ball, np.array([self._spot]), elapsed)[0])

    def figures(self) -> Figures:
        """Return the points, what they were given for, and the time of the placement [s]."""
        told = {**self.points, "near": float(self._gap < _NEAR_GOAL)}
        return {
            "points": sum(told.values()),
            **told,
            "time": PLACEMENT_TIME if self.time is None else self.time,
        }


@CHALLENGES.register("ball_placement")
class BallPlacement(FixedChallenge):
    """Bring eight balls to their spots within 30 s each, with six robots and nobody else on the field."""

    title = "Eight ball placements, one try each"
    source = "RoboCup 2023 Ball Placement Challenge, RoboCup-SSL/technical-challenge-rules c5e6bfd"
    unit = "points"
    most = 43.0
    entrants: ClassVar[Mapping[str, str]] = {
        "ours": "team_player",
        "november": "field_player_2026_11",
        "script": "carry_to_spot",
        "chance": "stand_still",
    }

    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return the eight scenarios of the rules."""
        return [self._attempt(number, *given) for number, given in enumerate(PLACEMENTS, 1)]

    def _attempt(self, number: int, start: Point, spot: Point, boundary: bool) -> ChallengeAttempt:
        scenario = scenario_from(
            {
                "name": f"ball_placement_{number}",
                "description": self.title,
                "period": 1.0 / 60.0,
                "robots": {
                    "blue": [
                        {"number": i, "play": "stand_still", "start": {"position": [0.0, y]}}
                        for i, y in enumerate((0.6, -0.6, 1.2, -1.2, 1.8, -1.8))
                    ]
                },
                "ends": {"time_limit": STOP_BEFORE + PLACEMENT_TIME},
            },
            "ball_placement",
        )
        judge = partial(PlacementJudge, spot, boundary)
        return ChallengeAttempt(str(number), scenario, judge, partial(_referee_of, start, spot))

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the points of all scenarios, how many balls were placed, and the sum of the times [s]."""
        names = ("points", "placed", "time")
        return {name: sum(attempt[name] for attempt in attempts) for name in names}
