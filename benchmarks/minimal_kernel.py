"""The least physics that still plays: what arenas would cost if they did no more, as a yardstick of speed.

Robots with limited acceleration are discs with a flat front, whose mouth holds and kicks the ball; the ball
slides, then rolls; there are outer walls and goals. Positions are corrected once a step: there are no solver,
materials, hulls, flight, delays, wheels or random numbers. Nothing else uses it.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from robobt.world import DIVISION_B
from robobt.world.limits import DEFAULT_LIMITS
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

FloatArray = NDArray[np.float64]

_SPEED, _TURN, _TURN_ACCELERATION = 3.0, 10.0, DEFAULT_LIMITS.turn_acceleration
_ACCELERATION, _BRAKING = DEFAULT_LIMITS.acceleration, DEFAULT_LIMITS.braking
_SLIDE, _ROLL, _ROLLS_FROM = 3.0, 0.26, 5.0 / 7.0
"""Decelerations of the ball [m/s^2], and the share of a kick's speed from which it rolls."""
_PLACE, _DEPTH, _HALF_MOUTH, _PULL = 0.075 + BALL_RADIUS, 0.02, 0.04, 4.0
"""Where the mouth holds the ball [m], how deep and wide it is [m], and how strongly it pulls [m/s^2]."""
_FRONT = 0.075
_HALF_X, _HALF_Y = DIVISION_B.half_length + 0.3, DIVISION_B.half_width + 0.3
_LINE, _HALF_GOAL, _GOAL_DEPTH = DIVISION_B.half_length, DIVISION_B.goal_width / 2.0, DIVISION_B.goal_depth


class MinimalArenas:
    """``n`` arenas with R robots each, to be used as :class:`~robobt.sim.Arenas`.

    Attributes:
        robots: (n, R, 6) x, y, heading, vx, vy, omega.
        balls: (n, 4) x, y, vx, vy.
        contact: (n, R) whether the ball is in the mouth.
        goals: (n,) how often a goal was scored.
    """

    def __init__(self, n: int, robots: int, steps: int, dt: float) -> None:
        self.robots, self.balls = np.zeros((n, robots, 6)), np.zeros((n, 4))
        self.contact = np.zeros((n, robots), dtype=np.bool_)
        self.goals = np.zeros(n, dtype=np.int64)
        self._rolls_below = np.zeros(n)
        self._steps, self._dt = steps, dt

    def place(self, robots: FloatArray, balls: FloatArray) -> None:
        """Put robots (n, R, 3) and balls (n, 4) somewhere."""
        self.robots[:] = 0.0
        self.robots[..., :3] = robots
        self.balls[:] = balls
        self._rolls_below[:] = np.inf
        self.contact[:] = False

    def step(self, commands: FloatArray) -> None:
        """Advance one control period with ``commands`` (n, R, 7), as for the arenas."""
        state = (self.robots, self.balls, self._rolls_below, self.contact, self.goals)
        _tick(*state, commands, self._steps, self._dt)


