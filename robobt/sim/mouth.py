"""The dribbler and the kicker, which act on a ball in the mouth."""

from __future__ import annotations

from math import cos, hypot, sin

from robobt.sim.records import Body, Flight, Parameters, SimulatedBall
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.records import Limits
from robobt.world.state import BALL_RADIUS

_RELEASED_GAP = 2e-4
"""Gap that a ball needs to be free of the front that pushed it [m]."""

_GLUE_GAP = 2e-4
"""Gap at which a glued ball is carried, so that no contact brakes the robot [m]."""


@compiled_lean
def in_mouth(body: Body, robot: Body, p: Parameters, depth: float) -> bool:
    """Return whether the ball is in front of the flat front, within the mouth and within ``depth`` of it."""
    px, py = body.x - robot.x, body.y - robot.y
    reach = p.body.face + BALL_RADIUS + depth
    if px * px + py * py > reach * reach + p.half_mouth * p.half_mouth:
        return False
    c, s = cos(robot.heading), sin(robot.heading)
    ahead = c * px + s * py
    aside = c * py - s * px
    return bool(0.0 < ahead <= reach and abs(aside) <= p.half_mouth)


@compiled_merged
def let_in(body: Body, ball: SimulatedBall, robot: Body, p: Parameters, dt: float) -> None:
    """Move a ball that comes within ``dt`` to where the kicker's sensor sees it.

    Otherwise a fast ball would pass the sensor and bounce off within one step.
    """
    px, py = body.x - robot.x, body.y - robot.y
    c, s = cos(robot.heading), sin(robot.heading)
    way = c * px + s * py - p.body.face - BALL_RADIUS - 0.5 * p.body.sensor_depth
    vx, vy = ball.vx - robot.vx + robot.omega * py, ball.vy - robot.vy - robot.omega * px
    closing = -(c * vx + s * vy)
    if way <= 0.0 or way >= closing * dt:
        return
    time = way / closing
    aside = c * py - s * px + (c * vy - s * vx) * time
    if abs(aside) <= p.half_mouth:
        body.x += vx * time
        body.y += vy * time


@compiled_merged
def keeps(body: Body, robot: Body, p: Parameters, held: bool) -> bool:
    """Return whether grSim's dribbler holds the ball from now on, as it decides once a frame.

    It does not take a ball that has got into the front, which a robot runs into
    when it covers the whole of its reach between two frames.
    """
    if not in_mouth(body, robot, p, p.dribbler.reach):
        return False
    ahead = cos(robot.heading) * (body.x - robot.x) + sin(robot.heading) * (body.y - robot.y)
    return held or ahead >= p.body.face + BALL_RADIUS + _RELEASED_GAP


@compiled_lean
def hold(body: Body, ball: SimulatedBall, robot: Body, p: Parameters, most: float, dt: float) -> None:
    """Add the limited acceleration with which a dribbler draws the ball to its place.

    Args:
        body: of the ball.
        ball: whose pull is changed.
        robot: its body.
        p: parameters of the arena.
        most: acceleration, negative for what the dribbler has driven [m/s^2].
        dt: time step [s].
    """
    c, s = cos(robot.heading), sin(robot.heading)
    px, py = body.x - robot.x, body.y - robot.y
    ahead = c * px + s * py
    aside = c * py - s * px
    place = p.body.face + BALL_RADIUS
    # Velocity of the robot's point under the ball, in the robot's frame.
    along = c * robot.vx + s * robot.vy - robot.omega * aside
    across = c * robot.vy - s * robot.vx + robot.omega * ahead
    ball_along = c * ball.vx + s * ball.vy
    ball_across = c * ball.vy - s * ball.vx
    # A ball carried on a circle needs the centripetal part on top.
    want_along = (along + (place - ahead) / p.dribbler.centring - ball_along) / dt
    want_along -= robot.omega * robot.omega * ahead
    want_across = (across - aside / p.dribbler.centring - ball_across) / dt
    limit_pull, limit_side = p.dribbler.pull, p.dribbler.side
    if most >= 0.0:
        limit_pull = limit_side = most
    want_along = min(max(want_along, -limit_pull), 0.0)
    want_across = min(max(want_across, -limit_side), limit_side)
    ball.pull_x += c * want_along - s * want_across
    ball.pull_y += s * want_along + c * want_across


@compiled_merged
def carry(body: Body, ball: SimulatedBall, robot: Body, p: Parameters, dt: float) -> None:
    """Compute the mean velocity that keeps the ball where it sits in the mouth while the robot moves."""
    c, s = cos(robot.heading), sin(robot.heading)
    px, py = body.x - robot.x, body.y - robot.y
    ahead = p.body.face + BALL_RADIUS + _GLUE_GAP
    if p.core > 0.0:
        ahead = max(ahead, c * px + s * py)
    aside = c * py - s * px
    turned = robot.heading + robot.omega * dt
    c, s = cos(turned), sin(turned)
    x = robot.x + robot.vx * dt + c * ahead - s * aside
    y = robot.y + robot.vy * dt + s * ahead + c * aside
    ball.move_x = (x - body.x) / dt
    ball.move_y = (y - body.y) / dt


@compiled_merged
def kick(
    body: Body,
    ball: SimulatedBall,
    air: Flight,
    robot: Body,
    limits: Limits,
    speed: float,
    angle: float,
    p: Parameters,
) -> None:
    """Send the ball along the heading; its spin is lost.

    Of its sideways velocity, seen by the robot's front, it keeps the share ``limits.touch_kept``. The kick
    adds the share ``limits.touch_returned`` of the speed at which it comes, or ``limits.carried`` of the
    speed at which it moves ahead with the robot, as a resting ball does that the robot drives into; what is
    carried may exceed the kicker's own limit.

    Args:
        body: of the ball.
        ball: changed.
        air: its flight, changed.
        robot: its body.
        limits: the robot's.
        speed: commanded [m/s].
        angle: commanded, from the ground; 0 is a flat kick, any other a chip [rad].
        p: parameters of the arena.
    """
    air.z = air.vz = air.hops = 0.0
    most = p.kicker.max_speed
    if angle > 0.0:
        most = p.kicker.max_chip_speed
        if p.kicker_angle > 0.0:
            angle = p.kicker_angle
        speed *= p.kicker.chip_yield
        air.vz = speed * sin(angle)
        speed *= cos(angle)
    c, s = cos(robot.heading), sin(robot.heading)
    forward = c * ball.vx + s * ball.vy
    sideways = c * ball.vy - s * ball.vx
    if forward >= 0.0 and limits.carried > 0.0:
        # The front has pushed the ball by the time that the kicker sends it off.
        forward = max(forward, c * robot.vx + s * robot.vy)
    if forward > 0.0:
        most += max(0.0, limits.carried * forward)
        forward = speed + limits.carried * forward
    else:
        forward = speed - limits.touch_returned * forward
    front = c * robot.vy - s * robot.vx + robot.omega * (c * (body.x - robot.x) + s * (body.y - robot.y))
    sideways -= (1.0 - limits.touch_kept) * (sideways - front)
    fast = hypot(forward, sideways)
    if angle > 0.0:
        fast = hypot(fast, air.vz)
    if fast > most:
        forward *= most / fast
        sideways *= most / fast
        air.vz *= most / fast
    ball.vx = c * forward - s * sideways
    ball.vy = s * forward + c * sideways
    ball.spin_x = ball.spin_y = 0.0
