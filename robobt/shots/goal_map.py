"""A map of the probability to score from each place of the opponents' half."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from robobt.config.figures import new_figure, save_figure
from robobt.config.validation import first_problem
from robobt.match.scenario.placing import HELD_DISTANCE
from robobt.models.file import ModelError
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.skills.aim.raters.scene_chances import goalkeeper_kinds
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.geometry import FloatArray, Point, direction
from robobt.world.rules import in_their_defense_area
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState


@dataclass(frozen=True, slots=True)
class GoalMap:
    """Best probability of a goal by place of the ball.

    ``x`` (X,) and ``y`` (Y,) are coordinates of the ball [m]; ``probability`` (Y, X) is not-a-number in the
    defence area.
    """

    x: FloatArray
    y: FloatArray
    probability: FloatArray


def goal_map(model: str = "shot_expected", spacing: float = 0.1) -> GoalMap:
    """Return the best shot's probability from every place, past a goalkeeper at rest that covers the angle.

    Judged by the predictor ``model`` of the ``expected_goal`` rater, at places ``spacing`` apart [m]; where
    it tells kinds of goalkeepers apart, past one of the kind "fitted".

    Raises:
        ModelError: the model is no predictor of the ``expected_goal`` rater.
    """
    field = DIVISION_B
    try:
        rater = ExpectedGoal(model=model, goalkeeper="fitted" if "fitted" in goalkeeper_kinds(model) else "")
    except ValidationError as error:
        raise ModelError(first_problem(error, ExpectedGoal)[1]) from error
    points = goal_candidates(field)
    x = np.arange(0.0, field.half_length, spacing)
    y = np.arange(-field.half_width, field.half_width + spacing / 2.0, spacing)
    probability = np.full((len(y), len(x)), np.nan)
    for i, ball_y in enumerate(y.tolist()):
        for j, ball_x in enumerate(x.tolist()):
            if in_their_defense_area(field, ball_x, ball_y):
                continue
            frame = _scene(field, (ball_x, ball_y))
            chances = rater.chances(frame, (ball_x, ball_y), frame.own[0], points)
            if chances is not None:
                probability[i, j] = chances.max()
    return GoalMap(x, y, probability)


def draw_goal_map(found: GoalMap, path: Path) -> None:
    """Write the map as a picture; the ending decides the format (.png, .svg, .pdf)."""
    figure = new_figure(7.0, 6.6)
    axes = figure.add_subplot()
    shown = axes.pcolormesh(found.x, found.y, found.probability, vmin=0.0, vmax=1.0, cmap="viridis")
    figure.colorbar(shown, ax=axes, label="probability of a goal")
    field = DIVISION_B
    left, half = field.half_length - field.defense_depth, field.defense_width / 2.0
    edge = field.half_length
    axes.plot([edge, left, left, edge], [-half, -half, half, half], color="white", linewidth=1.2)
    goal = field.goal_width / 2.0
    axes.plot([edge, edge], [-goal, goal], color="C3", linewidth=4)
    axes.set(xlabel="x of the ball [m]", ylabel="y of the ball [m]", aspect="equal")
    axes.set_title("best shot past a goalkeeper that covers the angle")
    save_figure(figure, path)


def _scene(field: FieldGeometry, ball: Point) -> Frame:
    goal = field.their_goal
    heading = direction(ball, goal)
    me = RobotState(
        0,
        ball[0] - HELD_DISTANCE * cos(heading),
        ball[1] - HELD_DISTANCE * sin(heading),
        heading,
        ball_contact=True,
    )
    gap = hypot(goal[0] - ball[0], goal[1] - ball[1])
    out = min(0.5, 0.5 * gap)
    keeper = RobotState(
        0,
        min(goal[0] - out * cos(heading), field.half_length - ROBOT_RADIUS),
        goal[1] - out * sin(heading),
        direction(goal, ball),
    )
    return Frame(0.0, field, BallState(*ball), (me,), (keeper,))
