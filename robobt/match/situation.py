"""A moment of a match as a scenario that starts from it."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from math import cos, hypot, pi, sin
from typing import Any

from robobt.match.scenario.placing import HELD_DISTANCE
from robobt.match.scenario.robots import RobotSetup
from robobt.match.scenario.scenario import Scenario
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.rules import own_side
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotId, RobotState

_ROUNDING_GAP = 5e-4
"""Gap left between touching objects, so that rounding does not make them overlap [m]."""

_PASSES = 100
"""More iterations than separating a crowd takes."""


def situation_of(scenario: Scenario, frame: Frame, setups: Mapping[RobotId, RobotSetup]) -> dict[str, Any]:
    """Return, as data, the scenario that starts from ``frame``, seen from blue's side.

    A scenario starts with everything within the lines and nothing overlapping, so objects are moved there by
    the least distance. A ball that a robot's sensor sees is held by that robot.

    Args:
        scenario: the scenario that is played.
        frame: the present frame.
        setups: the present set-up of each robot.
    """
    there = {robot: state for robot, state in frame.robots().items() if robot in setups}
    holder = _holder(frame, there)
    places = {str(robot): [state.x, state.y, ROBOT_RADIUS] for robot, state in there.items()}
    if holder is None:
        places["ball"] = [frame.ball.x, frame.ball.y, BALL_RADIUS]
    _move_apart(list(places.values()), frame.field)
    robots: dict[str, list[dict[str, Any]]] = {}
    for team in Team:
        side = -own_side(team)
        robots[team.value] = []
        for setup in scenario.robots.of(team):
            robot = RobotId(team, setup.number)
            if robot not in there:
                continue
            x, y, _ = places[str(robot)]
            heading = wrap_angle(there[robot].heading + (pi if side < 0 else 0.0))
            now = setups[robot].model_dump(mode="json", exclude_unset=True)
            now["start"] = {
                "position": [round(side * x, 4), round(side * y, 4)],
                "heading": round(heading, 4),
            }
            robots[team.value].append(now)
    ball: dict[str, Any] = {"held_by": str(holder)}
    if holder is None:
        x, y, _ = places["ball"]
        ball = {
            "position": [round(x, 4), round(y, 4)],
            "velocity": [round(frame.ball.vx, 3), round(frame.ball.vy, 3)],
        }
    data = scenario.model_dump(mode="json", exclude_unset=True)
    return data | {"name": f"{scenario.name}_situation"[:80], "robots": robots, "ball": ball}


def _holder(frame: Frame, there: Mapping[RobotId, RobotState]) -> RobotId | None:
    """Return the robot with the ball deepest in its mouth."""
    ball = frame.ball

    def apart(robot: RobotId) -> float:
        state = there[robot]
        mouth = state.x + HELD_DISTANCE * cos(state.heading), state.y + HELD_DISTANCE * sin(state.heading)
        return hypot(ball.x - mouth[0], ball.y - mouth[1])

    return min((robot for robot, state in there.items() if state.ball_contact), key=apart, default=None)


def _move_apart(places: list[list[float]], field: FieldGeometry) -> None:
    """Move discs (x, y, radius) into the field and apart from each other, as little as possible [m]."""
    for _ in range(_PASSES):
        moved = False
        for place in places:
            place[0] = min(max(place[0], -field.half_length), field.half_length)
            place[1] = min(max(place[1], -field.half_width), field.half_width)
        for one, other in combinations(places, 2):
            dx, dy = other[0] - one[0], other[1] - one[1]
            away, needed = hypot(dx, dy), one[2] + other[2] + _ROUNDING_GAP
            if away >= needed:
                continue
            moved = True
            push = (needed - away + _ROUNDING_GAP / 10) / 2
            ux, uy = (dx / away, dy / away) if away else (1.0, 0.0)
            one[0], one[1] = one[0] - push * ux, one[1] - push * uy
            other[0], other[1] = other[0] + push * ux, other[1] + push * uy
        if not moved:
            return
