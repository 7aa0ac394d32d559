"""Drawings of skills and worlds on the field for viewers, in layers: paths, plans, numbers."""

from __future__ import annotations

from collections.abc import Container, Iterable
from math import isfinite
from typing import Any, TypeAlias

from robobt.world.geometry import Point

Shape: TypeAlias = list[Any]
"""Layer, kind, what :data:`SHAPE_KINDS` says: numbers [m], and of a text or number the text or name."""

SHAPE_KINDS = {"line": 4, "point": 2, "circle": 3, "text": 2, "number": 1}
"""How many numbers a shape of each kind has: x and y of its points, a circle's radius, a number itself."""

_KINDS_WITH_TEXT = ("text", "number")

MOST_SHAPES = 200
"""Shapes that one robot draws at a tick; what is drawn beyond them is left out."""

MOST_LAYERS = 60

_LONGEST_NAME, _LONGEST_DRAWN_TEXT = 40, 80
_FARTHEST_POINT = 1000.0
_LARGEST = 1e9


class Sketch:
    """Records one tick's drawings in the watched layers only.

    Points are in the drawer's view of the field, in metres. Invalid shapes, such as points that are not
    finite, are left out, because watching must not change a match.

    Attributes:
        layers: the names that were drawn to, wanted or not, several sketches may share them;
            names beyond :data:`MOST_LAYERS` or of more than 40 characters are not drawn.
    """

    __slots__ = ("_shapes", "_wanted", "layers")

    def __init__(self) -> None:
        self._wanted: Container[str] = ()
        self._shapes: list[Shape] = []
        self.layers: set[str] = set()

    def want(self, layers: Container[str], known: set[str]) -> None:
        """Record these layers from now on, and add the names of all layers to ``known``."""
        self._wanted, self.layers = layers, known

    def wants(self, layer: str) -> bool:
        """Return whether a layer is watched; check this before computing values only for drawing."""
        if layer in self.layers:
            return layer in self._wanted
        if isinstance(layer, str) and len(layer) <= _LONGEST_NAME and len(self.layers) < MOST_LAYERS:
            self.layers.add(layer)
            return layer in self._wanted
        return False

    def line(self, layer: str, start: Point, end: Point) -> None:
        """Draw a line between two points [m]."""
        if self.wants(layer):
            self._draw(layer, "line", (*start[:2], *end[:2]))

    def path(self, layer: str, points: Iterable[Point]) -> None:
        """Draw lines from point to point [m]."""
        if self.wants(layer):
            before = None
            for point in points:
                if before is not None:
                    self.line(layer, before, point)
                before = point

    def point(self, layer: str, at: Point) -> None:
        """Mark a point [m]."""
        if self.wants(layer):
            self._draw(layer, "point", at[:2])

    def circle(self, layer: str, centre: Point, radius: float) -> None:
        """Draw a circle [m]."""
        if self.wants(layer):
            self._draw(layer, "circle", (*centre[:2], radius))

    def text(self, layer: str, at: Point, text: str) -> None:
        """Write at most 80 characters beside a point [m]."""
        if self.wants(layer):
            self._draw(layer, "text", at[:2], text)

    def number(self, layer: str, name: str, value: float) -> None:
        """Publish a number: it is written beside the robot, and charts show it over time."""
        if self.wants(layer):
            self._draw(layer, "number", (value,), name)

    def take(self) -> list[Shape]:
        """Return the shapes drawn since the last call."""
        if not self._shapes:
            return []
        shapes, self._shapes = self._shapes, []
        return shapes

    def _draw(self, layer: str, kind: str, numbers: Iterable[float], *text: str) -> None:
        if len(self._shapes) >= MOST_SHAPES:
            return
        try:
            shape = [layer, kind, *[round(float(number), 4) for number in numbers]]
            shape += [str.__str__(each)[:_LONGEST_DRAWN_TEXT] for each in text]
            self._shapes.append(check_shape(shape))
        except (TypeError, ValueError, OverflowError):
            return


def check_shape(shape: Shape) -> Shape:
    """Return a shape that can be drawn.

    Raises:
        ValueError: it is none.
    """
    layer, kind, *rest = shape if len(shape) > 2 else ("", "")
    if not isinstance(layer, str) or not 0 < len(layer) <= _LONGEST_NAME or kind not in SHAPE_KINDS:
        raise ValueError("a shape is a layer's name, a kind and its numbers")
    numbers, texts = rest[: SHAPE_KINDS[kind]], rest[SHAPE_KINDS[kind] :]
    most = _LARGEST if kind == "number" else _FARTHEST_POINT
    if len(numbers) < SHAPE_KINDS[kind] or not all(
        _is_number(each) and abs(each) <= most for each in numbers
    ):
        raise ValueError(f"a {kind} takes {SHAPE_KINDS[kind]} finite numbers")
    if kind == "circle" and numbers[2] < 0.0:
        raise ValueError("a circle's radius is not negative")
    if len(texts) != (kind in _KINDS_WITH_TEXT) or not all(
        isinstance(text, str) and len(text) <= _LONGEST_DRAWN_TEXT for text in texts
    ):
        raise ValueError(f"only texts and numbers have a text, of at most {_LONGEST_DRAWN_TEXT} characters")
    return shape


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
