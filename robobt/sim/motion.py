"""How a free ball slides and rolls.

The ball is modelled as Sumatra does, with the spin as a second velocity: ``spin``
is the velocity at which the ball would roll without sliding. While the two
differ the ball slides, losing speed and gaining spin; once they agree it rolls.
A ball kicked from rest then rolls from ``switch_share`` of its first speed on.

ODE, which grSim uses, bounds friction along each of the field's axes by itself. A ball
kicked almost along x stops sliding along y within 0.05 s, and goes on beside the
straight line from where it was kicked.
"""

from __future__ import annotations

from math import copysign, hypot

from robobt.sim.records import Parameters, SimulatedBall
from robobt.world.compiled import compiled_merged


@compiled_merged
def friction(ball: SimulatedBall, p: Parameters, dt: float) -> None:
    """Let a free ball slide and roll for ``dt``."""
    slide, roll, stop = p.ball.slide_deceleration, p.ball.roll_deceleration, p.ball.stop_speed
    start_x, start_y = ball.vx, ball.vy
    left = dt
    moved_x = moved_y = 0.0
    slip_x, slip_y = ball.vx - ball.spin_x, ball.vy - ball.spin_y
    slip = hypot(slip_x, slip_y) if slip_x != 0.0 or slip_y != 0.0 else 0.0
    if slip > 1e-9 and p.ball.separate_axes:
        rate = slide * (1.0 + p.spin_gain)
        time_x, time_y = min(abs(slip_x) / rate, dt), min(abs(slip_y) / rate, dt)
        loss_x, loss_y = copysign(slide * time_x, slip_x), copysign(slide * time_y, slip_y)
        ball.vx -= loss_x
        ball.vy -= loss_y
        ball.spin_x += p.spin_gain * loss_x
        ball.spin_y += p.spin_gain * loss_y
        # The axis that rolls first keeps its speed until the other does.
        sliding = max(time_x, time_y)
        moved_x = (start_x - 0.5 * loss_x) * time_x + ball.vx * (sliding - time_x)
        moved_y = (start_y - 0.5 * loss_y) * time_y + ball.vy * (sliding - time_y)
        left = dt - sliding
    elif slip > 1e-9:
        slip_x /= slip
        slip_y /= slip
        sliding = min(slip / (slide * (1.0 + p.spin_gain)), dt)
        loss = slide * sliding
        moved_x = (start_x - 0.5 * loss * slip_x) * sliding
        moved_y = (start_y - 0.5 * loss * slip_y) * sliding
        ball.vx -= loss * slip_x
        ball.vy -= loss * slip_y
        ball.spin_x += p.spin_gain * loss * slip_x
        ball.spin_y += p.spin_gain * loss * slip_y
        left = dt - sliding
    if left > 0.0:
        speed = hypot(ball.vx, ball.vy)
        if speed > 0.0:
            rolling = min(left, speed / roll)
            mean = (speed - 0.5 * roll * rolling) * rolling / speed
            moved_x += ball.vx * mean
            moved_y += ball.vy * mean
            keep = (speed - roll * rolling) / speed
            ball.vx *= keep
            ball.vy *= keep
        ball.spin_x = ball.vx
        ball.spin_y = ball.vy
        if abs(ball.vx) < stop and hypot(ball.vx, ball.vy) < stop:
            ball.vx = ball.vy = ball.spin_x = ball.spin_y = 0.0
    ball.move_x = moved_x / dt
    ball.move_y = moved_y / dt
