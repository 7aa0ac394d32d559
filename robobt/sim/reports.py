"""What is told of the arenas after a tick: where everything is, who has the ball, who touched it last."""

from __future__ import annotations

from math import cos, pi, sin

from robobt.sim.mouth import in_mouth
from robobt.sim.records import ARENA, BODY, FLIGHT, SEEN_BALL, Arena, ArenaArrays, Body
from robobt.world.compiled import compiled_lean
from robobt.world.state import BALL_RADIUS, RECEIVED_HEIGHT, ROBOT_RADIUS

_TOUCH = 2e-3
"""Gap between ball and robot that still counts as a touch [m]."""


@compiled_lean
def toucher(arena: Arena, before: int) -> int:
    """Return who touches the ball, else -1; of several, one that is not the one that touched it before."""
    body, ahead = arena.body, arena.parameters.front + BALL_RADIUS + _TOUCH
    found = -1
    for i in range(len(arena.robots)):
        robot = arena.robots[i]
        px, py = body.x - robot.x, body.y - robot.y
        reach = ROBOT_RADIUS + BALL_RADIUS + _TOUCH
        if px * px + py * py > reach * reach:
            continue
        if cos(robot.heading) * px + sin(robot.heading) * py > ahead:
            continue
        if found < 0 or found == before:
            found = i
    return found


@compiled_lean
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
def report(arrays_: ArenaArrays) -> None:
    """Fill in what arenas tell of robots and balls, from their bodies."""
    arrays = ArenaArrays(*arrays_)
    bodies, states = arrays.bodies.view(BODY)[..., 0], arrays.states.view(ARENA)[..., 0]
    robots, balls = arrays.robots.view(BODY)[..., 0], arrays.balls.view(SEEN_BALL)[..., 0]
    flights, contact = arrays.flight.view(FLIGHT)[..., 0], arrays.contact
    stride = len(bodies) // len(states)
    for a in range(len(states)):
        first = a * stride
        state, body = states[a], bodies[first + contact.shape[1]]
        p = state.parameters
        for i in range(contact.shape[1]):
            robot = bodies[first + i]
            near = flights[a].z < RECEIVED_HEIGHT and in_mouth(body, robot, p, p.body.sensor_depth)
            contact[a, i] = near
            _report(robot, robots[a, i])
        ball = balls[a]
        ball.x, ball.y = body.x, body.y
        ball.vx, ball.vy = state.ball.vx, state.ball.vy
