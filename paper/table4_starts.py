"""Starts and limits of Table 4, and the shortest possible times."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, hypot, radians, sin
from pathlib import Path
from typing import Literal

import numpy as np

from paper.table4_rows import Minimum
from robobt.learning import straight_line_time
from robobt.match import Box, Scenario, load_scenario
from robobt.sim import PRESETS, SimSettings
from robobt.world import BALL_RADIUS, Frame, Point

SCENARIOS = Path(__file__).parent / "scenarios"

SHOOTER = "blue 0"
"""The robot that is measured."""

_GRSIM = PRESETS["grsim"].limits

LIMITS: dict[str, dict[str, float]] = {
    "paper": {
        "max_speed": 1.5,
        "acceleration": _GRSIM.acceleration,
        "side_acceleration": _GRSIM.lateral_acceleration,
    },
    "pilot": {"max_speed": 1.5, "acceleration": 2.5, "side_acceleration": 2.5},
    "own": {},
}
"""The limits of every robot of a table, by name.

The paper's 1.5 m/s with grSim's acceleration, that speed with the 2.5 m/s^2 of RoboBulls' pilot, and the
preset's own limits.
"""

Starts = Literal["drawn", "paper"]
"""Starts drawn around the paper's, or the paper's own in every run."""

_PLACE, _BALL_PLACE, _HEADING = 0.1, 0.05, radians(10.0)
"""How far drawn starts may be from the paper's in x and in y: robot and ball [m], heading [rad]."""
_FACINGS = 101
"""Directions between the posts that the shortest way is looked for in."""


def table4_scenario(
    trial: str,
    params: Mapping[str, object] | None,
    preset: str = "robobulls",
    realism: str | None = None,
    limits: Mapping[str, float] | None = None,
) -> Scenario:
    """Return a trial with another simulator, noise or limits of the robot.

    It plays go_to_ball_and_shoot with these parameters, or RoboBulls' play where they are None.
    """
    scenario = load_scenario(SCENARIOS / f"table4_trial{trial}.yaml")
    simulator = {**scenario.simulator, "preset": preset}
    if realism is not None:
        simulator["realism"] = realism
    changes: dict[str, object] = {"limits": dict(limits)} if limits else {}
    if params is not None:
        changes |= {"play": "go_to_ball_and_shoot", "params": dict(params)}
    return scenario.model_copy(update={"simulator": simulator}).with_robot(SHOOTER, **changes)


def drawn_starts(scenario: Scenario) -> Scenario:
    """Return a trial whose starts are drawn around its own: 0.1 m and 10 degrees, 0.05 m for the ball."""
    robot, ball = scenario.robots.blue[0].start.position, scenario.ball.position
    assert isinstance(robot, tuple)
    assert isinstance(ball, tuple)
    start = {"position": _around(robot, _PLACE), "heading": (-_HEADING, _HEADING)}
    placed = scenario.ball.model_copy(update={"position": Box(**_around(ball, _BALL_PLACE))})
    return scenario.model_copy(update={"ball": placed}).with_robot(SHOOTER, start=start)


def _around(place: Point, by: float) -> dict[str, tuple[float, float]]:
    return {"x": (place[0] - by, place[0] + by), "y": (place[1] - by, place[1] + by)}


def minimum_times(start: Frame, simulator: SimSettings) -> Minimum:
    """Compute the shortest possible times to the ball and to a kick at the goal of the first robot, at rest.

    The robot speeds up along a straight line with its strongest acceleration and does not
    brake. The ball is in the mouth where the simulator's sensor sees it; for the kick the
    robot has to face a place between the posts there.
    """
    me, ball, field = start.own[0], start.ball, start.field
    reach = simulator.body.face + BALL_RADIUS + simulator.body.sensor_depth
    strongest = max(me.limits.acceleration, me.limits.lateral_acceleration)
    inside = field.goal_width / 2 - BALL_RADIUS
    lower, upper = (atan2(side - ball.y, field.half_length - ball.x) for side in (-inside, inside))
    ways = [
        hypot(ball.x - reach * cos(facing) - me.x, ball.y - reach * sin(facing) - me.y)
        for facing in np.linspace(lower, upper, _FACINGS).tolist()
    ]
    times = straight_line_time([gap(start) - reach, min(ways)], me.limits.max_speed, strongest)
    return Minimum(to_ball=float(times[0]), to_kick=float(times[1]))


def gap(frame: Frame) -> float:
    """Return the distance of the first robot of the own team from the ball [m]."""
    robot, ball = frame.own[0], frame.ball
    return hypot(ball.x - robot.x, ball.y - robot.y)
