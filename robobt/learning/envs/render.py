"""One arena as a picture of pixels."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, cos, degrees, sin

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from robobt.learning.envs.task import FloatArray
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

Picture = NDArray[np.uint8]
"""(height, width, 3) red, green, blue."""

_FINER = 2
"""Drawn this much larger and averaged down, for smooth edges."""

_GRASS, _STRIPES, _PAINT = (63, 131, 90), ((74, 149, 102), (79, 156, 108)), (240, 246, 242)
_BLUE, _YELLOW, _BALL, _DARK = (47, 111, 237), (242, 194, 27), (255, 122, 26), (20, 32, 43)
_ROBOT_TRAIL, _BALL_TRAIL = (142, 190, 255), (255, 178, 120)


class Renderer:
    """Draws robots and ball of one field; +x is to the right.

    ``face`` is the distance from a robot's centre to its flat front [m], ``width`` that of the picture [px].
    """

    def __init__(self, field: FieldGeometry, face: float, width: int = 800) -> None:
        self.field = field
        self._face = face
        outer = field.length + 2 * field.goal_line_margin, field.width + 2 * field.margin
        self._scale = width * _FINER / outer[0]
        self._centre = outer[0] / 2, outer[1] / 2
        self._size = width * _FINER, round(width * outer[1] / outer[0]) * _FINER
        self._ground = self._draw_ground()

    def draw(
        self,
        robot: FloatArray,
        ball: FloatArray,
        reach: float | None = None,
        robot_trail: Sequence[Point] = (),
        ball_trail: Sequence[Point] = (),
    ) -> Picture:
        """Draw the picture of one moment.

        ``robot`` (6,) and ``ball`` (4,) begin with x, y; the ball counts as reached in a ring of radius
        ``reach``; trails show where they have been, oldest first [m].
        """
        image = self._ground.copy()
        pen = ImageDraw.Draw(image)
        for trail, colour in ((robot_trail, _ROBOT_TRAIL), (ball_trail, _BALL_TRAIL)):
            if len(trail) > 1:
                pen.line(
                    [self._at(x, y) for x, y in trail], fill=colour, width=self._wide(0.025), joint="curve"
                )
        if reach is not None:
            pen.ellipse(self._round(ball[0], ball[1], reach), outline=_BALL, width=self._wide(0.012))
        self._draw_robot(pen, robot)
        pen.ellipse(
            self._round(ball[0], ball[1], 1.4 * BALL_RADIUS),
            fill=_BALL,
            outline=_DARK,
            width=self._wide(0.006),
        )
        return np.asarray(image.reduce(_FINER))

    def _draw_robot(self, pen: ImageDraw.ImageDraw, robot: FloatArray) -> None:
        x, y, heading = float(robot[0]), float(robot[1]), float(robot[2])
        opening = acos(self._face / ROBOT_RADIUS)
        # Pillow's angles run clockwise.
        start = degrees(opening - heading)
        box = self._round(x, y, ROBOT_RADIUS)
        pen.chord(
            box,
            start,
            start + 360.0 - 2.0 * degrees(opening),
            fill=_BLUE,
            outline=_DARK,
            width=self._wide(0.01),
        )
        corners = [
            self._at(x + ROBOT_RADIUS * cos(heading + turn), y + ROBOT_RADIUS * sin(heading + turn))
            for turn in (opening, -opening)
        ]
        pen.line(corners, fill=_DARK, width=self._wide(0.024))
        nose = x + 0.6 * self._face * cos(heading), y + 0.6 * self._face * sin(heading)
        pen.line([self._at(x, y), self._at(*nose)], fill=_PAINT, width=self._wide(0.018))

    def _draw_ground(self) -> Image.Image:
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
        for sign, colour in ((-1.0, _BLUE), (1.0, _YELLOW)):
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
