"""The cooperation challenge of 2026: two robots of different teams score a goal together, quickly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan, nan
from typing import ClassVar

import numpy as np

from robobt.challenges.challenge import CHALLENGES, ChallengeAttempt, Figures, FixedChallenge
from robobt.challenges.handover import Handover
from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.verdicts import FOULS
from robobt.match.scenario.scenario import scenario_from
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, Team
from robobt.world.geometry import Point
from robobt.world.rules import area_distance, scorer, touches
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotId

TRY_TIME = 30.0
"""Time limit of a try [s]. Source: the challenge's rules of 2026."""

FAST_BALL, FAST_ROBOT, HIGH_BALL = 3.5, 2.5, 0.1
"""Most speed of ball and robots [m/s], and most height of the ball [m]. Source: as above."""

MAJOR, JUNIOR = RobotId(Team.BLUE, 0), RobotId(Team.BLUE, 1)
"""The robots of the Small Size League and of the junior league."""

PAIR = (MAJOR, JUNIOR)
"""Both in the order of :class:`~robobt.challenges.handover.Handover`."""

PLACES: tuple[Point, Point] = ((-2.5, 1.0), (-0.5, -2.0))
"""Starts of both robots [m]. Source: as above."""

BALL_START: Point = (-1.5, 0.0)
"""Start of the ball [m]. Source: as above."""

START_SPREAD = 0.05
"""Radius around their starts in which both robots stand [m]."""

_OVER_SPEED = 0.05
"""How much faster than allowed counts as measured wrongly [m/s]."""


class CooperationJudge:
    """Counts the points of one try.

    Source: the challenge's rules of 2026. The junior robot stays still until the other has shot the ball,
    then shoots it into the goal, for the points of :class:`Handover`. A wrong order costs 4 points, every
    other broken rule 1 point. A chip above 0.1 m ends the try without points.
    """

    def __init__(self) -> None:
        self.broken: set[str] = set()
        self._handover: Handover | None = None
        self._before: BallState | None = None
        self._automatic = AutomaticReferee(DIVISION_B, RefereeSettings(max_ball_speed=FAST_BALL))

    def see(self, frame: Frame, game: GameState) -> bool:
        """Take in the next true ``frame`` and the ``game`` there; return whether the try is over."""
        ball = frame.ball
        scored = self._before is not None and scorer(frame.field, self._before, ball) is Team.BLUE
        self._before = ball
        self._count(frame, scored)
        for event in self._automatic.watch(frame, game):
            if event.team is Team.BLUE and event.kind in FOULS:
                self.broken.add(event.kind.value)
        if any(robot.speed > FAST_ROBOT + _OVER_SPEED for robot in frame.own):
            self.broken.add("fast robot")
        if any(
            area_distance(frame.field, team, robot.x, robot.y) < ROBOT_RADIUS
            for team in Team
            for robot in frame.own
        ):
            self.broken.add("robot in a defence area")
        if ball.z > HIGH_BALL:
            self.broken.add("chip")
            return True
        return scored

    def _count(self, frame: Frame, scored: bool) -> None:
        """Let the robots' :class:`Handover` see the frame."""
        if self._handover is None:
            self._handover = Handover(1, frame.field)
        ball, pair = frame.ball, [frame.robots()[robot] for robot in PAIR]
        self._handover.see(
            np.array([[robot.speed for robot in pair]]),
            np.array([[touches(robot, ball) for robot in pair]]),
            np.array([PAIR.index(frame.last_touch) if frame.last_touch in PAIR else -1]),
            np.array([ball.position]),
            np.array([ball.speed]),
            np.array([scored]),
            np.array([frame.time]),
        )
        if self._handover.early[0]:
            self.broken.add("order")

    def figures(self) -> Figures:
        """Return the points, the goal (0 or 1), how many rules were broken, and the time of the goal [s]."""
        cost = sum(4.0 if what == "order" else 1.0 for what in self.broken)
        seen = self._handover
        points = 0.0 if seen is None or "chip" in self.broken else max(0.0, float(seen.points[0]) - cost)
        time = nan if seen is None else float(seen.scored[0])
        told = {"points": points, "goals": float(not isnan(time)), "broken rules": float(len(self.broken))}
        return told if isnan(time) else {**told, "time": time}


@CHALLENGES.register("cooperation")
class Cooperation(FixedChallenge):
    """One robot passes, the other shoots the goal, within 15 s; the best three of five tries count.

    Both robots are robobt's, as the simulator has no junior robot; blue plays what yellow plays in the rules.
    """

    title = "A goal by two robots together, the best three of five tries"
    source = "RoboCup 2026 SSL RCJ Cooperation Challenge, RoboCup-SSL/technical-challenge-rules c5e6bfd"
    unit = "points"
    most = 138.0
    entrants: ClassVar[Mapping[str, str]] = {
        "ours": "pass_and_score",
        "november": "field_player_2026_11",
        "script": "go_to_ball_and_shoot",
        "chance": "stand_still",
    }

    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return five tries."""
        limits = {"max_speed": FAST_ROBOT}
        scenario = scenario_from(
            {
                "name": "cooperation",
                "description": self.title,
                "period": 1.0 / 60.0,
                "robots": {
                    "blue": [
                        {
                            "number": robot.number,
                            "play": "stand_still",
                            "limits": limits,
                            "start": {
                                "position": {"center": at, "radius": START_SPREAD},
                                "heading": "towards ball",
                            },
                        }
                        for robot, at in zip(PAIR, PLACES, strict=True)
                    ]
                },
                "ball": {"position": BALL_START},
                "ends": {"time_limit": TRY_TIME},
            },
            "cooperation",
        )
        return [ChallengeAttempt(str(number), scenario, CooperationJudge) for number in range(1, 6)]

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the points of the best three tries, and how many goals and broken rules all five had."""
        best = sorted((one["points"] for one in attempts), reverse=True)[:3]
        told = {name: sum(one[name] for one in attempts) for name in ("goals", "broken rules")}
        times = sorted(one["time"] for one in attempts if "time" in one)
        return {"points": sum(best), **told, **({"fastest": times[0]} if times else {})}
