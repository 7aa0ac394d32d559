"""The shots and the predictor that the paper's author published.

His files are in millimetres, millimetres a second and radians; the label is YES
or NO, or 1 or 0; field coordinates may be there or not. Column names are compared
without case, spaces and underscores, so that ``DistanceToGoal`` and
``distance_to_goal`` are one.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from robobt.shots.data.problems import ShotDataError
from robobt.shots.data.schema import COLUMNS, UNKNOWN, VERSION, turned
from robobt.world.geometry import FloatArray

BALL_RADIUS = 0.0215
"""Ball radius in the author's settings [m]."""

ROBOT_RADIUS = 0.100
"""Robot radius in the author's settings [m]; his tolerances are multiples of both together."""

_MM = 1e-3
_LENGTHS = (
    *("robot_x", "robot_y", "ball_x", "ball_y", "target_x", "target_y", "opp_x_global", "opp_y_global"),
    *("robot_vx", "robot_vy", "opp_vx", "opp_vy", "v_towards_ball"),
    *("distance_to_goal", "distance_to_opp", "opp_x", "opp_y"),
)
_ANGLES = ("angle_to_goal",)
_TEXTS = ("scenario", "early_stop_split")
_NEEDED = ("distance_to_goal", "opp_x", "opp_y", "success")
_ALIASES = {
    "distance_to_goal": ("dgoal", "distgoal", "disttogoal", "goaldistance"),
    "angle_to_goal": ("anglegoal", "goalangle"),
    "distance_to_opp": ("dopp", "distopp", "disttoopp", "distancetoopponent", "oppdistance"),
    "opp_x": ("opponentx", "xopp"),
    "opp_y": ("opponenty", "yopp"),
    "opp_vx": ("oppvelx", "oppvelocityx", "oppxvel", "oppxvelocity", "opponentvx", "vxopp", "velx"),
    "opp_vy": ("oppvely", "oppvelocityy", "oppyvel", "oppyvelocity", "opponentvy", "vyopp", "vely"),
    "v_towards_ball": (
        *("veltowardsball", "velocitytowardsball", "speedtowardsball", "oppveltowardsball"),
        *("veltoball", "closingspeed", "closingvelocity", "vtoball"),
    ),
    "robot_vx": ("robotvelx", "robotvelocityx", "robotxvel", "robotxvelocity"),
    "robot_vy": ("robotvely", "robotvelocityy", "robotyvel", "robotyvelocity"),
    "success": ("goal", "label", "result", "scored", "shot", "isgoal", "outcome", "successful"),
}
_LABELS = {"yes": 1, "no": 0, "y": 1, "n": 0, "1": 1, "0": 0, "1.0": 1, "0.0": 0, "true": 1, "false": 0}

Columns = Mapping[str, tuple[int, str]]
"""Columns of this package that a file has: their place in it and their name there."""


def read_author_folder(folder: str | Path) -> tuple[pa.Table, pa.Table]:
    """The author's training and test shots: ``train.csv`` and ``test.csv`` of a folder.

    Raises:
        ShotDataError: one is missing or wrong.
    """
    from robobt.shots.data.files import read_shots

    return read_shots(Path(folder) / "train.csv"), read_shots(Path(folder) / "test.csv")


def author_columns(file: Path, header: list[str]) -> Columns:
    """Which columns a header has.

    Raises:
        ShotDataError: one that every shot needs is missing, or two mean the same.
    """
    names = {
        _plain(alias): name
        for name in (*_LENGTHS, *_ANGLES, *_TEXTS, "tolerance", "success")
        for alias in (name, *_ALIASES.get(name, ()))
    }
    found: dict[str, tuple[int, str]] = {}
    for place, title in enumerate(header):
        name = names.get(_plain(title))
        if name is None:
            continue
        if name in found:
            raise ShotDataError(f"{file}: columns {found[name][1]!r} and {title!r} are both {name!r}")
        found[name] = place, title
    for name in _NEEDED:
        if name not in found:
            raise ShotDataError(f"{file}: has no column {name!r}")
    return found


