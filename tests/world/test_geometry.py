"""Angles and segments."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robobt.world import geometry as g

coordinate = st.floats(-20, 20)
point = st.tuples(coordinate, coordinate)
angle = st.floats(-50, 50)


@given(angle)
def test_a_wrapped_angle_is_the_same_direction_in_half_open_range(a: float) -> None:
    wrapped = g.wrap_angle(a)
    assert -pi < wrapped <= pi
    assert cos(wrapped) == pytest.approx(cos(a), abs=1e-9)
    assert sin(wrapped) == pytest.approx(sin(a), abs=1e-9)
    assert float(g.wrap_angles(a)) == wrapped


@given(point, point, point)
def test_the_closest_point_is_on_the_segment_and_no_sampled_point_is_closer(
    p: g.Point, a: g.Point, b: g.Point
) -> None:
    nearest = g.closest_point_on_segment(p, a, b)
    assert g.distance(a, nearest) + g.distance(nearest, b) == pytest.approx(g.distance(a, b), abs=1e-6)
    for share in np.linspace(0, 1, 11):
        sample = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
        assert g.segment_distance(p, a, b) <= g.distance(p, sample) + 1e-9


@given(point, st.floats(-3.1, 3.1), coordinate)
def test_a_crossing_lies_on_the_ray(start: g.Point, heading: float, x: float) -> None:
    y = g.line_crossing_x(start, heading, x)
    if y is None:
        assert (x - start[0]) * cos(heading) <= 0
    elif abs(y) < 1e3:
        reach = hypot(x - start[0], y - start[1])
        assert start[0] + reach * cos(heading) == pytest.approx(x, abs=1e-6)
        assert start[1] + reach * sin(heading) == pytest.approx(y, abs=1e-6)


@given(coordinate, coordinate, st.floats(-3.1, 3.1))
def test_turning_into_the_robots_frame_keeps_length_and_undoes_the_heading(
    vx: float, vy: float, h: float
) -> None:
    x, y = g.to_robot_frame(vx, vy, h)
    assert hypot(x, y) == pytest.approx(hypot(vx, vy), abs=1e-9)
    assert cos(h) * x - sin(h) * y == pytest.approx(vx, abs=1e-9)


@example(12.0, 1.192092896e-07, 12.0)  # as long as the limit, but for rounding
@given(coordinate, coordinate, st.floats(0.01, 30))
def test_a_limited_vector_keeps_its_direction(x: float, y: float, most: float) -> None:
    lx, ly = g.limit_norm(x, y, most)
    assert hypot(lx, ly) <= most * (1 + 1e-9)
    assert lx * y == pytest.approx(ly * x, abs=1e-6)
    if hypot(x, y) <= most:
        assert (lx, ly) == pytest.approx((x, y), rel=1e-9)


@given(point, point, point, point, st.floats(0, 1), st.floats(0, 1))
def test_two_segments_are_as_far_apart_as_their_nearest_points(
    a: g.Point, b: g.Point, c: g.Point, d: g.Point, along: float, across: float
) -> None:
    gap = g.segments_distance(a, b, c, d)
    assert gap == pytest.approx(g.segments_distance(c, d, a, b))
    one = (a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1]))
    other = (c[0] + across * (d[0] - c[0]), c[1] + across * (d[1] - c[1]))
    assert gap <= g.distance(one, other) + 1e-9


def test_crossing_segments_touch() -> None:
    assert g.segments_distance((-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)) == 0.0
    assert g.segments_distance((-1.0, 0.0), (1.0, 0.0), (2.0, -1.0), (2.0, 1.0)) == 1.0
