"""The observation of a robot that is to get to the ball among others that move, defined once and compiled."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.observation import ObservationSpec, kinematics, motion, observation_spec
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

PLACES = 6
"""How many other robots are observed, the nearest first."""

FAR = 3.0
"""Robots and gaps farther than this are observed as so far [m]."""

AHEAD = 2.0
"""How far ahead a closest approach is looked for [s]."""

_OWN, _EACH = 6, 6

GO_TO_BALL_AMONG_ROBOTS: ObservationSpec = observation_spec(
    "go_to_ball_among_robots",
    1,
    **dict.fromkeys(("ball_x", "ball_y"), "m"),
    ball_distance="m",
    **dict.fromkeys(("vx", "vy"), "m/s"),
    omega="rad/s",
    **{
        f"robot_{number}_{entry}": unit
        for number in range(PLACES)
        for entry, unit in (
            ("x", "m"), ("y", "m"), ("vx", "m/s"), ("vy", "m/s"), ("closest", "m"), ("closest_in", "s")
        )
    },
)  # fmt: skip
"""The ball, the robot's velocity and the nearest other robots, in the robot's frame.

``ball_x`` and ``ball_y`` are the direction to the ball, of length 1. Another robot's velocity is that
relative to the robot. ``closest`` is the gap between the two hulls at their closest approach within
:data:`AHEAD` if both go on as they do, negative where they would meet; ``closest_in`` is the time until then.
Places without a robot hold one :data:`FAR` behind.
"""


@compiled
def among_robots_rows(robots: FloatArray, balls: FloatArray) -> FloatArray:
    """Compute the states :data:`GO_TO_BALL_AMONG_ROBOTS` of many arenas, (n, 42).

    Args:
        robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates; the first is who observes.
        balls: (n, 4) x, y, vx, vy.
    """
    rows = np.empty((len(robots), _OWN + _EACH * PLACES))
    for i in range(len(robots)):
        me, row = robots[i, 0], rows[i]
        c, s = cos(me[2]), sin(me[2])
        dx, dy = balls[i, 0] - me[0], balls[i, 1] - me[1]
        distance = hypot(dx, dy)
        # A ball at the robot's very centre counts as straight ahead. NaN has to stay NaN.
        row[0], row[1] = 1.0, 0.0
        if distance != 0.0:
            row[0], row[1] = (c * dx + s * dy) / distance, (c * dy - s * dx) / distance
        row[2] = distance
        row[3], row[4], row[5] = c * me[3] + s * me[4], c * me[4] - s * me[3], me[5]
        places = row[_OWN:].reshape(PLACES, _EACH)
        for k in range(PLACES):
            places[k, 0], places[k, 1], places[k, 2], places[k, 3] = -FAR, 0.0, 0.0, 0.0
            places[k, 4], places[k, 5] = FAR, AHEAD
        away = np.full(PLACES, np.inf)
        for other in range(1, robots.shape[1]):
            it = robots[i, other]
            ox, oy, wx, wy = it[0] - me[0], it[1] - me[1], it[3] - me[3], it[4] - me[4]
            far = hypot(ox, oy)
            # Insert it behind those that are as near, and move the farther ones on.
            place = PLACES
            while place > 0 and far < away[place - 1]:
                place -= 1
                if place + 1 < PLACES:
                    away[place + 1] = away[place]
                    places[place + 1] = places[place]
            if place == PLACES:
                continue
            away[place] = far
            squared = wx * wx + wy * wy
            time = min(max(-(ox * wx + oy * wy) / squared, 0.0), AHEAD) if squared > 1e-9 else 0.0
            gap = hypot(ox + wx * time, oy + wy * time) - 2.0 * ROBOT_RADIUS
            scale = FAR / far if far > FAR else 1.0
            places[place, 0] = scale * (c * ox + s * oy)
            places[place, 1] = scale * (c * oy - s * ox)
            places[place, 2], places[place, 3] = c * wx + s * wy, c * wy - s * wx
            places[place, 4], places[place, 5] = min(gap, FAR), time
    return rows


def among_robots_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the state :data:`GO_TO_BALL_AMONG_ROBOTS` of one robot in a frame, (42,)."""
    others = [*(mate for mate in frame.own if mate.id != robot.id), *frame.opponents]
    robots = np.array([kinematics(one) for one in (robot, *others)])
    row: FloatArray = among_robots_rows(robots[None], np.array([motion(frame)]))[0]
    return row
