"""Trials against a goalkeeper of a fitted population instead of our own."""

from __future__ import annotations

from dataclasses import replace
from math import cos, exp, log, sin, sqrt
from typing import NamedTuple

import numpy as np

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.shots.collect.balanced import held_by, keeper_start, moved
from robobt.shots.collect.plan import Attempt
from robobt.shots.data.schema import AS_RECORDED
from robobt.shots.keepers.population import Population, Traits
from robobt.skills.aim.raters.goal_line import POST_GAP
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point, direction, distance
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

AT_KICK = 0.8
"""Share of the trials that begin with the kick, everybody in the state that recorded shots show."""

LIKE_RECORDED = 0.75
"""Share of these whose ball lies about as far off the straight way out of the goal as recorded balls."""

_ROBOT_SPEED = 5.0
"""Top speed of the robot itself, which leaves it to the goalkeeper how fast it drives [m/s]."""

_ASIDE_DISTRIBUTION = (0.4, 0.1)
"""Mean and standard deviation of the recorded goalkeepers' distance from the line of the shot [m]."""
_FARTHEST_ASIDE = 0.8
_TOWARDS = (0.55, 0.28)
"""Mean and standard deviation of their speed towards that line [m/s]."""
_DRIFT_SPREAD = 0.03
"""Standard deviation of their speed along it [m/s]."""
_BEARING = 0.25
"""Standard deviation of the recorded balls' bearing off the straight way out of the goal [rad]."""
_INWARD = 0.95
"""Share of them that are on the side of the line where most of the goal is."""
_SHOOTER_SPEEDS = (0.0, 0.3)
"""How fast the shooter drives at the kick [m/s]: RoboBulls' robots creep forward."""
_KICK_TOLERANCES = (0.005, 0.0175)
"""Angle by which a kick may be off [rad]; RoboBulls' is 1 degree."""
_IMMEDIATE_KICK_TOLERANCE = 0.05
_BALL_AREA_GAP = 0.15
"""Gap between the ball and the defence area [m]."""


def against_fitted(attempt: Attempt, population: Population) -> Attempt:
    """Return the trial with its goalkeeper, and the speed of its kick, drawn from a population.

    Most trials begin with the kick: the shooter points at its target, and the goalkeeper is
    about as far beside the line and as fast on its way as in the recorded shots, or evenly
    farther or nearer. So what a shot is worth is right for goalkeepers as they are met, and not
    for one that has had any time to get into its place. In the others the attacker turns first,
    as slowly as RoboBulls' robots or up to three times as fast. What is drawn follows from the
    trial's seed. The goalkeeper is yellow's first robot.
    """
    rng = np.random.default_rng([attempt.seed, 3])
    traits = population.sample(rng)
    scenario = attempt.scenario
    (shooter, *_), (keeper, *others) = scenario.robots.blue, scenario.robots.yellow
    told = {name: getattr(traits, name) for name in ("max_speed", "acceleration", "braking", "offset")}
    keeper = keeper.model_copy(
        update={"play": "fitted_goalkeeper", "params": told, "limits": robot_limits(traits)}
    )
    params: dict[str, object] = {**shooter.params, "shot_speed": traits.kick_speed}
    velocities: dict[RobotId, Point] = {}
    variant = attempt.labels["variant"]
    if shooter.play == "take_shot":
        params["tolerance"] = float(rng.uniform(*_KICK_TOLERANCES))
        params["max_turn"] = ROBOBULLS_LIMITS.max_turn * exp(rng.uniform(0.0, log(3.0)))
        if rng.random() < AT_KICK:
            ball = (float(str(params["place_x"])), float(str(params["place_y"])))
            variant = "at_kick"
            if rng.random() < LIKE_RECORDED:
                variant = AS_RECORDED
                ball = _swung(scenario.field, ball, float(rng.normal(0.0, _BEARING)))
            scene = _at_kick(scenario.field, ball, traits, rng)
            (_, target_y), (place_x, place_y) = scene.target, ball
            params |= {"target_y": target_y, "place_x": place_x, "place_y": place_y}
            params["tolerance"] = _IMMEDIATE_KICK_TOLERANCE
            shooter = moved(shooter, scene.shooter, scene.heading)
            keeper = moved(keeper, scene.keeper, direction(scene.keeper, ball), flip=True)
            velocities = {
                RobotId(Team.BLUE, shooter.number): scene.shooter_velocity,
                RobotId(Team.YELLOW, keeper.number): scene.keeper_velocity,
            }
    shooter = shooter.model_copy(update={"params": params})
    robots = scenario.robots.model_copy(update={"blue": (shooter,), "yellow": (keeper, *others)})
    labels = {**attempt.labels, "goalkeeper_speed": 1.0, "goalkeeper": "fitted", "variant": variant}
    changed = scenario.model_copy(update={"robots": robots})
    return replace(attempt, scenario=changed, labels=labels, delay=traits.delay, velocities=velocities)


def robot_limits(traits: Traits) -> RobotLimits:
    """Return the limits of a goalkeeper's robot: as quick to brake as to speed up, in every direction."""
    rate = traits.acceleration
    return RobotLimits(
        max_speed=_ROBOT_SPEED, acceleration=rate, braking=rate, side_acceleration=rate, side_braking=rate
    )


class _Scene(NamedTuple):
    target: Point
    shooter: Point
    heading: float
    shooter_velocity: Point
    keeper: Point
    keeper_velocity: Point


def _swung(field: FieldGeometry, ball: Point, bearing: float) -> Point:
    """Return a ball as far from the goal as ``ball``, or outside the defence area, at another bearing."""
    reach = distance(ball, field.their_goal)
    x, side = field.half_length - reach * cos(bearing), field.half_width - _BALL_AREA_GAP
    y = min(side, max(-side, reach * sin(bearing)))
    return (min(x, field.half_length - field.defense_depth - _BALL_AREA_GAP), y)


def _at_kick(field: FieldGeometry, ball: Point, traits: Traits, rng: np.random.Generator) -> _Scene:
    """Draw the scene of a kick from where the ball is."""
    reach = field.goal_width / 2.0 - POST_GAP
    # Attack Main aims beside the goalkeeper, so more often near a post than at the middle.
    target_y = float(rng.choice((-1.0, 1.0))) * reach * sqrt(rng.random())
    target = (field.half_length, target_y)
    aim = direction(ball, target)
    aside = rng.normal(*_ASIDE_DISTRIBUTION) if rng.random() < 0.5 else rng.uniform(0.0, _FARTHEST_ASIDE)
    inward = -np.sign(target_y) if rng.random() < _INWARD else np.sign(target_y)
    # Most stand well back, a few far out.
    keeper = keeper_start(field, ball, target, float(inward * abs(aside)), float(rng.random()) ** 2)
    (x, y), (keeper_x, keeper_y) = ball, keeper
    across = (keeper_y - y) * cos(aim) - (keeper_x - x) * sin(aim)
    # No goalkeeper is much faster towards the line than it can stop there.
    most = sqrt(2.0 * traits.braking * abs(across)) + 0.1
    towards = -float(np.sign(across)) * min(float(rng.normal(*_TOWARDS)), most)
    along = float(rng.normal(0.0, _DRIFT_SPREAD))
    heading = aim + float(np.sign(across)) * traits.kick_error
    creep = float(rng.uniform(*_SHOOTER_SPEEDS))
    return _Scene(
        target,
        held_by(ball, heading),
        heading,
        (creep * cos(heading), creep * sin(heading)),
        keeper,
        (along * cos(aim) - towards * sin(aim), along * sin(aim) + towards * cos(aim)),
    )
