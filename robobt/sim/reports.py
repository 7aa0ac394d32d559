"""The report of the arenas after a tick: positions, ball contact and last touch."""

from __future__ import annotations

from math import cos, pi, sin

from robobt.sim.mouth import in_mouth
from robobt.sim.records import ARENA, BODY, FLIGHT, SEEN_BALL, Arena, Body, BoolArray
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, RECEIVED_HEIGHT, ROBOT_RADIUS

_REPORTED_TOUCH_GAP = 2e-3
"""Gap between ball and robot that still counts as a touch [m]."""


@compiled_merged
def note_touch(arena: Arena) -> None:
    """Record the robot that touches the ball; if several do, one that did not touch it before."""
    body, ahead = arena.body, arena.parameters.front + BALL_RADIUS + _REPORTED_TOUCH_GAP
    found = -1
    for i in range(len(arena.robots)):
        robot = arena.robots[i]
        px, py = body.x - robot.x, body.y - robot.y
        reach = ROBOT_RADIUS + BALL_RADIUS + _REPORTED_TOUCH_GAP
        if px * px + py * py > reach * reach:
            continue
        if cos(robot.heading) * px + sin(robot.heading) * py > ahead:
            continue
        if found < 0 or found == arena.touch.robot:
            found = i
    if found >= 0:
        arena.touch.robot = found


@compiled_merged
def _report(robot: Body, out: Body) -> None:
    """Copy a robot's body, heading in (-pi, pi]."""
    out.x = robot.x
    out.y = robot.y
    heading = robot.heading
    if not 0.0 <= heading <= pi:
        heading = heading + 2.0 * pi if -pi <= heading < 0.0 else heading % (2.0 * pi)
        if heading > pi:
            heading -= 2.0 * pi
    out.heading = heading
    out.vx = robot.vx
    out.vy = robot.vy
    out.omega = robot.omega


@compiled_lean
def report(
    states_: FloatArray,
    bodies_: FloatArray,
    flight: FloatArray,
    contact: BoolArray,
    robots_: FloatArray,
    balls_: FloatArray,
) -> None:
    """Fill in ``contact``, robots and balls; all of them as in :class:`~robobt.sim.arrays.ArenaArrays`."""
    states, bodies = states_.view(ARENA)[..., 0], bodies_.view(BODY)[..., 0]
    robots, balls = robots_.view(BODY)[..., 0], balls_.view(SEEN_BALL)[..., 0]
    flights = flight.view(FLIGHT)[..., 0]
    count = contact.shape[1]
    for a in range(len(states)):
        state, body, ball = states[a], bodies[a, count], balls[a]
        low, p = flights[a].z < RECEIVED_HEIGHT, state.parameters
        for i in range(count):
            robot = bodies[a, i]
            contact[a, i] = low and in_mouth(body, robot, p, p.body.sensor_depth)
            _report(robot, robots[a, i])
        ball.x, ball.y = body.x, body.y
        ball.vx, ball.vy = state.ball.vx, state.ball.vy
