"""The obstacle challenge of 2025: drive to a point, and touch neither robots nor lines nor areas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import nan
from typing import ClassVar

import numpy as np

from robobt.challenges.challenge import CHALLENGES, Challenge, ChallengeAttempt, Figures, FixedChallenge
from robobt.challenges.obstacle_course import KNOWN, ObstacleCourse, unseen
from robobt.challenges.touching import CourseTouch, touched
from robobt.match.referee.events import Decision
from robobt.match.refereeing import RefereeFactory
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.plays.challenges.obstacle_run import OBSTACLE_TARGET, VIRTUAL_LINE
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point, distance
from robobt.world.state import Frame

COURSE_TIME = 30.0
"""Time limit of a trial [s]. Source: the challenge's rules of 2025."""

REACHED = 0.07
"""A robot whose centre is this near to the target has reached it [m]. Source: as above."""

_TOLD = {
    CourseTouch.ROBOT: "a robot",
    CourseTouch.AREA: "the area",
    CourseTouch.BALL_WAY: "the ball's way",
    CourseTouch.LINE: "the line",
}
"""The touches as figures name them."""


@dataclass(slots=True, frozen=True)
class PlacementState:
    """A referee that only says that yellow places the ball at a spot, as long as the trial lasts."""

    spot: Point

    def update(self, frame: Frame) -> Decision:
        """Return the same state of the game in every frame."""
        game = GameState(
            RefereeCommand.BALL_PLACEMENT_YELLOW,
            restart=Restart.BALL_PLACEMENT,
            restart_team=Team.YELLOW,
            may_touch=True,
            placement=self.spot,
            upcoming=RefereeCommand.DIRECT_FREE_YELLOW,
            action_time=COURSE_TIME - frame.time,
        )
        return Decision(game)

    def close(self) -> None:
        """Do nothing."""


def _placement_of(spot: Point, _scenario: Scenario, _field: FieldGeometry) -> PlacementState:
    return PlacementState(spot)


class ObstacleJudge:
    """Judges one trial: time to the target, and what was touched.

    Source: the rules of 2025: collisions at any speed, 0.2 m around the opponents' defence area, 0.5 m
    around the way of the placed ball, and the line between robots 2 and 3, all without grace.
    """

    def __init__(self) -> None:
        self.touched = CourseTouch.NOTHING
        self.time: float | None = None

    def see(self, frame: Frame, game: GameState) -> bool:
        """Take in the next true ``frame`` and the ``game`` there; return whether the trial is over."""
        (robot,) = frame.own
        self.touched = _touch(frame, game)
        if not self.touched and distance(robot.position, OBSTACLE_TARGET) <= REACHED:
            self.time = frame.time
        return bool(self.touched) or self.time is not None

    def figures(self) -> Figures:
        """Return the time left, and what happened: 1 or 0 each; the time only if the target was reached."""
        left = 0.0 if self.time is None else max(0.0, COURSE_TIME - self.time)
        figures = {"time left": left, "reached": float(self.time is not None)}
        figures |= {f"touched {name}": float(self.touched is what) for what, name in _TOLD.items()}
        return figures if self.time is None else {**figures, "time": self.time}


def _touch(frame: Frame, game: GameState) -> CourseTouch:
    (me,) = frame.own
    ends = [robot.position for robot in frame.opponents if robot.id in VIRTUAL_LINE]
    return CourseTouch(
        touched(
            np.array([me.position]),
            np.array([robot.position for robot in frame.opponents]).reshape(1, -1, 2),
            np.array([frame.ball.position]),
            np.array([game.placement or frame.ball.position]),
            np.array([ends if len(ends) == 2 else [(nan, nan), (nan, nan)]]),
            frame.field,
        )[0]
    )


def course_attempt(course: ObstacleCourse, name: str) -> ChallengeAttempt:
    """Return the attempt at a course, called ``name``."""

    def yellow_view(at: Point) -> list[float]:
        return [-at[0], -at[1]]

    yellow = [
        {
            "number": one.number,
            "play": "patrol",
            "params": {
                "to": None if one.to is None else yellow_view(one.to),
                "speed": one.speed or 1.0,
                "dribbler": one.number == course.carrier,
            },
            # The mouth looks towards -x of the world, which is +x for yellow.
            "start": {"position": yellow_view(one.at), "heading": 0.0},
        }
        for one in course.obstacles
    ]
    scenario = scenario_from(
        {
            "name": f"obstacles_{course.name}",
            "description": "Drive to a point past robots, areas and lines; the obstacle challenge of 2025",
            "period": 1.0 / 60.0,
            "robots": {
                "blue": [{"number": 0, "play": "stand_still", "start": {"position": list(course.start)}}],
                "yellow": yellow,
            },
            "ball": {"held_by": f"yellow {course.carrier}"},
            "clearance": 0.0,
            "ends": {"time_limit": COURSE_TIME},
        },
        "obstacles",
    )
    referee: RefereeFactory = partial(_placement_of, course.spot or course.ball)
    return ChallengeAttempt(name, scenario, ObstacleJudge, referee)


def free_attempt(course: ObstacleCourse) -> ChallengeAttempt:
    """Return the same course without robots in the way, the goalkeeper with the ball aside."""
    goalkeeper = KNOWN[0].obstacles[0]
    return course_attempt(ObstacleCourse("free", course.start, (goalkeeper,), 0), "free")


_ENTRANTS = {
    "ours": "obstacle_run",
    "november": "obstacle_run_2026_11",
    "script": "obstacle_run_straight",
    "chance": "stand_still",
}
_SOURCE = "RoboCup 2025 Obstacle Avoidance Challenge, RoboCup-SSL/technical-challenge-rules c5e6bfd"


@CHALLENGES.register("obstacles")
class Obstacles(FixedChallenge):
    """Drive through the two published example courses, three trials each; the best one counts."""

    title = "The published obstacle courses, the best of three trials each"
    source = _SOURCE
    unit = "s left"
    most = 60.0
    entrants: ClassVar[Mapping[str, str]] = _ENTRANTS

    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return three trials of each course."""
        return [course_attempt(course, f"{course.name}-{trial}") for course in KNOWN for trial in (1, 2, 3)]

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the sum over the courses of the most time left, and how many trials reached the target."""
        courses = [attempts[3 * index : 3 * index + 3] for index in range(len(KNOWN))]
        best = [max(trial["time left"] for trial in trials) for trials in courses]
        named = {course.name: left for course, left in zip(KNOWN, best, strict=True)}
        return {"time left": sum(best), **named, "reached": sum(trial["reached"] for trial in attempts)}


@CHALLENGES.register("obstacles_unseen")
class ObstaclesUnseen(Challenge):
    """Drive through a course that nobody has seen, drawn from the trial's seed, once.

    The time is compared with the same drive without robots in the way.
    """

    title = "An obstacle course drawn from the seed, one trial"
    source = _SOURCE
    unit = "s left"
    most = 30.0
    entrants: ClassVar[Mapping[str, str]] = _ENTRANTS

    def attempts(self, generator: np.random.Generator) -> Sequence[ChallengeAttempt]:
        """Return the course, and the same drive without robots in the way."""
        course = unseen(generator)
        return [course_attempt(course, "course"), free_attempt(course)]

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the figures of the course; where both targets were reached also the ratio of the times."""
        course, free = attempts
        if "time" in course and "time" in free:
            return {**course, "of the free drive": course["time"] / free["time"]}
        return course
