"""Shots spread evenly over range, angle and goalkeeper offset, at any point of the goal line.

An attacker that chooses its shots never takes difficult ones. Here trial i is the i-th point of a
low-discrepancy sequence over all scenes, so that any number of consecutive trials covers them evenly,
including close targets and goalkeepers on the line.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import atan2, cos, hypot, pi, sin
from typing import Literal, NamedTuple

import numpy as np

from robobt.match.runner import trial_seed
from robobt.match.scenario.placing import HELD_DISTANCE
from robobt.match.scenario.robots import Robots, RobotSetup
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.match.scenario.starts import RobotStart
from robobt.shots.collect.plan import CLOSE_RANGE, ROBOBULLS_SHOT_SPEED, Attempt, CollectionSettings
from robobt.skills.aim.raters.goal_line import POST_GAP
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point, direction, distance
from robobt.world.rules import in_their_defense_area
from robobt.world.state import ROBOT_RADIUS

FARTHEST = 4.8
"""Distance from ball to goal centre [m]; the paper's shots reach to 4.6 m."""

WIDEST = 1.3
"""Bearing of the ball off the straight way out of the goal [rad]."""

OFFSET = 0.7
"""Largest distance at the start of a goalkeeper from the line of a shot taken at once [m]."""

ROBOBULLS_GOALKEEPER = "paper/robobulls.py:robobulls_goalkeeper"
"""The play of RoboBulls' goalkeeper; a clone of the repository has it."""

_AREA_EDGE_GAP = 0.15
_LEAST_ROBOT_GAP = 0.35
_LARGEST_TURN = 0.8
_FACING_SHARE = 0.6
"""Share of the standing attackers that need not turn first."""
_OUT = (ROBOT_RADIUS, 0.7)
_TRAVEL = (0.3, 0.7)
_DRIBBLE_SPEEDS = (1.0, 2.0)
_BALANCED_TOLERANCES = (0.005, 0.03)


