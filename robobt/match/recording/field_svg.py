"""One frame as a picture: the field drawn to scale, as a standalone SVG."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from itertools import pairwise
from math import acos, cos, hypot, isfinite, sin

from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotId, RobotState

_COLOURS = {Team.BLUE: ("#2f6fed", "#ffffff"), Team.YELLOW: ("#f2c21b", "#2c2200")}
_BALL = "#ff7a1a"
_JUMP = 0.4
_TRAIL_PIECES = 24


def field_svg(
    frame: Frame,
    *,
    trail: Sequence[Point] = (),
    labels: Mapping[RobotId, str] | None = None,
    window: tuple[float, float, float, float] | None = None,
    width: int = 960,
    radius: float = ROBOT_RADIUS,
    mouth: float = 0.075,
) -> str:
    """Draw a frame to scale, as its team sees it: attack to the right.

    Args:
        trail: where the ball has been, the oldest point first [m]; it is not drawn across a
            jump, as when the ball was put down somewhere else.
        labels: a few words to write under robots.
        window: left, bottom, right and top of what is shown [m]; everything inside the walls if None.
        width: of the picture [px].
        radius, mouth: size of the robots, and centre to flat front [m].
    """
    field = frame.field
    wide, high = field.length + 2 * field.margin, field.width + 2 * field.margin
    left, bottom, right, top = window or (-wide / 2, -high / 2, wide / 2, high / 2)
    box = " ".join(_n(length) for length in (left, -top, right - left, top - bottom))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="{width}"'
        f' height="{round(width * (top - bottom) / (right - left))}" role="img"'
        " font-family=\"system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif\">",
        "<title>Robot soccer field</title>",
        *_ground(field, frame.team, wide, high),
        *_trail(trail),
    ]
    for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents)):
        parts += [_robot(robot, team, radius, mouth) for robot in robots]
    if isfinite(frame.ball.x) and isfinite(frame.ball.y):
        parts.append(
            f'<circle cx="{_n(frame.ball.x)}" cy="{_n(-frame.ball.y)}" r="{BALL_RADIUS}" fill="{_BALL}"'
            ' stroke="#5a2400" stroke-opacity=".7" stroke-width=".006"/>'
        )
    for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents)):
        for robot in robots:
            text = (labels or {}).get(RobotId(team, robot.id))
            if text:
                parts.append(_label(robot, text, radius))
    return "\n".join([*parts, "</svg>"]) + "\n"


def _n(metres: float) -> str:
    """A length to a tenth of a millimetre; units of the picture are metres."""
    return f"{metres + 0.0:.4f}".rstrip("0").rstrip(".")


def _ground(field: FieldGeometry, own: Team, wide: float, high: float) -> list[str]:
    half, side = field.half_length, field.half_width
    parts = [_rect(-wide / 2, high / 2, wide, high, 'rx=".12" fill="#3f835a"')]
    stripes = 2 * max(1, round(field.length / 2))
    step = field.length / stripes
    for place in range(stripes):
        shade = "#4f9c6c" if place % 2 else "#4a9566"
        parts.append(_rect(-half + place * step, side, step, field.width, f'fill="{shade}"'))
    for team, sign in ((own, -1), (own.other, 1)):
        colour = _COLOURS[team][0]
        left = half if sign > 0 else -half - field.goal_depth
        net = f'fill="{colour}" fill-opacity=".3"'
        parts.append(_rect(left, field.goal_width / 2, field.goal_depth, field.goal_width, net))
        post, back = _n(field.goal_width / 2), _n(sign * (half + field.goal_depth))
        parts.append(
            f'<path d="M{_n(sign * half)} -{post}H{back}V{post}H{_n(sign * half)}" fill="none"'
            f' stroke="{colour}" stroke-width=".03" stroke-linejoin="round"/>'
        )
    paint = 'fill="none" stroke="#ffffff" stroke-opacity=".92" stroke-width=".014"'
    box = (field.defense_depth, field.defense_width)
    parts += [
        _rect(-half, side, field.length, field.width, paint),
        f'<path d="M0 {_n(-side)}V{_n(side)}M{_n(-half)} 0H{_n(half)}" {paint}/>',
        f'<circle r="{_n(field.center_radius)}" {paint}/>',
        _rect(-half, field.defense_width / 2, *box, paint),
        _rect(half - field.defense_depth, field.defense_width / 2, *box, paint),
    ]
    return parts


def _rect(left: float, top: float, width: float, height: float, look: str) -> str:
    return f'<rect x="{_n(left)}" y="{_n(-top)}" width="{_n(width)}" height="{_n(height)}" {look}/>'


def _trail(trail: Sequence[Point]) -> list[str]:
    """The trail in pieces that grow stronger towards its end."""
    points = [(x, y) for x, y in trail if isfinite(x) and isfinite(y)]
    steps = [(a, b) for a, b in pairwise(points) if hypot(b[0] - a[0], b[1] - a[1]) <= _JUMP]
    piece = max(1, -(-len(steps) // _TRAIL_PIECES))
    parts = []
    for start in range(0, len(steps), piece):
        path, pen = "", None
        for before, after in steps[start : start + piece]:
            if before != pen:
                path += f"M{_n(before[0])} {_n(-before[1])}"
            path += f"L{_n(after[0])} {_n(-after[1])}"
            pen = after
        share = min(1.0, (start + piece) / len(steps))
        parts.append(
            f'<path d="{path}" fill="none" stroke="{_BALL}" stroke-opacity="{0.8 * share * share:.3f}"'
            ' stroke-width=".03" stroke-linecap="round"/>'
        )
    return parts


def _robot(robot: RobotState, team: Team, radius: float, mouth: float) -> str:
    colour, ink = _COLOURS[team]
    opening = acos(min(1.0, mouth / radius))
    corners = []
    for angle in (robot.heading + opening, robot.heading - opening):
        corners.append(f"{_n(robot.x + radius * cos(angle))} {_n(-robot.y - radius * sin(angle))}")
    bar = 0.022
    front, reach = mouth - bar / 2, radius * sin(opening)
    c, s = cos(robot.heading), sin(robot.heading)
    ends = [
        f"{_n(robot.x + front * c - way * s)} {_n(-robot.y - front * s - way * c)}" for way in (reach, -reach)
    ]
    mouth_colour = _BALL if robot.ball_contact else "#14202b"
    return (
        f'<g><path d="M{corners[0]}A{_n(radius)} {_n(radius)} 0 1 0 {corners[1]}Z" fill="{colour}"'
        ' stroke="#000" stroke-opacity=".5" stroke-width=".008"/>'
        f'<path d="M{ends[0]}L{ends[1]}" stroke="{mouth_colour}" stroke-width="{bar}"/>'
        f'<text x="{_n(robot.x - 0.014 * c)}" y="{_n(-robot.y + 0.014 * s + 0.04)}" font-size=".115"'
        f' font-weight="700" text-anchor="middle" fill="{ink}">{robot.id}</text></g>'
    )


def _label(robot: RobotState, text: str, radius: float) -> str:
    """Words under a robot, dark on a light edge so that they read on grass and on lines."""
    return (
        f'<text x="{_n(robot.x)}" y="{_n(-robot.y + radius + 0.15)}" font-size=".12" font-weight="600"'
        ' text-anchor="middle" fill="#fff" stroke="#16301f" stroke-opacity=".8" stroke-width=".03"'
        f' paint-order="stroke">{escape(text)}</text>'
    )
