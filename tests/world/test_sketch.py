"""Drawing: nothing where nobody looks, and never more than can be drawn."""

from collections.abc import Iterator
from math import inf, nan
from typing import Any

import pytest

from robobt.world.sketch import MOST_LAYERS, MOST_SHAPES, Sketch, check_shape


def looked_at(*layers: str) -> Sketch:
    sketch = Sketch()
    sketch.want(layers, set())
    return sketch


def never() -> Iterator[tuple[float, float]]:
    raise AssertionError("computed for nobody")
    yield 0.0, 0.0


def test_nothing_is_drawn_or_computed_where_nobody_looks() -> None:
    sketch = looked_at("other")
    sketch.path("plan", never())
    sketch.line("plan", (0.0, 0.0), (1.0, 1.0))
    assert not sketch.wants("plan")
    assert sketch.take() == []
    assert sketch.layers == {"plan"}


def test_what_is_drawn_is_taken_once() -> None:
    sketch = looked_at("plan")
    sketch.path("plan", [(0.0, 0.0), (1.0, 2.0), (3.0, 4.00004)])
    sketch.point("plan", (0.5, 0.5))
    sketch.circle("plan", (1.0, 1.0), 0.25)
    sketch.text("plan", (1.0, 1.0), "here")
    sketch.number("plan", "gap", 0.123456)
    assert sketch.take() == [
        ["plan", "line", 0.0, 0.0, 1.0, 2.0],
        ["plan", "line", 1.0, 2.0, 3.0, 4.0],
        ["plan", "point", 0.5, 0.5],
        ["plan", "circle", 1.0, 1.0, 0.25],
        ["plan", "text", 1.0, 1.0, "here"],
        ["plan", "number", 0.1235, "gap"],
    ]
    assert sketch.take() == []


def test_what_cannot_be_drawn_is_left_out_and_harms_nobody() -> None:
    sketch = looked_at("plan")
    draws: Any = sketch
    for wrong in (nan, inf, 1e300, "far", None, 10**400):
        draws.line("plan", (0.0, 0.0), (wrong, 0.0))
        draws.circle("plan", (0.0, 0.0), wrong)
        draws.number("plan", "gap", wrong)
    draws.circle("plan", (0.0, 0.0), -1.0)
    draws.text("plan", (0.0, 0.0), 12)
    draws.point("plan", ())
    draws.point(12, (0.0, 0.0))
    draws.point("n" * 41, (0.0, 0.0))
    assert sketch.take() == []


def test_drawings_are_bounded() -> None:
    sketch = looked_at("plan")
    for i in range(100_000):
        sketch.line("plan", (0.0, 0.0), (1.0, i * 1e-5))
    sketch.text("plan", (0.0, 0.0), "word" * 1000)
    assert len(sketch.take()) == MOST_SHAPES
    sketch.text("plan", (0.0, 0.0), "word" * 1000)
    assert sketch.take()[0][-1] == "word" * 20
    for i in range(10 * MOST_LAYERS):
        sketch.point(f"layer {i}", (0.0, 0.0))
    assert len(sketch.layers) == MOST_LAYERS


@pytest.mark.parametrize(
    "shape",
    [
        [],
        ["plan"],
        ["", "point", 0.0, 0.0],
        ["plan", "star", 0.0, 0.0],
        ["plan", "point", 0.0],
        ["plan", "point", 0.0, True],
        ["plan", "point", 0.0, 0.0, "text"],
        ["plan", "text", 0.0, 0.0],
        ["plan", "text", 0.0, 0.0, "x" * 81],
        ["plan", "circle", 0.0, 0.0, -1.0],
        ["plan", "line", 0.0, 0.0, 1e9, 0.0],
    ],
)
def test_what_is_no_shape_is_refused(shape: list[Any]) -> None:
    with pytest.raises(ValueError, match=r"shape|takes|radius|text"):
        check_shape(shape)