def author_row(file: Path, number: int, columns: Columns, cells: list[str]) -> dict[str, Any]:
    """One of the author's rows in the package's table, SI units.

    Raises:
        ShotDataError: a cell is wrong.
    """
    row: dict[str, Any] = {column.name: UNKNOWN[column.type] for column in COLUMNS}
    row["schema_version"] = VERSION
    for name, (place, title) in columns.items():
        cell = cells[place].strip()
        where = f"{file}: row {number}, column {title!r}"
        if cell == "" and name in _NEEDED:
            raise ShotDataError(f"{where}: is empty")
        if name in _TEXTS:
            row[name] = cell
        elif cell == "":
            continue
        elif name == "success":
            row[name] = _label(cell, where)
        elif name == "tolerance":
            row[name] = _tolerance(cell, where)
        else:
            row[name] = _number(cell, where) * (1.0 if name in _ANGLES else _MM)
    distance = row["distance_to_goal"]
    # A table in metres read as millimetres would be wrong without a word.
    if not 0.05 <= distance <= 20.0:
        place, title = columns["distance_to_goal"]
        raise ShotDataError(
            f"{file}: row {number}, column {title!r}: {cells[place].strip()} is no distance to the goal in mm"
        )
    if math.isnan(row["distance_to_opp"]):
        row["distance_to_opp"] = math.hypot(row["opp_x"], row["opp_y"])
    side = math.copysign(1.0, row["opp_y"]) if row["opp_y"] else 0.0
    if math.isnan(row["v_towards_ball"]):
        row["v_towards_ball"] = -side * row["opp_vy"]
    elif math.isnan(row["opp_vy"]):
        row["opp_vy"] = -side * row["v_towards_ball"]
    if not math.isnan(row["opp_x_global"]):
        row["opponents_x"], row["opponents_y"] = [row["opp_x_global"]], [row["opp_y_global"]]
    if not math.isnan(angle := row["angle_to_goal"]):
        row["robot_field_vx"], row["robot_field_vy"] = turned(row["robot_vx"], row["robot_vy"], -angle)
        if row["opponents_x"]:
            velocity = turned(row["opp_vx"], row["opp_vy"], -angle)
            row["opponents_vx"], row["opponents_vy"] = [velocity[0]], [velocity[1]]
    return row


def author_weights(path: str | Path) -> dict[str, Any]:
    """The published predictor (``author_predictor.json``): weights, and outputs on the test shots.

    Raises:
        ShotDataError: not such a file.
    """
    file = Path(path)
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ShotDataError(f"{file}: {error}") from error
    if not isinstance(content, dict) or "layers" not in content:
        raise ShotDataError(f"{file}: holds no 'layers'")
    return content


def author_inputs(table: pa.Table) -> FloatArray:
    """The predictor's five inputs as the author's code has them, in mm and rad: (n, 5)."""
    column = {name: table.column(name).to_numpy() for name in ("distance_to_goal", "distance_to_opp")}
    along, across = table.column("opp_x").to_numpy(), table.column("opp_y").to_numpy()
    return np.stack(
        [
            np.abs(np.arctan2(across, along)),
            column["distance_to_goal"] / _MM,
            column["distance_to_opp"] / _MM,
            along / _MM,
            np.abs(across) / _MM,
        ],
        axis=-1,
    )


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", re.sub(r"\(.*?\)|\[.*?\]", "", name.lower()))


def _number(cell: str, where: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ShotDataError(f"{where}: {cell!r} is no number")
    return value


def _label(cell: str, where: str) -> int:
    if cell.lower() not in _LABELS:
        raise ShotDataError(f"{where}: {cell!r} is neither YES nor NO, 1 nor 0")
    return _LABELS[cell.lower()]


def _tolerance(cell: str, where: str) -> float:
    unit = BALL_RADIUS + ROBOT_RADIUS
    if match := re.fullmatch(r"(\d+(?:\.\d+)?)\s*x", cell, re.IGNORECASE):
        return float(match[1]) * unit
    if match := re.fullmatch(r"\+\s*(\d+(?:\.\d+)?)\s*(?:mm)?", cell, re.IGNORECASE):
        return unit + float(match[1]) * _MM
    return _number(cell, where) * _MM
