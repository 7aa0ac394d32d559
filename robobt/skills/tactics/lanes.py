"""The compiled chance that a pass arrives, from the ball's position over time and the robots' reach."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, hypot, inf, sqrt

from robobt.skills.tactics_settings import AppliedTactics
from robobt.world import ball_model
from robobt.world.ball_model import time_for
from robobt.world.compiled import compiled, compiled_merged
from robobt.world.records import Mover
from robobt.world.state import TOUCH_DISTANCE

_CHIP_SAMPLES = 4

_LANE_SAMPLES = 8


@compiled_merged
def kick_speed(length: float, arrival: float, tactics: AppliedTactics) -> float:
    """Return the kick speed that leaves a ball the speed ``arrival`` after ``length`` [m/s, m]."""
    speed = ball_model.kick_speed(length, arrival, tactics.slide, tactics.roll, tactics.share)
    return min(tactics.fastest_pass, max(tactics.slowest_pass, speed))


@compiled_merged
def flight_time(length: float, speed: float, tactics: AppliedTactics) -> float:
    """Return when a ball kicked at ``speed`` has covered ``length`` [s]; 10 if it comes to rest before."""
    time = time_for(length, speed, tactics.share * speed, tactics.slide, tactics.roll)
    return time if time < inf else 10.0


@compiled_merged
def time_to_pass(robot: Mover, x: float, y: float, tactics: AppliedTactics) -> float:
    """Return when a robot can touch a ball at (x, y), passing at any speed [s]."""
    px = robot.x + tactics.reaction * robot.vx
    py = robot.y + tactics.reaction * robot.vy
    dx, dy = x - px, y - py
    gap = hypot(dx, dy)
    if gap <= TOUCH_DISTANCE:
        return 0.0
    towards = (dx * robot.vx + dy * robot.vy) / gap
    gap -= TOUCH_DISTANCE
    acceleration = robot.acceleration
    needed = (sqrt(towards * towards + 2.0 * acceleration * gap) - towards) / acceleration
    return float(max(needed, gap / robot.max_speed) + tactics.reaction)


@compiled_merged
def cannot_pass_by(robot: Mover, x: float, y: float, time: float, tactics: AppliedTactics) -> bool:
    """Return whether :func:`time_to_pass` is certainly above ``time`` [s], without computing roots."""
    free = max(0.0, time - tactics.reaction)
    fastest = abs(robot.vx) + abs(robot.vy) + 0.5 * robot.acceleration * free
    reach = TOUCH_DISTANCE + min(robot.max_speed, fastest) * free
    dx, dy = x - robot.x - tactics.reaction * robot.vx, y - robot.y - tactics.reaction * robot.vy
    return bool(dx * dx + dy * dy > reach * reach + 1e-6)


@compiled
def lane_margin(
    ox: float,
    oy: float,
    x: float,
    y: float,
    speed: float,
    delay: float,
    robots: Sequence[Mover],
    tactics: AppliedTactics,
) -> float:
    """Return the least head start of a ball over all robots on its way from (ox, oy) to (x, y) [s].

    ``delay`` is the time until the kick [s], in which the robots may move as well.
    """
    dx, dy = x - ox, y - oy
    length = hypot(dx, dy)
    least = 10.0
    # No robot may stand in the lane between the points either.
    for robot in robots:
        along = ((robot.x - ox) * dx + (robot.y - oy) * dy) / max(length, 1e-6)
        if 0.0 < along < length:
            aside = abs((robot.x - ox) * dy - (robot.y - oy) * dx) / max(length, 1e-6)
            if aside < TOUCH_DISTANCE + 0.03:
                least = min(least, -0.3)
    # From the end, where robots have the most time, so that most others need not be computed.
    for k in range(_LANE_SAMPLES, 0, -1):
        share = k / _LANE_SAMPLES
        when = delay + flight_time(share * length, speed, tactics)
        px, py = ox + share * dx, oy + share * dy
        for robot in robots:
            if cannot_pass_by(robot, px, py, least + when, tactics):
                continue
            margin = time_to_pass(robot, px, py, tactics) - when
            if margin < least:
                least = margin
    return least


@compiled_merged
def sigmoid(x: float) -> float:
    """Return the logistic function."""
    if x < -30.0:
        return 0.0
    return 1.0 / (1.0 + exp(-x))


@compiled
def arrive_chance(
    ox: float,
    oy: float,
    x: float,
    y: float,
    speed: float,
    delay: float,
    opponents: Sequence[Mover],
    mates: Sequence[Mover],
    skip: int,
    tactics: AppliedTactics,
) -> float:
    """Return the chance that a pass kicked at ``speed`` after ``delay`` gets from (ox, oy) to (x, y).

    Team-mates that stand in the lane block it; number ``skip`` of ``mates`` is the receiver.
    """
    chance = sigmoid(lane_margin(ox, oy, x, y, speed, delay, opponents, tactics) / tactics.margin)
    dx, dy = x - ox, y - oy
    length = max(hypot(dx, dy), 1e-6)
    for i, mate in enumerate(mates):
        if i == skip:
            continue
        along = ((mate.x - ox) * dx + (mate.y - oy) * dy) / length
        if TOUCH_DISTANCE < along < length:
            aside = abs((mate.x - ox) * dy - (mate.y - oy) * dx) / length
            if aside < TOUCH_DISTANCE + 0.02:
                chance *= 0.1
    return chance


@compiled_merged
def chip_speed(length: float, tactics: AppliedTactics) -> float:
    """Return the speed of a chip that rolls after ``length`` [m/s, m]."""
    return float(tactics.chip_speed * sqrt(length))


@compiled_merged
def chip_time(length: float, tactics: AppliedTactics) -> float:
    """Return the duration of a chip that rolls after a length [s]."""
    return float(tactics.chip_rolls * sqrt(length))


@compiled_merged
def chip_chance(
    ox: float,
    oy: float,
    x: float,
    y: float,
    delay: float,
    opponents: Sequence[Mover],
    mates: Sequence[Mover],
    skip: int,
    tactics: AppliedTactics,
) -> float:
    """Return the chance that a pass chipped after ``delay`` gets from (ox, oy) to (x, y), where it rolls.

    No robot can stop it in the air; number ``skip`` of ``mates`` is the receiver.
    """
    dx, dy = x - ox, y - oy
    length = max(hypot(dx, dy), 1e-6)
    ux, uy = dx / length, dy / length
    lands = tactics.chip_lands_at * length
    root = sqrt(length)
    least = 10.0
    for opponent in opponents:
        if _in_chips_way(opponent.x - ox, opponent.y - oy, ux, uy, 0.15, tactics):
            return 0.0
        for k in range(_CHIP_SAMPLES + 1):
            share = k / _CHIP_SAMPLES
            way = lands - tactics.chip_falls + share * (length - lands + tactics.chip_falls)
            when = delay + root * (tactics.chip_lands + share * (tactics.chip_rolls - tactics.chip_lands))
            px, py = ox + way * ux, oy + way * uy
            if not cannot_pass_by(opponent, px, py, least + when, tactics):
                least = min(least, time_to_pass(opponent, px, py, tactics) - when)
    chance = tactics.chip_taken * sigmoid(least / tactics.margin)
    for i, mate in enumerate(mates):
        if i == skip:
            continue
        mx, my = mate.x - ox, mate.y - oy
        along, aside = mx * ux + my * uy, abs(mx * uy - my * ux)
        down = lands - tactics.chip_falls - TOUCH_DISTANCE < along < length and aside < TOUCH_DISTANCE + 0.02
        if down or _in_chips_way(mx, my, ux, uy, 0.02, tactics):
            chance *= 0.1
    return chance


@compiled_merged
def _in_chips_way(dx: float, dy: float, ux: float, uy: float, gap: float, tactics: AppliedTactics) -> bool:
    """Return whether a robot at (dx, dy) from the kick stands where a chip along (ux, uy) is still low."""
    along = dx * ux + dy * uy
    return (
        0.0 < along < tactics.chip_rises + TOUCH_DISTANCE + gap
        and abs(dx * uy - dy * ux) < TOUCH_DISTANCE + gap
    )
