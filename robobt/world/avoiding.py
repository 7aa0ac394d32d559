"""The compiled observation of a robot that drives to the ball among moving robots."""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np

from robobt.world.compiled import compilable, compiled
from robobt.world.geometry import FloatArray
from robobt.world.observation import (
    ObservationEntry,
    ObservationSpec,
    entries,
    kinematics,
    motion,
    record_of,
    turned,
)
from robobt.world.records import BALL, ROBOT
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

WAY_SPEED = 1.5
"""Speed of the tested ways [m/s]; slow ways have half of it."""

WAYS, SLOW_WAYS = 16, 8
"""Number of evenly spaced directions at full and at half speed, the first one to the ball."""

AHEAD = 2.0
"""Time for which a way is tested [s]."""

MARGIN = 0.08
"""Hulls closer than this block each other [m]."""

LAG = 0.15
"""Time to change from one velocity to another [s]; half of it is driven at the old velocity."""

FIRST_WAY = 6
"""Their first index in an observation."""

GO_TO_BALL_AMONG_ROBOTS = ObservationSpec(
    "go_to_ball_among_robots",
    2,
    (
        *entries("ball_x ball_y", "m", 1.0),
        *entries("ball_distance", "m", "far", 3.0, signed=False),
        *entries("vx vy", "m/s", "speed", "max_speed"),
        *entries("omega", "rad/s", "turn", "max_turn"),
        *(ObservationEntry(f"free_{way * 360 // WAYS}", "s", AHEAD, signed=False) for way in range(WAYS)),
        *(
            ObservationEntry(f"slow_{way * 360 // SLOW_WAYS}", "s", AHEAD, signed=False)
            for way in range(SLOW_WAYS)
        ),
        ObservationEntry("standing", "s", AHEAD, signed=False),
    ),
    vectors=(0, 3),
)
"""The ball, the robot's velocity, and how long ways in all directions are free.

``ball_x`` and ``ball_y`` are the direction to the ball in the robot's frame, of length 1. ``free_A`` is for
how long the robot can drive at :data:`WAY_SPEED` in the direction A degrees to the left of the ball's until
it and another robot are nearer than :data:`MARGIN`, if the others keep their velocity: at most
:data:`AHEAD`, 0 if they are that near and get nearer. ``slow_A`` is that time at half the speed,
``standing`` at rest: the velocity obstacles of Fiorini & Shiller (1998), seen from the robot.
"""


_VECTOR_HEAD = record_of(GO_TO_BALL_AMONG_ROBOTS.entries[:FIRST_WAY])


@compilable
def free_time(ox: float, oy: float, wx: float, wy: float, apart: float) -> float:
    """Return when a robot at (ox, oy) with velocity (wx, wy), both relative, comes nearer than ``apart``."""
    closing = ox * wx + oy * wy
    if closing >= 0.0:
        return AHEAD
    beyond = ox * ox + oy * oy - apart * apart
    if beyond <= 0.0:
        return 0.0
    squared = wx * wx + wy * wy
    meets = closing * closing - squared * beyond
    if meets <= 0.0 or squared == 0.0:
        # A robot at rest may have a velocity so small that its square is 0.
        return AHEAD
    return min((-closing - sqrt(meets)) / squared, AHEAD)


@compiled
def among_robots_rows(robots: FloatArray, balls: FloatArray) -> FloatArray:
    """Compute the states :data:`GO_TO_BALL_AMONG_ROBOTS` of many arenas, (n, 31).

    Args:
        robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates; the first is who observes.
        balls: (n, 4) x, y, vx, vy.
    """
    rows = np.empty((len(robots), FIRST_WAY + WAYS + SLOW_WAYS + 1))
    each, rolling = robots.view(ROBOT)[..., 0], balls.view(BALL)[:, 0]
    heads = rows[:, :FIRST_WAY].view(_VECTOR_HEAD)[:, 0]
    for i in range(len(rows)):
        me, others, ball, seen = each[i, 0], each[i, 1:], rolling[i], heads[i]
        c, s = cos(me.heading), sin(me.heading)
        dx, dy = ball.x - me.x, ball.y - me.y
        distance = hypot(dx, dy)
        # A ball at the robot's very centre counts as straight ahead. NaN has to stay NaN.
        ux, uy = c, s
        if distance != 0.0:
            ux, uy = dx / distance, dy / distance
        seen.ball_x, seen.ball_y = turned(c, s, ux, uy)
        seen.ball_distance = distance
        seen.vx, seen.vy = turned(c, s, me.vx, me.vy)
        seen.omega = me.omega
        for way in range(WAYS + SLOW_WAYS + 1):
            speed, angle = 0.0, 0.0
            if way < WAYS:
                speed, angle = WAY_SPEED, 2.0 * pi * way / WAYS
            elif way < WAYS + SLOW_WAYS:
                speed, angle = 0.5 * WAY_SPEED, 2.0 * pi * (way - WAYS) / SLOW_WAYS
            ahead, aside = speed * cos(angle), speed * sin(angle)
            vx, vy = ux * ahead - uy * aside, uy * ahead + ux * aside
            free = AHEAD
            for other in others:
                ox = other.x - me.x + 0.5 * LAG * (vx - me.vx)
                oy = other.y - me.y + 0.5 * LAG * (vy - me.vy)
                free = min(free, free_time(ox, oy, other.vx - vx, other.vy - vy, 2.0 * ROBOT_RADIUS + MARGIN))
            rows[i, FIRST_WAY + way] = free
    return rows


def among_robots_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the state :data:`GO_TO_BALL_AMONG_ROBOTS` of one robot in a frame, (31,)."""
    others = [*(mate for mate in frame.own if mate.id != robot.id), *frame.opponents]
    robots = np.array([kinematics(one) for one in (robot, *others)])
    row: FloatArray = among_robots_rows(robots[None], np.array([motion(frame)]))[0]
    return row
