"""A field, robots and ball as a picture of pixels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import acos, cos, degrees, isfinite, sin
from typing import TypeAlias

from PIL import Image, ImageDraw, ImageFont

from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

Painted: TypeAlias = tuple[Team, str, float, float, float]
"""A robot: its team, what is written on it, x, y [m] and heading [rad]."""

_FINER = 2
"""Drawn this much larger and averaged down, for smooth edges."""

_GRASS, _STRIPES, _PAINT = (63, 131, 90), ((74, 149, 102), (79, 156, 108)), (240, 246, 242)
_BLUE_COLOUR, _YELLOW_COLOUR, _BALL_COLOUR, _DARK_COLOUR = (
    (47, 111, 237),
    (242, 194, 27),
    (255, 122, 26),
    (20, 32, 43),
)
_COLOURS = {Team.BLUE: _BLUE_COLOUR, Team.YELLOW: _YELLOW_COLOUR}
_ROBOT_TRAIL, _BALL_TRAIL = (142, 190, 255), (255, 178, 120)


class Painter:
    """Paints robots and ball of one field; +x is to the right, blue's goal to the left.

    ``face`` is the distance from a robot's centre to its flat front [m], ``width`` that of the picture [px].
    """

    def __init__(self, field: FieldGeometry, face: float = 0.075, width: int = 800) -> None:
        self.field = field
        self._face = face
        outer = field.length + 2 * field.goal_line_margin, field.width + 2 * field.margin
        self._scale = width * _FINER / outer[0]
        self._centre = outer[0] / 2, outer[1] / 2
        self._size = width * _FINER, round(width * outer[1] / outer[0]) * _FINER
        self._ground = self._paint_ground()

    def paint(
        self,
        robots: Iterable[Painted],
        ball: Point,
        reach: float | None = None,
        robot_trail: Sequence[Point] = (),
        ball_trail: Sequence[Point] = (),
    ) -> Image.Image:
        """Paint the picture of one moment.

        Args:
            robots: those on the field.
            ball: x, y [m]; NaN where it is not known, and it is left out.
            reach: radius of a ring around the ball, in which it counts as reached [m].
            robot_trail: where a robot has been, oldest first [m].
            ball_trail: where the ball has been, oldest first [m].
        """
        image = self._ground.copy()
        pen = ImageDraw.Draw(image)
        for trail, colour in ((robot_trail, _ROBOT_TRAIL), (ball_trail, _BALL_TRAIL)):
            if len(trail) > 1:
                pen.line(
                    [self._at(x, y) for x, y in trail], fill=colour, width=self._wide(0.025), joint="curve"
                )
        known = isfinite(ball[0])
        if reach is not None and known:
            pen.ellipse(self._round(*ball, reach), outline=_BALL_COLOUR, width=self._wide(0.012))
        for robot in robots:
            self._paint_robot(pen, *robot)
        if known:
            spot = self._round(*ball, 1.4 * BALL_RADIUS)
            pen.ellipse(spot, fill=_BALL_COLOUR, outline=_DARK_COLOUR, width=self._wide(0.006))
        return image.reduce(_FINER)

    def _paint_robot(
        self, pen: ImageDraw.ImageDraw, team: Team, label: str, x: float, y: float, heading: float
    ) -> None:
        opening = acos(self._face / ROBOT_RADIUS)
        # Pillow's angles run clockwise.
        start = degrees(opening - heading)
        box = self._round(x, y, ROBOT_RADIUS)
        pen.chord(
            box,
            start,
            start + 360.0 - 2.0 * degrees(opening),
            fill=_COLOURS[team],
            outline=_DARK_COLOUR,
            width=self._wide(0.01),
        )
        corners = [
            self._at(x + ROBOT_RADIUS * cos(heading + turn), y + ROBOT_RADIUS * sin(heading + turn))
            for turn in (opening, -opening)
        ]
        pen.line(corners, fill=_DARK_COLOUR, width=self._wide(0.024))
        if label:
            colour = _DARK_COLOUR if team is Team.YELLOW else _PAINT
            pen.text(self._at(x, y), label, fill=colour, font=font(self._wide(0.12)), anchor="mm")
        else:
            nose = x + 0.6 * self._face * cos(heading), y + 0.6 * self._face * sin(heading)
            pen.line([self._at(x, y), self._at(*nose)], fill=_PAINT, width=self._wide(0.018))

    def _paint_ground(self) -> Image.Image:
        field = self.field
        half, side, goal = field.half_length, field.half_width, field.goal_width / 2
        image = Image.new("RGB", self._size, _GRASS)
        pen = ImageDraw.Draw(image)
        stripes = 2 * max(1, round(field.length / 2))
        for i in range(stripes):
            left = -half + i * field.length / stripes
            pen.rectangle(self._box(left, -side, left + field.length / stripes, side), fill=_STRIPES[i % 2])
        line = self._wide(0.02)
        pen.rectangle(self._box(-half, -side, half, side), outline=_PAINT, width=line)
        pen.line([self._at(0.0, -side), self._at(0.0, side)], fill=_PAINT, width=line)
        pen.line([self._at(-half, 0.0), self._at(half, 0.0)], fill=_PAINT, width=line)
        pen.ellipse(self._round(0.0, 0.0, field.center_radius), outline=_PAINT, width=line)
        area = field.defense_width / 2
        for sign, colour in ((-1.0, _BLUE_COLOUR), (1.0, _YELLOW_COLOUR)):
            front, back = sign * (half - field.defense_depth), sign * (half + field.goal_depth)
            pen.rectangle(self._box(front, -area, sign * half, area), outline=_PAINT, width=line)
            pale = tuple((3 * ground + own) // 4 for ground, own in zip(_GRASS, colour, strict=True))
            pen.rectangle(self._box(sign * half, -goal, back, goal), fill=pale)
            net = [(sign * half, goal), (back, goal), (back, -goal), (sign * half, -goal)]
            pen.line([self._at(x, y) for x, y in net], fill=colour, width=2 * line, joint="curve")
        return image

    def _at(self, x: float, y: float) -> Point:
        return (x + self._centre[0]) * self._scale, (self._centre[1] - y) * self._scale

    def _round(self, x: float, y: float, radius: float) -> tuple[Point, Point]:
        return self._box(float(x) - radius, float(y) - radius, float(x) + radius, float(y) + radius)

    def _box(self, x0: float, y0: float, x1: float, y1: float) -> tuple[Point, Point]:
        return self._at(min(x0, x1), max(y0, y1)), self._at(max(x0, x1), min(y0, y1))

    def _wide(self, metres: float) -> int:
        return max(1, round(metres * self._scale))


@lru_cache
def font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """Return Pillow's own font, which is there whatever the machine has, in a size [px]."""
    return ImageFont.load_default(size)