def balanced_attempt(settings: CollectionSettings, trial: int) -> Attempt:
    """Return the set-up of one trial; it depends on the settings and the trial's number alone."""
    seed = trial_seed(settings.seed, trial)
    rng = np.random.default_rng([seed, 1])
    kinds: Sequence[Literal["motion", "still"]] = (
        ("motion", "still") if settings.scenario == "both" else (settings.scenario,)
    )
    kind = kinds[trial % len(kinds)]
    even = _even_point(settings.seed, trial // len(kinds))
    variant = "still" if kind == "still" else ("mid_range", "close_range")[trial // len(kinds) % 2]
    base = _base(kind, _opponents(settings, trial))
    field = base.field
    ball = _ball(field, variant, even.range, even.bearing)
    usable = field.goal_width / 2.0 - POST_GAP
    target = (field.half_length, (2.0 * even.target - 1.0) * usable)
    start, turn, at_once = ball, _LARGEST_TURN * (2.0 * even.turn - 1.0), rng.random() < _FACING_SHARE
    if kind == "motion":
        start = _before(field, ball, rng)
        heading = direction(start, ball) + 0.3 * turn
    else:
        heading = direction(ball, target) + (0.02 * turn if at_once else turn)
    # While the attacker turns or comes, the goalkeeper moves to the line; it starts the farther off.
    widest = OFFSET if kind == "still" and at_once else 2.0 * OFFSET
    keeper = keeper_start(field, ball, target, widest * (2.0 * even.beside - 1.0), even.out)
    shooter = held_by(start, heading)
    speed = (0.5, 1.0)[int(rng.integers(2))]
    (_, target_y), (place_x, place_y) = target, ball
    params: dict[str, float] = {
        "target_y": target_y,
        "place_x": place_x,
        "place_y": place_y,
        "dribble_speed": float(rng.uniform(*_DRIBBLE_SPEEDS)),
        "tolerance": float(rng.uniform(*_BALANCED_TOLERANCES)),
        "shot_speed": ROBOBULLS_SHOT_SPEED,
    }
    (blue, *_), (goalkeeper, *others) = base.robots.blue, base.robots.yellow
    taken = [shooter, start, keeper]
    faced = "half_speed" if speed < 1.0 else "full_speed"
    if settings.style == "robobulls":
        faced = settings.style
        goalkeeper = goalkeeper.model_copy(update={"play": ROBOBULLS_GOALKEEPER})
    opponents = [moved(goalkeeper, keeper, direction(keeper, start), flip=True, speed=speed)]
    for setup in others:
        place = _blocker(field, ball, target, taken, rng)
        taken.append(place)
        opponents.append(moved(setup, place, direction(place, start), flip=True))
    robots = base.robots.model_copy(
        update={
            "blue": (moved(blue, shooter, heading).model_copy(update={"params": params}),),
            "yellow": tuple(opponents),
        }
    )
    labels = {
        "scenario": kind,
        "variant": variant,
        "seed": settings.seed,
        "tolerance": 0.0,
        "goalkeeper_speed": speed,
        "goalkeeper": faced,
    }
    return Attempt(base.model_copy(update={"robots": robots}), seed, labels)


def _opponents(settings: CollectionSettings, trial: int) -> int:
    """Return how many opponents: the goalkeeper alone in every other pair of trials, else up to the most."""
    more = settings.opponents - 1
    group = trial // 4
    return 1 if more == 0 or group % 2 == 0 else 2 + group // 2 % more


class _Even(NamedTuple):
    """What a trial is to be even in, each 0 to 1.

    Attributes:
        range, bearing: of the ball.
        beside, out: where the goalkeeper starts.
        target: along the goal line.
        turn: of the attacker.
    """

    range: float
    bearing: float
    beside: float
    out: float
    target: float
    turn: float


_DIMENSIONS = len(_Even._fields)


@lru_cache(maxsize=8)
def _sequence(seed: int) -> tuple[FloatArray, FloatArray]:
    # The root of x^(d + 1) = x + 1, whose powers make the most even additive sequence known.
    root = 1.5
    for _ in range(40):
        root = (1.0 + root) ** (1.0 / (_DIMENSIONS + 1))
    steps = root ** -np.arange(1.0, _DIMENSIONS + 1)
    return np.random.default_rng([seed, 2]).random(_DIMENSIONS), steps


def _even_point(seed: int, index: int) -> _Even:
    """Return point ``index`` of a sequence that fills the unit cube evenly.

    Source: Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
    """
    start, steps = _sequence(seed)
    return _Even(*((start + (index + 1) * steps) % 1.0).tolist())


@lru_cache(maxsize=16)
def _base(kind: str, opponents: int) -> Scenario:
    scenario = load_scenario(f"collect_shots_{kind}")
    keeper, *_ = scenario.robots.yellow
    defenders = [
        RobotSetup(
            number=number,
            play="defender",
            params={"place": number - 1, "size": opponents - 1},
            start=RobotStart(position=(-2.0, -2.0 + number * 0.5), heading=0.0),
        )
        for number in range(1, opponents)
    ]
    robots = Robots(blue=scenario.robots.blue, yellow=(keeper, *defenders))
    return scenario.model_copy(update={"robots": robots})


def _ball(field: FieldGeometry, variant: str, range_: float, angle: float) -> Point:
    """Return where the ball is to be kicked: even in range and bearing, outside the defence area."""
    bearing = WIDEST * (2.0 * angle - 1.0)
    away, aside = cos(bearing), abs(sin(bearing))
    most = min(FARTHEST, (field.half_width - 0.2) / aside if aside > 0.0 else FARTHEST)
    depth = field.defense_depth + _AREA_EDGE_GAP
    side = field.defense_width / 2.0 + _AREA_EDGE_GAP
    least = min(depth / away if away > 0.0 else depth, side / aside if aside > 0.0 else FARTHEST)
    least = min(least, most)
    if variant == "mid_range":
        least = min(max(least, CLOSE_RANGE), most)
    elif variant == "close_range":
        most = max(least, min(most, CLOSE_RANGE))
    reach = least + range_ * (most - least)
    return (field.half_length - reach * away, reach * sin(bearing))


def keeper_start(field: FieldGeometry, ball: Point, target: Point, offset: float, out: float) -> Point:
    """Place a goalkeeper beside the line of the shot by ``offset``, ``out`` of the way out of its goal."""
    (least, most), (ball_x, ball_y) = _OUT, ball
    line = field.half_length - (least + out * (most - least))
    aim = direction(ball, target)
    along = (line - ball_x) / cos(aim) if cos(aim) > 0.05 else distance(ball, target)
    x = ball_x + along * cos(aim) - offset * sin(aim)
    y = ball_y + along * sin(aim) + offset * cos(aim)
    reach = field.defense_width / 2.0 - ROBOT_RADIUS
    x = min(field.half_length - 0.02, max(field.half_length - field.defense_depth, x))
    y = min(reach, max(-reach, y))
    gap = hypot(x - ball_x, y - ball_y)
    if gap < _LEAST_ROBOT_GAP:
        # Straight towards the goal, out of the ball's way.
        home = direction((x, y), field.their_goal)
        x, y = x + (_LEAST_ROBOT_GAP - gap) * cos(home), y + (_LEAST_ROBOT_GAP - gap) * sin(home)
    return (x, y)


def held_by(ball: Point, heading: float) -> Point:
    """Return where a robot stands that looks along ``heading`` with the ball in its mouth."""
    x, y = ball
    return (x - HELD_DISTANCE * cos(heading), y - HELD_DISTANCE * sin(heading))


def _before(field: FieldGeometry, ball: Point, rng: np.random.Generator) -> Point:
    """Return where the attacker comes from: some way farther out, from any side of that."""
    outward = direction(field.their_goal, ball)
    travel = float(rng.uniform(*_TRAVEL))
    bearing = outward + float(rng.uniform(-0.5 * pi, 0.5 * pi))
    edge = field.half_width - 0.2
    x, y = ball
    y = min(edge, max(-edge, y + travel * sin(bearing)))
    return (min(field.half_length - 0.3, x + travel * cos(bearing)), y)


def _blocker(
    field: FieldGeometry, ball: Point, target: Point, taken: list[Point], rng: np.random.Generator
) -> Point:
    """Return a place for one more opponent, half of them near the line of the shot."""
    (ball_x, ball_y), (target_x, target_y) = ball, target
    while True:
        share, aside = float(rng.uniform(0.1, 0.95)), float(rng.normal(0.0, 0.4))
        x = ball_x + share * (target_x - ball_x)
        y = ball_y + share * (target_y - ball_y)
        if rng.random() < 0.5:
            aim = direction(ball, target)
            x, y = x - aside * sin(aim), y + aside * cos(aim)
        else:
            x = float(rng.uniform(0.0, field.half_length - field.defense_depth))
            y = float(rng.uniform(-field.half_width + 0.2, field.half_width - 0.2))
        inside = in_their_defense_area(field, x, y, ROBOT_RADIUS)
        on_field = x < field.half_length - 0.1 and abs(y) < field.half_width - 0.1
        if on_field and not inside and all(hypot(x - a, y - b) > 0.25 for a, b in taken):
            return (x, y)


def moved(
    setup: RobotSetup, place: Point, heading: float, *, flip: bool = False, speed: float | None = None
) -> RobotSetup:
    """Start a robot elsewhere; a start is in the own team's view, so yellow's is turned round."""
    x, y = place
    if flip:
        x, y = -x, -y
    turned = atan2(sin(heading + pi), cos(heading + pi)) if flip else atan2(sin(heading), cos(heading))
    start = setup.start.model_copy(update={"position": (x, y), "heading": turned})
    params = setup.params if speed is None else {**setup.params, "speed_factor": speed}
    return setup.model_copy(update={"start": start, "params": params})
