"""Starts of Shoot-Towards-Goal."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

import numpy as np

from robobt.learning.envs.settings import Span
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.starts import GIVE_UP, MOUTH_GAP, START_COLUMNS, start_parts, velocities
from robobt.learning.envs.task import FloatArray
from robobt.sim.arenas import Arenas
from robobt.sim.records import COMMAND, RecordArray, size
from robobt.world.records import BALL
from robobt.world.state import BALL_RADIUS

_POINTS = 17
"""Number of places across the mouth for which the ball's settled position is computed."""


def shoot_starts(settings: ShootSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts (count, 10) of Shoot, the ball where the dribbler holds it after the warm-up."""
    starts, field = settings.starts, settings.field
    # The margins are those of the authors' code.
    x = starts.robot_x or (0.3, field.half_length - field.defense_depth - 0.3)
    y = starts.robot_y or (-field.half_width + 0.1, field.half_width - 0.1)
    rows = np.zeros((count, len(START_COLUMNS)))
    robots, ball, _ = start_parts(rows, 1)
    robot = robots[:, 0]
    robot["x"] = rng.uniform(*x, count)
    robot["y"] = rng.uniform(*y, count)
    robot["heading"] = rng.uniform(*starts.heading, count)
    robot["omega"] = rng.uniform(*starts.robot_turn, count)
    aside = rng.uniform(*starts.ball_aside, count)
    ahead, across = _held_ball(settings)
    grid = np.linspace(*starts.ball_aside, len(ahead))
    dx, dy = np.interp(aside, grid, ahead), np.interp(aside, grid, across)
    cos, sin = np.cos(robot["heading"]), np.sin(robot["heading"])
    ball["x"] = robot["x"] + cos * dx - sin * dy
    ball["y"] = robot["y"] + sin * dx + cos * dy
    # The ball turns with the robot.
    ball["vx"] = -robot["omega"] * (ball["y"] - robot["y"])
    ball["vy"] = robot["omega"] * (ball["x"] - robot["x"])
    if starts.robot_speed != (0.0, 0.0):
        robot["vx"], robot["vy"] = _drifts(settings, rng, robot, x, y)
        ball["vx"] += robot["vx"]
        ball["vy"] += robot["vy"]
    return rows


def _drifts(
    settings: ShootSettings, rng: np.random.Generator, robots: RecordArray, x: Span, y: Span
) -> FloatArray:
    """Draw velocities along x and y, (2, n), from which the robots come to rest inside the ranges."""
    limits = settings.robot_limits
    braking = min(limits.braking, limits.lateral_braking)
    if settings.gentle:
        braking = min(braking * settings.randomisation.acceleration[0], limits.hold_acceleration * sqrt(0.5))
    # A late robot drives on at its speed, and a lag costs as much way.
    lag = max(limits.lag, limits.side_lag) + settings.randomisation.lag[1]
    late = settings.longest_delay + lag
    (least_x, most_x), (least_y, most_y) = x, y
    drifts = np.zeros((2, len(robots)))
    open_ = np.arange(len(robots))
    for _ in range(GIVE_UP):
        vx, vy = velocities(rng, settings.starts.robot_speed, len(open_))
        drifts[:, open_] = vx, vy
        speed = np.hypot(vx, vy)
        rest_x = robots["x"][open_] + vx * late + vx * speed / (2.0 * braking)
        rest_y = robots["y"][open_] + vy * late + vy * speed / (2.0 * braking)
        inside = (rest_x >= least_x) & (rest_x <= most_x) & (rest_y >= least_y) & (rest_y <= most_y)
        open_ = open_[~inside]
        if len(open_) == 0:
            return drifts
    raise ValueError("starts: robots of that speed do not stop inside the ranges")


@lru_cache(maxsize=16)
def _held_ball(settings: ShootSettings) -> tuple[FloatArray, FloatArray]:
    """Return the place of a ball in the mouth after the warm-up: ahead of and beside the robot's centre [m].

    At rest this depends only on the initial place across the mouth, so all starts use the warm-up of a few
    places, evenly spread over ``ball_aside``.
    """
    points = np.linspace(*settings.starts.ball_aside, _POINTS)
    simulator = settings.stepped_simulator
    arenas = Arenas(settings.field, [None], simulator, settings.period, len(points))
    ahead = simulator.body.face + BALL_RADIUS + MOUTH_GAP
    balls = np.zeros(len(points), BALL)
    balls["x"], balls["y"] = ahead, points
    arenas.place(np.zeros((len(points), 1, 3)), balls.view(np.float64))
    commands = np.zeros((len(points), 1, size(COMMAND)))
    commands.view(COMMAND)["dribbler"] = float(settings.action.dribbler)
    for _ in range(settings.starts.warm_up):
        arenas.step(commands)
    held = arenas.balls.view(BALL)[:, 0]
    return held["x"].copy(), held["y"].copy()
