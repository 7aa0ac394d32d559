"""The dribbling challenge of 2022: carry the ball through gates between robots, in order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from robobt.challenges.challenge import CHALLENGES, ChallengeAttempt, Figures, FixedChallenge
from robobt.challenges.gates import POSTS_TOUCHED, GateCounter
from robobt.match.scenario.scenario import scenario_from
from robobt.skills.challenges.carry_along import GATES
from robobt.world.game import GameState
from robobt.world.geometry import Point, distance
from robobt.world.rules import ball_out, keeps_ball
from robobt.world.state import Frame

GATES_TIME = 120.0
"""Time limit of a trial [s]; the rules of 2022 have none."""

_BALL_START = (-3.5, -2.36)
"""Start of the ball [m], read off the rules' picture."""

_END_ROBOT, _END_GAP, _END_SLACK = 6, 1.0, 0.25
"""The robot beside which the ball is placed at the end, how far from it, and by how much that may differ [m].

The rules say "around one metre"; how much it may differ is robobt's own choice.
"""


class GateJudge:
    """Counts the gates passed in their order.

    Source: the challenge's rules of 2022. A gate is passed when robot and ball have crossed the line between
    its two robots as a whole, with the ball. A touch of a robot, or a ball that leaves the field, fails the
    trial.
    """

    def __init__(self) -> None:
        self._gates = GateCounter(1)
        self.failed = self.placed = False
        self.time: float | None = None

    @property
    def passed(self) -> int:
        """Number of gates passed."""
        return int(self._gates.passed[0])

    def see(self, frame: Frame, game: GameState) -> bool:  # noqa: ARG002
        """Take in the next true ``frame`` of the ``game``; return whether the trial is over."""
        (me,) = frame.own
        posts = {robot.id: robot.position for robot in frame.opponents}
        touched = any(distance(me.position, post) <= POSTS_TOUCHED for post in posts.values())
        self.failed = touched or ball_out(frame.field, frame.ball.position)
        if self.failed:
            return True
        if self.passed == len(GATES):
            gap = distance(frame.ball.position, posts[_END_ROBOT])
            rests = frame.ball.speed < 0.05 and not keeps_ball(me, frame.ball)
            self.placed = rests and abs(gap - _END_GAP) <= _END_SLACK
            return self.placed
        places = np.array([[posts[number] for number in sorted(posts)]])
        kept = np.array([keeps_ball(me, frame.ball)])
        if self._gates.see(places, np.array([me.position]), np.array([frame.ball.position]), kept)[0]:
            self.time = frame.time
        return False

    def figures(self) -> Figures:
        """Return the gates, 0 if the trial failed, and until when they were passed [s]."""
        gates = 0.0 if self.failed else float(self.passed)
        told = {"gates": gates, "failed": float(self.failed), "placed": float(self.placed)}
        return told if self.time is None or self.failed else {**told, "time": self.time}


@CHALLENGES.register("dribbling")
class GateDribbling(FixedChallenge):
    """Carry the ball through nine gates between standing robots, in order; the best of three trials."""

    title = "Nine gates with the ball, the best of three trials"
    source = "RoboCup 2022 Dribbling Challenge, RoboCup-SSL/technical-challenge-rules c5e6bfd"
    unit = "gates"
    most = float(len(GATES))
    entrants: ClassVar[Mapping[str, str]] = {
        "ours": "gate_run",
        "november": "field_player_2026_11:shot_distance=0",
        "script": "gate_run_forwards",
        "chance": "stand_still",
    }
    posts: ClassVar[Mapping[int, Point]] = {
        0: (-3.0, -2.3),
        1: (-3.5, -2.75),
        2: (-4.0, -2.3),
        3: (-3.5, -2.0),
        4: (-2.5, -2.3),
        5: (0.5, 2.5),
        6: (1.0, 2.5),
    }

    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return three trials."""
        scenario = scenario_from(
            {
                "name": "dribbling",
                "description": self.title,
                "period": 1.0 / 60.0,
                "robots": {
                    "blue": [
                        {
                            "number": 0,
                            "play": "stand_still",
                            "start": {"position": [3.5, 2.5], "heading": 1.57},
                        }
                    ],
                    "yellow": [
                        {"number": number, "play": "stand_still", "start": {"position": [-x, -y]}}
                        for number, (x, y) in self.posts.items()
                    ],
                },
                "ball": {"position": list(_BALL_START)},
                "clearance": 0.0,
                "ends": {"time_limit": GATES_TIME, "goal": False, "ball_out": False},
            },
            "dribbling",
        )
        return [ChallengeAttempt(str(trial), scenario, GateJudge) for trial in (1, 2, 3)]

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the best trial: most gates, then least time; and how many trials failed."""
        best = max(attempts, key=lambda one: (one["gates"], -one.get("time", GATES_TIME)))
        return {**best, "failed": sum(one["failed"] for one in attempts)}
