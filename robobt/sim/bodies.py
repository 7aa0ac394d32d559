"""The bodies and walls of a field: their outlines and materials, and how they come into a pymunk space."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import acos, cos, pi, sin
from typing import NamedTuple

import pymunk

from robobt.sim.robot_settings import BodySettings
from robobt.sim.settings import ContactSettings, SimSettings
from robobt.world.field import FieldGeometry
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

SOFT = 0.008
"""Depth inside a robot's core, if it has one, at which the ball meets a solid body [m]."""

_WALL = 0.02
"""Thickness of a goal's walls in the rules [m]."""

BEYOND = 0.5
"""Thickness of the walls around the field [m]."""

SLOP = 1e-4
"""Overlap that is not corrected [m]; Chipmunk's default is made for pixels."""

_PLACED_OVERLAP, _PLACED_GAP = 1e-4, 3e-4
"""Overlap with a front that a placed ball may have, and its gap to the front where it has more [m]."""

_HULL_CORNERS = 24
_PLATE = 0.006
"""Thickness of the plate that forms a robot's flat front [m]."""

_RECESS = 0.025
"""Distance from the front of a mouth between jaws to the hull behind it [m]."""

# Collision categories: robots meet robots as discs and the ball with their hull.
_DISC_CATEGORY, _HULL_CATEGORY, _BALL_CATEGORY, _STATIC_CATEGORY = 1, 2, 4, 8

Box = tuple[float, float, float, float]


class Outline(NamedTuple):
    """A convex part of a robot's hull, which meets the ball.

    ``corners`` in the robot's frame, counter-clockwise, one for a disc [m]; ``rounding`` their radius [m];
    ``material`` restitution and friction.
    """

    corners: list[tuple[float, float]]
    rounding: float
    material: tuple[float, float]


def before_fronts(
    ball: Sequence[float], robots: Iterable[Sequence[float]], body: BodySettings
) -> list[float]:
    """Return a ball to be placed, moved out of the mouths whose fronts it would lie in.

    Inside a front it would be pushed off, faster than a late robot's dribbler takes it.

    Args:
        ball: x, y and further numbers [m].
        robots: x, y, heading and further numbers of each [m, rad].
        body: the robots'.
    """
    place = list(ball)
    touching = body.face + BALL_RADIUS
    for x, y, heading, *_ in robots:
        dx, dy, c, s = place[0] - x, place[1] - y, cos(heading), sin(heading)
        ahead, aside = c * dx + s * dy, c * dy - s * dx
        if 0.0 < ahead < touching - _PLACED_OVERLAP and abs(aside) <= body.mouth_width / 2:
            out = touching + _PLACED_GAP - ahead
            place[0] += c * out
            place[1] += s * out
    return place


def walls_of(field: FieldGeometry) -> list[tuple[Box, str]]:
    """Return the static boxes of a field: surrounding walls, and per goal two sides and a back."""
    outer_x, outer_y = field.outer
    far_x, far_y = outer_x + BEYOND, outer_y + BEYOND
    boxes: list[tuple[Box, str]] = [
        ((-far_x, outer_y, far_x, far_y), "wall"),
        ((-far_x, -far_y, far_x, -outer_y), "wall"),
        ((outer_x, -far_y, far_x, far_y), "wall"),
        ((-far_x, -far_y, -outer_x, far_y), "wall"),
    ]
    post, line = field.goal_width / 2, field.half_length
    back = line + field.goal_depth
    for sign in (1.0, -1.0):
        # The rules prolong the sides to the wall, so nothing gets behind a goal.
        ends = sorted((sign * line, sign * (outer_x + BEYOND)))
        boxes.append(((ends[0], post, ends[1], post + _WALL), "goal"))
        boxes.append(((ends[0], -post - _WALL, ends[1], -post), "goal"))
        ends = sorted((sign * back, sign * max(back + _WALL, outer_x + BEYOND)))
        boxes.append(((ends[0], -post - _WALL, ends[1], post + _WALL), "goal_back"))
    return boxes


