"""The goal line as both raters judge it at a first shot."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, sin
from pathlib import Path

from paper.deployed import Situation, deployed_scenario
from robobt.config import new_figure, save_figure
from robobt.match import MatchLoop, WorldFactory, trial_seed
from robobt.skills import ExpectedGoal, NNFiltered, goal_candidates
from robobt.world import BALL_RADIUS, ROBOT_RADIUS, FloatArray, Frame, RobotState
from robobt.worlds import sim_world


def judged_goal_line(situation: Situation, seed: int, path: Path, world: WorldFactory = sim_world) -> None:
    """Play ``attack_expected`` until its first shot and draw the goal line as judged at that moment.

    Raises:
        RuntimeError: it takes no shot in the first of its trials.
    """
    scenario = deployed_scenario(situation, "attack_expected")
    with MatchLoop(scenario, trial_seed(seed, 0), world) as match:
        store = match.players[0].store
        while match.tick():
            if store.command.kick_speed > 0.0:
                break
        else:
            raise RuntimeError("attack_expected takes no shot in this trial")
        frame, me = store.frame, store.me
    points = goal_candidates(frame.field)
    expected = ExpectedGoal().chances(frame, frame.ball.position, me, points)
    assert expected is not None
    network = NNFiltered().chances(frame, me, points)
    draw_goal_line(frame, me, {"expected_goal": expected, "nn_filtered": network}, path)


def draw_goal_line(frame: Frame, me: RobotState, chances: Mapping[str, FloatArray], path: Path) -> None:
    """Draw a scene with its goal line as raters judge it: the probability at every target point.

    ``chances`` (T,) are for the points of :func:`goal_candidates`, by the rater's name; the path's ending
    decides the format (.png, .svg, .pdf).
    """
    from matplotlib.patches import Circle

    field, ball = frame.field, frame.ball
    points = goal_candidates(field)
    figure = new_figure(9.0, 4.4)
    scene, line = figure.subplots(1, 2, width_ratios=(3, 2))
    first = next(iter(chances.values()))
    for point, chance in zip(points[::3], first[::3], strict=True):
        color = (1.0 - float(chance), 0.15 + 0.6 * float(chance), 0.2)
        scene.plot([ball.x, point[0]], [ball.y, point[1]], color=color, linewidth=0.8, alpha=0.7)
    for robots, paint in ((frame.own, "C0"), (frame.opponents, "C1")):
        for robot in robots:
            scene.add_patch(Circle(robot.position, ROBOT_RADIUS, color=paint))
            tip = (robot.x + 0.14 * cos(robot.heading), robot.y + 0.14 * sin(robot.heading))
            scene.plot([robot.x, tip[0]], [robot.y, tip[1]], color="black", linewidth=1)
    scene.add_patch(Circle(ball.position, BALL_RADIUS, color="orange"))
    goal = field.goal_width / 2.0
    scene.plot([field.half_length] * 2, [-goal, goal], color="C3", linewidth=4)
    low = min(ball.x, me.x) - 0.4
    reach = max(abs(ball.y), goal) + 0.4
    scene.set(xlim=(low, field.half_length + 0.15), ylim=(-reach, reach), aspect="equal")
    scene.set(xlabel="x [m]", ylabel="y [m]", title=f"{frame.time:.2f} s")
    for name, values in chances.items():
        line.plot(values, points[:, 1], label=name)
    line.set(
        xlim=(-0.02, 1.02), ylim=(-goal, goal), xlabel="probability of a goal", ylabel="y of the target [m]"
    )
    line.legend(loc="best", fontsize=8)
    save_figure(figure, path)
