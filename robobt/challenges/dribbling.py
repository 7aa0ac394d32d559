"""The dribbling challenge of 2022: carry the ball through gates between robots, in order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from robobt.challenges.challenge import CHALLENGES, ChallengeAttempt, Figures, FixedChallenge
from robobt.match.scenario.scenario import scenario_from
from robobt.skills.challenges.carry_along import GATE_POSTS, GATES
from robobt.world.game import GameState
from robobt.world.geometry import Point, distance
from robobt.world.rules import ball_out, keeps_ball
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame

GATES_TIME = 120.0
"""Time limit of a trial [s]; the rules of 2022 have none."""

_POSTS_TOUCHED = 2.0 * ROBOT_RADIUS + 0.002
"""Two robots whose centres are this near touch [m]; contact is seen once a tick."""

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
        self.passed = 0
        self.failed = self.placed = False
        self.time: float | None = None
        self._side = 0
        self._through = [False, False]
        self._before: tuple[Point, Point] | None = None

    def see(self, frame: Frame, game: GameState) -> bool:  # noqa: ARG002
        """Take in the next true ``frame`` of the ``game``; return whether the trial is over."""
        (me,) = frame.own
        posts = {robot.id: robot.position for robot in frame.opponents}
        touched = any(distance(me.position, post) <= _POSTS_TOUCHED for post in posts.values())
        self.failed = touched or ball_out(frame.field, frame.ball.position)
        if self.failed:
            return True
        if self.passed == len(GATES):
            gap = distance(frame.ball.position, posts[_END_ROBOT])
            rests = frame.ball.speed < 0.05 and not keeps_ball(me, frame.ball)
            self.placed = rests and abs(gap - _END_GAP) <= _END_SLACK
            return self.placed
        a, b = (posts[number] for number in GATE_POSTS[GATES[self.passed]])
        places = me.position, frame.ball.position
        if self._before is not None:
            for index, (before, now) in enumerate(zip(self._before, places, strict=True)):
                if _sign(_across(before, a, b)) != _sign(_across(now, a, b)):
                    self._through[index] = _between(before, now, a, b)
        self._before = places
        sides = [
            _sign(gap) if abs(gap) > radius else 0
            for gap, radius in zip(
                (_across(place, a, b) for place in places), (ROBOT_RADIUS, BALL_RADIUS), strict=True
            )
        ]
        if not keeps_ball(me, frame.ball):
            # Who loses the ball on the way through begins again with it.
            self._side, self._through = 0, [False, False]
            return False
        if sides[0] != sides[1] or sides[0] == 0:
            return False
        if self._side == -sides[0] and all(self._through):
            self.passed += 1
            self.time = frame.time
            # The next gate is crossed from where they are now.
            self._side, self._through, self._before = 0, [False, False], None
        else:
            self._side, self._through = sides[0], [False, False]
        return False

    def figures(self) -> Figures:
        """Return the gates, 0 if the trial failed, and until when they were passed [s]."""
        gates = 0.0 if self.failed else float(self.passed)
        told = {"gates": gates, "failed": float(self.failed), "placed": float(self.placed)}
        return told if self.time is None or self.failed else {**told, "time": self.time}


def _across(place: Point, a: Point, b: Point) -> float:
    """Return the signed distance of a place from the line through two posts [m]."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    return ((place[0] - a[0]) * dy - (place[1] - a[1]) * dx) / distance(a, b)


def _between(before: Point, now: Point, a: Point, b: Point) -> bool:
    """Return whether the line is crossed between the posts."""
    first, second = _across(before, a, b), _across(now, a, b)
    share = first / (first - second) if first != second else 0.0
    x, y = (before[i] + share * (now[i] - before[i]) for i in (0, 1))
    along = (x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])
    return 0.0 < along < distance(a, b) ** 2


def _sign(value: float) -> int:
    return 1 if value > 0.0 else -1


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
