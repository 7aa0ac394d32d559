"""What Foxglove draws of a recording: field, bodies and drawings as scene entities."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import cos, pi, sin
from typing import Any, TypeAlias

from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from robobt.match.recording.header import RecordedRobot
from robobt.match.recording.mcap_messages import stamp
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.sketch import Shape
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT

ROOT = "field"
"""The frame of world coordinates."""

Fields: TypeAlias = dict[str, Any]
"""A message by the names of its fields."""

_LINE_WIDTH = 0.01
_MARK = 0.02
_TEXT_SIZE = 0.1
_CORNERS = 48
_ABOVE = 0.005
"""Drawings lie a little above the lines of the field [m]."""


def _colour(red: float, green: float, blue: float) -> Fields:
    return {"r": red, "g": green, "b": blue, "a": 1.0}


_WHITE, _BLACK = _colour(1.0, 1.0, 1.0), _colour(0.1, 0.1, 0.1)
_ORANGE, _GREEN = _colour(1.0, 0.48, 0.1), _colour(0.25, 0.51, 0.35)
_TEAMS = {Team.BLUE: _colour(0.18, 0.44, 0.93), Team.YELLOW: _colour(0.95, 0.76, 0.11)}
_PENS = (_colour(1.0, 0.2, 0.6), _colour(0.0, 0.8, 0.8), _colour(0.9, 0.6, 0.1), _colour(0.6, 0.3, 0.9))


def transform(frame: str, x: float, y: float, z: float, heading: float, time: int) -> Fields:
    """Return the transform that puts a frame at x, y, z [m] with a heading [rad], at a time [ns]."""
    return {
        "timestamp": stamp(time),
        "parent_frame_id": ROOT,
        "child_frame_id": frame,
        "translation": {"x": x, "y": y, "z": z},
        "rotation": {"z": sin(heading / 2), "w": cos(heading / 2)},
    }


def update(entities: Iterable[Fields], time: int) -> Any:
    """Return the message after which its topic shows these entities, from a time [ns] on, and no others."""
    cleared = {"timestamp": stamp(time), "type": SceneEntityDeletion.Type.ALL}
    return SceneUpdate(deletions=[cleared], entities=entities)


def field(geometry: FieldGeometry, time: int) -> Any:
    """Return the message that draws a field, from a time [ns] on."""
    x, y = geometry.half_length, geometry.half_width
    lines = [
        _line([(-x, -y), (x, -y), (x, y), (-x, y)], _WHITE, closed=True),
        _line([(0.0, -y), (0.0, y)], _WHITE),
        _circle(0.0, 0.0, geometry.center_radius, _WHITE),
    ]
    for side, team in ((-1.0, Team.BLUE), (1.0, Team.YELLOW)):
        for depth, half, colour in (
            (-geometry.defense_depth, geometry.defense_width / 2, _WHITE),
            (geometry.goal_depth, geometry.goal_width / 2, _TEAMS[team]),
        ):
            back = side * (x + depth)
            lines.append(_line([(side * x, -half), (back, -half), (back, half), (side * x, half)], colour))
    outer = geometry.outer
    grass = {
        "pose": _pose(0.0, 0.0, -0.01),
        "size": {"x": 2 * outer[0], "y": 2 * outer[1], "z": 0.01},
        "color": _GREEN,
    }
    return update([_entity("field", ROOT, time, {"cubes": [grass], "lines": lines})], time)


def ball(frame: str, time: int) -> Fields:
    """Return the entity of the ball, which follows a frame."""
    size = dict.fromkeys("xyz", 2 * BALL_RADIUS)
    sphere = {"pose": _pose(0.0, 0.0, BALL_RADIUS), "size": size, "color": _ORANGE}
    return _entity("ball", frame, time, {"spheres": [sphere]})


def robot(recorded: RecordedRobot, frame: str, time: int) -> Fields:
    """Return the entity of a robot, which follows a frame: its body, its front and its number."""
    width, top = 2 * recorded.radius, ROBOT_HEIGHT + _ABOVE
    body = {
        "pose": _pose(0.0, 0.0, ROBOT_HEIGHT / 2),
        "size": {"x": width, "y": width, "z": ROBOT_HEIGHT},
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": _TEAMS[recorded.team],
    }
    parts = {
        "cylinders": [body],
        "lines": [_line([(0.0, 0.0), (recorded.mouth, 0.0)], _BLACK, height=top)],
        "texts": [_text(0.0, 0.0, str(recorded.number), _BLACK, height=top + _TEXT_SIZE)],
    }
    return _entity(str(recorded.id), frame, time, parts)


def drawing(shapes: Iterable[Shape], sign: float, time: int) -> list[Fields]:
    """Return the entities of a sketch, one a layer, from a time [ns] on.

    ``sign`` is -1 for what was drawn in yellow's view, else 1. Numbers are left out, for they have no place.
    """
    layers: dict[str, Fields] = {}
    for layer, kind, *rest in shapes:
        if kind == "number":
            continue
        parts = layers.setdefault(layer, {"lines": [], "spheres": [], "texts": []})
        colour = _PENS[sum(layer.encode()) % len(_PENS)]
        x, y = sign * rest[0], sign * rest[1]
        if kind == "line":
            parts["lines"].append(_line([(x, y), (sign * rest[2], sign * rest[3])], colour, height=_ABOVE))
        elif kind == "circle":
            parts["lines"].append(_circle(x, y, rest[2], colour, height=_ABOVE))
        elif kind == "point":
            size = dict.fromkeys("xyz", 2 * _MARK)
            parts["spheres"].append({"pose": _pose(x, y, _MARK), "size": size, "color": colour})
        else:
            parts["texts"].append(_text(x, y, rest[2], colour, height=_TEXT_SIZE))
    return [_entity(layer, ROOT, time, parts) for layer, parts in layers.items()]


def _entity(name: str, frame: str, time: int, parts: Mapping[str, object]) -> Fields:
    return {"timestamp": stamp(time), "frame_id": frame, "id": name, "frame_locked": True, **parts}


def _line(points: Iterable[Point], colour: Fields, closed: bool = False, height: float = 0.0) -> Fields:
    return {
        "type": LinePrimitive.Type.LINE_LOOP if closed else LinePrimitive.Type.LINE_STRIP,
        "pose": _pose(0.0, 0.0, height),
        "thickness": _LINE_WIDTH,
        "points": [{"x": x, "y": y} for x, y in points],
        "color": colour,
    }


def _circle(x: float, y: float, radius: float, colour: Fields, height: float = 0.0) -> Fields:
    turns = [2 * pi * corner / _CORNERS for corner in range(_CORNERS)]
    points = [(x + radius * cos(turn), y + radius * sin(turn)) for turn in turns]
    return _line(points, colour, closed=True, height=height)


def _text(x: float, y: float, text: str, colour: Fields, height: float) -> Fields:
    return {
        "pose": _pose(x, y, height),
        "billboard": True,
        "font_size": _TEXT_SIZE,
        "color": colour,
        "text": text,
    }


def _pose(x: float, y: float, z: float) -> Fields:
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}