@njit(cache=True)
def _tick(
    robots: FloatArray,
    balls: FloatArray,
    rolls_below: FloatArray,
    contact: NDArray[np.bool_],
    goals: NDArray[np.int64],
    commands: FloatArray,
    steps: int,
    dt: float,
) -> None:
    count = robots.shape[1]
    for a in range(len(robots)):
        x, y, vx, vy = balls[a, 0], balls[a, 1], balls[a, 2], balls[a, 3]
        slides_to, contact[a] = rolls_below[a], False
        for step in range(steps):
            held = False
            for i in range(count):
                robot, told = robots[a, i], commands[a, i]
                c, s = cos(robot[2]), sin(robot[2])
                dx = c * told[0] - s * told[1] - robot[3]
                dy = s * told[0] + c * told[1] - robot[4]
                most = (_BRAKING if dx * robot[3] + dy * robot[4] < 0.0 else _ACCELERATION) * dt
                change = hypot(dx, dy)
                share = most / change if change > most else 1.0
                robot[3] += share * dx
                robot[4] += share * dy
                turn = min(max(told[2], -_TURN), _TURN) - robot[5]
                robot[5] += min(max(turn, -_TURN_ACCELERATION * dt), _TURN_ACCELERATION * dt)
                px, py = x - robot[0], y - robot[1]
                if px * px + py * py < (_PLACE + _DEPTH) ** 2:
                    ahead, aside = c * px + s * py, c * py - s * px
                    if ahead > 0.0 and abs(aside) < _HALF_MOUTH:
                        contact[a, i] = contact[a, i] or step == steps - 1
                        if told[3] > 0.0:
                            vx, vy, slides_to = c * told[3], s * told[3], _ROLLS_FROM * told[3]
                        elif told[5] > 0.0:
                            held = True
                            back, off = robot[5] * ahead, (_PLACE - ahead) / 0.05
                            wx = robot[3] - s * back + c * off + s * aside / 0.05 - vx
                            wy = robot[4] + c * back + s * off - c * aside / 0.05 - vy
                            want = hypot(wx, wy)
                            share = _PULL * dt / want if want > _PULL * dt else 1.0
                            vx += share * wx
                            vy += share * wy
            speed = hypot(vx, vy)
            if speed > 0.0 and not held:
                loss = (_SLIDE if speed > slides_to else _ROLL) * dt
                share = max(0.0, 1.0 - loss / speed)
                vx *= share
                vy *= share
            x += vx * dt
            y += vy * dt
            for i in range(count):
                one = robots[a, i]
                one[0] = min(max(one[0] + one[3] * dt, -_HALF_X), _HALF_X)
                one[1] = min(max(one[1] + one[4] * dt, -_HALF_Y), _HALF_Y)
                one[2] += one[5] * dt
            for i in range(count):
                one = robots[a, i]
                for j in range(i + 1, count):
                    other = robots[a, j]
                    px, py = other[0] - one[0], other[1] - one[1]
                    square = px * px + py * py
                    if 0.0 < square < 4.0 * ROBOT_RADIUS * ROBOT_RADIUS:
                        away = sqrt(square)
                        px, py, into = px / away, py / away, ROBOT_RADIUS - 0.5 * away
                        closing = 0.5 * min(0.0, (other[3] - one[3]) * px + (other[4] - one[4]) * py)
                        for k, along in ((0, px), (1, py)):
                            one[k] -= into * along
                            other[k] += into * along
                            one[3 + k] += closing * along
                            other[3 + k] -= closing * along
                px, py = x - one[0], y - one[1]
                square = px * px + py * py
                if 0.0 < square < (ROBOT_RADIUS + BALL_RADIUS) ** 2:
                    away = sqrt(square)
                    px, py, into = px / away, py / away, ROBOT_RADIUS + BALL_RADIUS - away
                    ahead = cos(one[2]) * px + sin(one[2]) * py
                    if ahead > 0.0:  # the front is flat
                        into = min(into, _FRONT + BALL_RADIUS - ahead * away)
                    if into > 0.0:
                        closing = 1.5 * min(0.0, (vx - one[3]) * px + (vy - one[4]) * py)
                        x, y = x + into * px, y + into * py
                        vx, vy = vx - closing * px, vy - closing * py
            half_x, half_y = _HALF_X, _HALF_Y
            if abs(x) > _LINE and abs(y) < _HALF_GOAL:
                goals[a] += x * vx > 0.0 and abs(x) - abs(vx) * dt <= _LINE
                half_x, half_y = min(half_x, _LINE + _GOAL_DEPTH), _HALF_GOAL
            if abs(x) > half_x:
                x, vx = min(max(x, -half_x), half_x), -0.5 * vx
            if abs(y) > half_y:
                y, vy = min(max(y, -half_y), half_y), -0.5 * vy
        balls[a, 0], balls[a, 1], balls[a, 2], balls[a, 3] = x, y, vx, vy
        rolls_below[a] = slides_to
        for i in range(count):
            heading = robots[a, i, 2]
            robots[a, i, 2] = heading - 2.0 * pi * np.floor((heading + pi) / (2.0 * pi))
