"""The shots that the paper's author published.

His files are in millimetres, millimetres a second and radians; the label is YES
or NO, or 1 or 0; field coordinates may be missing. Column titles are compared
without case, spaces and underscores: ``DistanceToGoal`` is ``distance_to_goal``.
"""

from __future__ import annotations

import math
import re

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from robobt.shots.data.cells import Cells
from robobt.shots.data.schema import SCHEMA, SHOT_COLUMNS, SHOTS_VERSION, UNKNOWN, ShotDataError, turned
from robobt.world.geometry import FloatArray

AUTHORS_BALL_RADIUS = 0.0215
"""Ball radius in the author's settings [m]."""

AUTHORS_ROBOT_RADIUS = 0.100
"""Robot radius in the author's settings [m]; his tolerances are multiples of both together."""

_MILLIMETRE = 1e-3
_LENGTHS = (
    *("robot_x", "robot_y", "ball_x", "ball_y", "target_x", "target_y", "opp_x_global", "opp_y_global"),
    *("robot_vx", "robot_vy", "opp_vx", "opp_vy", "v_towards_ball"),
    *("distance_to_goal", "distance_to_opp", "opp_x", "opp_y"),
)
_TEXTS = ("scenario", "early_stop_split")
_REQUIRED = ("distance_to_goal", "opp_x", "opp_y", "success")
_LABELS = {"yes": 1, "no": 0, "1": 1, "0": 0}


def author_table(cells: Cells) -> pa.Table:
    """Return the author's shots in the package's table, SI units.

    Raises:
        ShotDataError: a column that every shot needs is missing, two mean the same, or a cell is wrong.
    """
    names = {_plain(name): name for name in (*_LENGTHS, "angle_to_goal", *_TEXTS, "tolerance", "success")}
    titles: dict[str, str] = {}
    for title in cells.columns:
        if (name := names.get(_plain(title))) is None:
            continue
        if name in titles:
            raise ShotDataError(f"{cells.file}: columns {titles[name]!r} and {title!r} are both {name!r}")
        titles[name] = title
    for name in _REQUIRED:
        if name not in titles:
            raise ShotDataError(f"{cells.file}: has no column {name!r}")
    parsers = {
        **dict.fromkeys(_LENGTHS, _length),
        **dict.fromkeys(("opp_x", "opp_y"), _required_length),
        "distance_to_goal": _distance,
        "angle_to_goal": _angle,
        "tolerance": _tolerance,
    }
    count = len(cells.rows)
    real = {
        name: np.array(cells.convert(titles[name], parse, math.nan) if name in titles else [math.nan] * count)
        for name, parse in parsers.items()
    }

    def complete(name: str, otherwise: FloatArray) -> None:
        real[name] = np.where(np.isnan(real[name]), otherwise, real[name])

    side = np.sign(real["opp_y"])
    complete("distance_to_opp", np.hypot(real["opp_x"], real["opp_y"]))
    complete("v_towards_ball", -side * real["opp_vy"])
    complete("opp_vy", -side * real["v_towards_ball"])
    angle = real["angle_to_goal"]
    real["robot_field_vx"], real["robot_field_vy"] = turned(real["robot_vx"], real["robot_vy"], -angle)
    velocity = turned(real["opp_vx"], real["opp_vy"], -angle)
    placed, turnable = ~np.isnan(real["opp_x_global"]), ~np.isnan(angle)
    lists = {
        "opponents_x": _singles(real["opp_x_global"], placed),
        "opponents_y": _singles(real["opp_y_global"], placed),
        "opponents_vx": _singles(velocity[0], placed & turnable),
        "opponents_vy": _singles(velocity[1], placed & turnable),
    }
    known = {
        "schema_version": [SHOTS_VERSION] * count,
        "success": cells.convert(titles["success"], _label, 0),
        **{name: cells.columns[titles[name]] for name in _TEXTS if name in titles},
        **real,
        **lists,
    }
    return pa.Table.from_pydict(
        {column.name: known.get(column.name, [UNKNOWN[column.type]] * count) for column in SHOT_COLUMNS},
        SCHEMA,
    )


def _singles(values: FloatArray, there: NDArray[np.bool_]) -> list[list[float]]:
    return [[value] if known else [] for value, known in zip(values.tolist(), there.tolist(), strict=True)]


def _plain(title: str) -> str:
    return re.sub(r"[^a-z0-9]", "", title.lower())


def _angle(cell: str) -> float:
    return _number(cell) if cell else math.nan


def _length(cell: str) -> float:
    return _angle(cell) * _MILLIMETRE


def _required_length(cell: str) -> float:
    if not cell:
        raise ValueError("is empty")
    return _length(cell)


def _distance(cell: str) -> float:
    distance = _required_length(cell)
    # A table in metres that is read as millimetres would be wrong without anybody noticing.
    if not 0.05 <= distance <= 20.0:
        raise ValueError(f"{cell} is not a distance to the goal in mm")
    return distance


def _number(cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{cell!r} is not a number")
    return value


def _label(cell: str) -> int:
    if not cell:
        raise ValueError("is empty")
    if cell.lower() not in _LABELS:
        raise ValueError(f"{cell!r} is neither YES nor NO, 1 nor 0")
    return _LABELS[cell.lower()]


def _tolerance(cell: str) -> float:
    unit = AUTHORS_BALL_RADIUS + AUTHORS_ROBOT_RADIUS
    if match := re.fullmatch(r"(\d+(?:\.\d+)?)x", cell):
        return float(match[1]) * unit
    if match := re.fullmatch(r"\+(\d+(?:\.\d+)?)mm", cell):
        return unit + float(match[1]) * _MILLIMETRE
    return _length(cell)
