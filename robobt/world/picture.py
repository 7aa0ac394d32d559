"""A frame as a picture, as notebooks show it."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, sin

from robobt.world.field import FieldGeometry

_FRONT_HALF_ANGLE = 0.6
"""How far to either side of the heading the flat front reaches [rad]."""


def field_svg(
    title: str,
    field: FieldGeometry,
    colours: tuple[str, str],
    robots: Iterable[tuple[str, int, float, float, float]],
    ball: tuple[float, float],
    radii: tuple[float, float],
) -> str:
    """Return an SVG picture 600 pixels wide, +x to the right and +y up.

    Args:
        title: what it shows, for those who cannot see it.
        field: whose lines are drawn.
        colours: of the goals at -x and +x.
        robots: colour, number, x, y [m] and heading [rad] of each.
        ball: x, y [m].
        radii: of a robot and of the ball [m]; the ball is drawn half as large again.
    """
    x, y, side = field.length / 2.0, field.width / 2.0, field.margin
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" width="600" '
        f'viewBox="{-x - side:g} {-y - side:g} {2 * (x + side):g} {2 * (y + side):g}" role="img">',
        f"<title>{title}</title>",
        f'<rect x="{-x - side:g}" y="{-y - side:g}" width="100%" height="100%" fill="#2e7d43"/>',
        '<g fill="none" stroke="#fff" stroke-width="0.02">',
        f'<rect x="{-x:g}" y="{-y:g}" width="{2 * x:g}" height="{2 * y:g}"/>',
        f'<path d="M0 {-y:g}V{y:g}"/><circle r="{field.center_radius:g}"/>',
    ]
    for sign in (-1.0, 1.0):
        depth, half, goal = field.defense_depth, field.defense_width / 2.0, field.goal_width / 2.0
        parts.append(f'<path d="M{sign * x:g} {-half:g}h{-sign * depth:g}v{2 * half:g}h{sign * depth:g}"/>')
        colour = colours[sign > 0.0]
        deep = sign * field.goal_depth
        parts.append(
            f'<path stroke="{colour}" stroke-width="0.05" '
            f'd="M{sign * x:g} {-goal:g}h{deep:g}v{2 * goal:g}h{-deep:g}"/>'
        )
    parts.append("</g>")
    parts += [_robot(*robot, radii[0]) for robot in robots]
    # SVG's y points down, the field's up.
    parts.append(f'<circle cx="{ball[0]:g}" cy="{-ball[1]:g}" r="{1.5 * radii[1]:g}" fill="#f5731b"/></svg>')
    return "\n".join(parts)


def _robot(colour: str, number: int, x: float, y: float, heading: float, radius: float) -> str:
    corners = [
        (x + radius * cos(heading + turn), -y - radius * sin(heading + turn))
        for turn in (_FRONT_HALF_ANGLE, -_FRONT_HALF_ANGLE)
    ]
    (x1, y1), (x2, y2) = corners
    return (
        f'<path fill="{colour}" d="M{x1:.4f} {y1:.4f}A{radius} {radius} 0 1 0 {x2:.4f} {y2:.4f}Z"/>'
        f'<text x="{x:g}" y="{-y + 0.05:g}" font-size="0.13" text-anchor="middle" fill="#fff" '
        f'font-family="sans-serif">{number}</text>'
    )
