"""What a robot does with the ball in its mouth: dribbler and kicker."""

from __future__ import annotations

from math import cos, hypot, sin

from robobt.sim.columns import (
    BALL_R,
    CENTRING,
    CHIP_ANGLE,
    CHIP_MAX,
    CHIP_YIELD,
    CORE,
    FACE,
    HALF_MOUTH,
    KICK_DAMPING,
    KICK_MAX,
    PULL,
    REACH,
    RISE,
    SENSOR,
    SIDE,
)
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

_CLEAR = 2e-4
"""Gap that a ball needs to be free of the front that pushed it [m]."""

_GLUE_GAP = 2e-4
"""Gap at which a glued ball is carried, so that no contact brakes the robot [m]."""


@compiled_lean
def in_mouth(ball: FloatArray, robot: FloatArray, p: FloatArray, depth: float) -> bool:
    """Return whether the ball lies ahead of the flat front, within the mouth and ``depth`` of it."""
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    reach = p[FACE] + p[BALL_R] + depth
    if px * px + py * py > reach * reach + p[HALF_MOUTH] * p[HALF_MOUTH]:
        return False
    c, s = cos(robot[2]), sin(robot[2])
    ahead = c * px + s * py
    aside = c * py - s * px
    return bool(0.0 < ahead <= reach and abs(aside) <= p[HALF_MOUTH])


@compiled_lean
def let_in(ball: FloatArray, velocity: FloatArray, robot: FloatArray, p: FloatArray, dt: float) -> None:
    """Move a ball that comes within ``dt`` to where the kicker's sensor sees it.

    A fast one would else go past the sensor and bounce off within one step.
    """
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    c, s = cos(robot[2]), sin(robot[2])
    way = c * px + s * py - p[FACE] - p[BALL_R] - 0.5 * p[SENSOR]
    vx, vy = velocity[0] - robot[3] + robot[5] * py, velocity[1] - robot[4] - robot[5] * px
    closing = -(c * vx + s * vy)
    if way <= 0.0 or way >= closing * dt:
        return
    time = way / closing
    aside = c * py - s * px + (c * vy - s * vx) * time
    if abs(aside) <= p[HALF_MOUTH]:
        ball[0] += vx * time
        ball[1] += vy * time


@compiled_lean
def keeps(ball: FloatArray, robot: FloatArray, p: FloatArray, held: bool) -> bool:
    """Return whether grSim's dribbler holds the ball from now on, as it decides once a frame.

    It does not take a ball that has got into the front, which a robot runs into
    when it covers the whole of its reach between two frames.
    """
    if not in_mouth(ball, robot, p, p[REACH]):
        return False
    ahead = cos(robot[2]) * (ball[0] - robot[0]) + sin(robot[2]) * (ball[1] - robot[1])
    return held or ahead >= p[FACE] + p[BALL_R] + _CLEAR


@compiled_lean
def hold(
    ball: FloatArray,
    velocity: FloatArray,
    robot: FloatArray,
    p: FloatArray,
    most: float,
    dt: float,
    pull: FloatArray,
) -> None:
    """Add the limited acceleration with which a dribbler draws the ball to its place."""
    c, s = cos(robot[2]), sin(robot[2])
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    ahead = c * px + s * py
    aside = c * py - s * px
    place = p[FACE] + p[BALL_R]
    # Velocity of the robot's point under the ball, in the robot's frame.
    along = c * robot[3] + s * robot[4] - robot[5] * aside
    across = c * robot[4] - s * robot[3] + robot[5] * ahead
    ball_along = c * velocity[0] + s * velocity[1]
    ball_across = c * velocity[1] - s * velocity[0]
    # A ball carried on a circle needs the centripetal part on top.
    want_along = (along + (place - ahead) / p[CENTRING] - ball_along) / dt
    want_along -= robot[5] * robot[5] * ahead
    want_across = (across - aside / p[CENTRING] - ball_across) / dt
    limit_pull, limit_side = p[PULL], p[SIDE]
    if most >= 0.0:
        limit_pull = limit_side = most
    want_along = min(max(want_along, -limit_pull), 0.0)
    want_across = min(max(want_across, -limit_side), limit_side)
    pull[0] += c * want_along - s * want_across
    pull[1] += s * want_along + c * want_across


@compiled_lean
def carry(ball: FloatArray, robot: FloatArray, p: FloatArray, dt: float, move: FloatArray) -> None:
    """Compute the velocity that keeps the ball where it sits in the mouth while the robot moves."""
    c, s = cos(robot[2]), sin(robot[2])
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    ahead = p[FACE] + p[BALL_R] + _GLUE_GAP
    if p[CORE] > 0.0:
        ahead = max(ahead, c * px + s * py)
    aside = c * py - s * px
    turned = robot[2] + robot[5] * dt
    c, s = cos(turned), sin(turned)
    x = robot[0] + robot[3] * dt + c * ahead - s * aside
    y = robot[1] + robot[4] * dt + s * ahead + c * aside
    move[0] = (x - ball[0]) / dt
    move[1] = (y - ball[1]) / dt


@compiled_lean
def kick(
    velocity: FloatArray,
    spin: FloatArray,
    air: FloatArray,
    robot: FloatArray,
    speed: float,
    angle: float,
    p: FloatArray,
) -> None:
    """Send the ball along the heading; its sideways velocity stays, its spin is lost.

    Args:
        velocity: of the ball, changed [m/s].
        spin: its rolling as a velocity, changed [m/s].
        air: (FLIGHT,) its height, speed upwards and touch-downs, changed.
        robot: the robot's row.
        speed: commanded [m/s].
        angle: commanded, from the ground; 0 is a flat kick, any other a chip [rad].
        p: parameters of the arena.
    """
    air[:] = 0.0
    most = p[KICK_MAX]
    if angle > 0.0:
        most = p[CHIP_MAX]
        if p[CHIP_ANGLE] > 0.0:
            angle = p[CHIP_ANGLE]
        speed *= p[CHIP_YIELD]
        air[RISE] = speed * sin(angle)
        speed *= cos(angle)
    c, s = cos(robot[2]), sin(robot[2])
    forward = c * velocity[0] + s * velocity[1]
    sideways = c * velocity[1] - s * velocity[0]
    forward = speed - p[KICK_DAMPING] * forward
    fast = hypot(forward, sideways)
    if angle > 0.0:
        fast = hypot(fast, air[RISE])
    if fast > most:
        forward *= most / fast
        sideways *= most / fast
        air[RISE] *= most / fast
    velocity[0] = c * forward - s * sideways
    velocity[1] = s * forward + c * sideways
    spin[0] = spin[1] = 0.0