def fill(
    space: pymunk.Space,
    settings: SimSettings,
    robots: int,
    walls: Sequence[tuple[Box, str]],
) -> list[pymunk.Body]:
    """Add the walls, robots and the ball; return the bodies, the ball last."""
    body, material, places = settings.body, material_of(settings.contact), until_placed(robots)
    bodies = []
    for (x0, y0, x1, y1), kind in walls:
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        box = pymunk.Poly(space.static_body, corners)
        _finish(box, *material[kind], _STATIC_CATEGORY, _DISC_CATEGORY | _BALL_CATEGORY)
        space.add(box)
    for i in range(robots):
        robot = pymunk.Body(body.mass, moment_of_inertia(body.mass))
        robot.position = places[i]
        shapes: list[pymunk.Shape] = []
        for part in outlines(settings):
            if len(part.corners) == 1:
                shapes.append(pymunk.Circle(robot, part.rounding))
            else:
                shapes.append(pymunk.Poly(robot, part.corners, radius=part.rounding))
            _finish(shapes[-1], *part.material, _HULL_CATEGORY, _BALL_CATEGORY)
        disc = pymunk.Circle(robot, ROBOT_RADIUS)
        bounce, rub = disc_material(settings.contact)
        # Chipmunk multiplies the two shapes' values: robots share theirs evenly.
        _finish(disc, bounce**0.5, rub**0.5, _DISC_CATEGORY, _DISC_CATEGORY | _STATIC_CATEGORY)
        space.add(robot, disc, *shapes)
        bodies.append(robot)
    # The ball cannot turn, because spin about the vertical axis has no effect.
    ball = pymunk.Body(settings.ball.mass, float("inf"))
    ball.position = (0.0, 0.0)
    round_ = pymunk.Circle(ball, BALL_RADIUS)
    _finish(round_, 1.0, 1.0, _BALL_CATEGORY, _HULL_CATEGORY | _STATIC_CATEGORY)
    space.add(ball, round_)
    bodies.append(ball)
    return bodies


def until_placed(robots: int) -> list[tuple[float, float]]:
    """Return initial places of robots, apart from each other, until they are placed [m]."""
    return [(0.0, 3 * ROBOT_RADIUS * (i + 1)) for i in range(robots)]


def material_of(contact: ContactSettings) -> dict[str, tuple[float, float]]:
    """Return restitution and friction of each kind of wall."""
    return {
        "wall": (contact.wall_restitution, contact.wall_friction),
        "goal": (contact.goal_restitution, contact.goal_friction),
        "goal_back": (contact.goal_back_restitution, contact.goal_friction),
    }


def disc_material(contact: ContactSettings) -> tuple[float, float]:
    """Return restitution and friction of two robots."""
    return contact.robot_restitution, contact.robot_friction


def outlines(settings: SimSettings) -> list[Outline]:
    """Return the parts of a robot's hull."""
    contact, body = settings.contact, settings.body
    material = contact.hull_restitution, contact.hull_friction
    if settings.shell is not None:
        # Plate and wheels push the ball in the kernels; this only keeps it from being squeezed in.
        return [Outline([(0.0, 0.0)], settings.shell.core - SOFT, (0.0, contact.hull_friction))]
    hull = _hull(body.face - (_PLATE if body.jaws is None else _RECESS))
    plate = _plate(body.face, body.mouth_width / 2 if body.jaws is not None else None)
    return [
        Outline(hull, 0.0, material),
        *_jaws(body, material),
        Outline(plate, 0.0, (contact.front_restitution, contact.front_friction)),
    ]


def moment_of_inertia(mass: float) -> float:
    """Return the moment of inertia of a robot, as of a disc [kg m^2]."""
    return 0.5 * mass * ROBOT_RADIUS**2


def _finish(shape: pymunk.Shape, restitution: float, friction: float, category: int, mask: int) -> None:
    shape.elasticity = restitution
    shape.friction = friction
    shape.filter = pymunk.ShapeFilter(categories=category, mask=mask)


def _hull(chord: float) -> list[tuple[float, float]]:
    """Return the round part of a robot: a polygon around the disc, cut flat ``chord`` ahead of the centre.

    Its edges touch the disc, so that a ball that has come to the disc meets it.
    """
    opening = acos(chord / ROBOT_RADIUS)
    step = (2 * pi - 2 * opening) / _HULL_CORNERS
    radius = ROBOT_RADIUS / cos(step / 2)
    angles = [opening + step * (i + 0.5) for i in range(_HULL_CORNERS)]
    ends = [(chord, radius * sin(opening)), (chord, -radius * sin(opening))]
    return [ends[0], *[(radius * cos(angle), radius * sin(angle)) for angle in angles], ends[1]]


def _plate(face: float, half: float | None) -> list[tuple[float, float]]:
    """Return the flat front as a thin box, so that it can be of another material than the hull."""
    if half is None:
        half = (ROBOT_RADIUS**2 - face**2) ** 0.5
    return [(face - 2 * _PLATE, -half), (face, -half), (face, half), (face - 2 * _PLATE, half)]


def _jaws(body: BodySettings, material: tuple[float, float]) -> list[Outline]:
    """Return the jaws with rounded corners beside a recessed mouth: one part per side, or none."""
    if body.jaws is None:
        return []
    rounding = body.jaws.rounding
    radius, front = ROBOT_RADIUS - rounding, body.jaws.front - rounding
    back, inner = body.face - _RECESS, body.jaws.opening / 2 + rounding
    first, last = acos(front / radius), acos(back / radius)
    angles = [first + (last - first) * i / 5 for i in range(6)]
    outline = [(back, inner), (front, inner), *[(radius * cos(a), radius * sin(a)) for a in angles]]
    mirrored = [(x, -y) for x, y in reversed(outline)]
    return [Outline(corners, rounding, material) for corners in (outline, mirrored)]
