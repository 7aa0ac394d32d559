"""The table of shots: one row a shot, its columns with units and meaning.

The columns of the real data keep their names and their meaning, in SI units;
beside them stands what the real data lacks: the field-frame state of everyone,
the ball's state and offset, what the kick did, and where the row comes from.
Lengths in metres, speeds in m/s, angles in radians, counter-clockwise positive.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike

from robobt.config.errors import RobobtError
from robobt.world.geometry import FloatArray


class ShotDataError(RobobtError, ValueError):
    """A file of shots is invalid; the message names the file, the row and the column."""


SHOTS_VERSION = 1
"""Of this table; in every row, so that a file says which one it holds."""


class Column(NamedTuple):
    """A column: its name, type, unit and meaning.

    Types are ``text``, ``int``, ``real`` and ``reals``, a list of numbers with one
    entry a robot. A ``real`` that is not known is not-a-number, a text is empty.
    """

    name: str
    type: str
    unit: str
    meaning: str


SHOT_COLUMNS = (
    Column("schema_version", "int", "1", "version of this table"),
    # Where the row comes from.
    Column("scenario", "text", "", "collection scenario: motion, still, or the name of another"),
    Column(
        "variant",
        "text",
        "",
        "range the attacker shoots from (mid_range, close_range) or its section; at_kick, recorded: the "
        "trial begins with the kick, from anywhere or from where recorded shots come from",
    ),
    Column("seed", "int", "1", "seed of the collection; -1 where not recorded"),
    Column("trial", "int", "1", "trial of the collection that the shot was taken in; -1 where not recorded"),
    Column("early_stop_split", "text", "", "train, valid (for early stopping) or test; may be empty"),
    Column("tolerance", "real", "m", "clearance that the attacker asked of the line ball -> target"),
    Column("goalkeeper_speed", "real", "1", "factor on the top speed of the opponents' goalkeeper"),
    Column("goalkeeper", "text", "", "kind of goalkeeper, of GOALKEEPERS; empty where not known"),
    Column("time", "real", "s", "simulated time of the kick in its trial"),
    # The scene at the kick, in the field frame: the shooter attacks +x.
    Column("robot_x", "real", "m", "shooter"),
    Column("robot_y", "real", "m", "shooter"),
    Column("robot_heading", "real", "rad", "shooter"),
    Column("robot_field_vx", "real", "m/s", "shooter's velocity, field frame"),
    Column("robot_field_vy", "real", "m/s", "shooter's velocity, field frame"),
    Column("robot_omega", "real", "rad/s", "shooter's turning rate"),
    Column("ball_x", "real", "m", "ball"),
    Column("ball_y", "real", "m", "ball"),
    Column("ball_vx", "real", "m/s", "ball's velocity before the kick, field frame"),
    Column("ball_vy", "real", "m/s", "ball's velocity before the kick, field frame"),
    Column("ball_forward", "real", "m", "ball from the shooter's centre along its heading"),
    Column("ball_left", "real", "m", "ball from the shooter's centre to the left of its heading"),
    Column("target_x", "real", "m", "point the shooter aims at"),
    Column("target_y", "real", "m", "point the shooter aims at"),
    Column("opponents_x", "reals", "m", "every opponent"),
    Column("opponents_y", "reals", "m", "every opponent"),
    Column("opponents_heading", "reals", "rad", "every opponent"),
    Column("opponents_vx", "reals", "m/s", "every opponent's velocity, field frame"),
    Column("opponents_vy", "reals", "m/s", "every opponent's velocity, field frame"),
    Column("opponents_omega", "reals", "rad/s", "every opponent's turning rate"),
    Column("mates_x", "reals", "m", "every robot of the shooter's team but the shooter"),
    Column("mates_y", "reals", "m", "every robot of the shooter's team but the shooter"),
    Column("mates_vx", "reals", "m/s", "their velocity, field frame"),
    Column("mates_vy", "reals", "m/s", "their velocity, field frame"),
    # The opponent that matters, the one nearest to the line shooter -> target.
    Column("opp_x_global", "real", "m", "that opponent, field frame"),
    Column("opp_y_global", "real", "m", "that opponent, field frame"),
    # The shot frame: origin at the shooter, first axis along shooter -> target.
    Column("robot_vx", "real", "m/s", "shooter's velocity, shot frame"),
    Column("robot_vy", "real", "m/s", "shooter's velocity, shot frame"),
    Column("angle_to_goal", "real", "rad", "direction shooter -> target, field frame"),
    Column("distance_to_goal", "real", "m", "shooter to target"),
    Column("distance_to_opp", "real", "m", "shooter to that opponent"),
    Column("opp_x", "real", "m", "that opponent, shot frame, along the shot"),
    Column("opp_y", "real", "m", "that opponent, shot frame, across the shot, left positive"),
    Column("opp_vx", "real", "m/s", "its velocity, shot frame"),
    Column("opp_vy", "real", "m/s", "its velocity, shot frame"),
    Column("v_towards_ball", "real", "m/s", "its speed towards the shot line: -sign(opp_y) opp_vy"),
    # What became of it.
    Column("kick_speed", "real", "m/s", "ball's speed after the kick"),
    Column("kick_error", "real", "rad", "ball's direction after the kick minus direction ball -> target"),
    Column("outcome", "text", "", "goal, saved, blocked, wide, stopped or another end; may be empty"),
    Column("success", "int", "1", "1 the ball entered the goal, 0 it did not"),
)
"""Every column, in the order of the files."""

GOALKEEPERS = ("fitted", "robobulls", "half_speed", "full_speed")
"""The kinds of goalkeepers that shots are collected against.

As the paper's real shots show them; with RoboBulls' pilot; and our own at 1.125 and at 2.25 m/s.
"""

LATER_COLUMNS = frozenset({"goalkeeper"})
"""Columns that older files lack; they are unknown there."""

_ARROW_TYPES = {"text": pa.string(), "int": pa.int64(), "real": pa.float64(), "reals": pa.list_(pa.float64())}

SCHEMA = pa.schema(
    [
        pa.field(c.name, _ARROW_TYPES[c.type], metadata={"unit": c.unit, "description": c.meaning})
        for c in SHOT_COLUMNS
    ],
    metadata={"robobt_shots": str(SHOTS_VERSION)},
)
"""The same for pyarrow; a column's unit and description are its metadata, kept in Parquet."""

RECORDED = frozenset(
    column.name
    for column in SHOT_COLUMNS
    if column.name
    not in {
        *("schema_version", "ball_forward", "ball_left", "opp_x_global", "opp_y_global"),
        *("robot_vx", "robot_vy", "angle_to_goal", "distance_to_goal", "distance_to_opp"),
        *("opp_x", "opp_y", "opp_vx", "opp_vy", "v_towards_ball"),
    }
)
"""What a collector records; :func:`complete_row` works out the rest."""

Row = dict[str, Any]
"""A shot: values by column, of the types that :data:`SHOT_COLUMNS` says."""

AS_RECORDED = "recorded"
"""The ``variant`` of simulated shots whose scenes are distributed as those of the paper's real shots."""

UNKNOWN: Row = {"text": "", "int": -1, "real": math.nan, "reals": ()}
"""What stands for an unknown value, by a column's type."""


def complete_row(recorded: Row) -> Row:
    """Return a row of the table from what was recorded at the kick.

    The opponent that matters is the one nearest to the segment shooter -> target.

    Args:
        recorded: values of :data:`RECORDED` columns by name; those left out are
            unknown, save the shooter's and the target's position and ``success``.

    Raises:
        ValueError: a column that is not recorded, or one that is needed is missing.
    """
    if strange := sorted(set(recorded) - RECORDED):
        raise ValueError(f"{strange[0]!r} is not a column that is recorded of a shot")
    needed = ("robot_x", "robot_y", "target_x", "target_y", "success")
    if missing := [name for name in needed if name not in recorded]:
        raise ValueError(f"a shot needs {missing[0]!r}")
    row: Row = {column.name: UNKNOWN[column.type] for column in SHOT_COLUMNS}
    row.update(recorded, schema_version=SHOTS_VERSION)
    for column in SHOT_COLUMNS:
        if column.type == "reals":
            row[column.name] = [float(value) for value in row[column.name]]
    origin = np.array([row["robot_x"], row["robot_y"]], dtype=np.float64)
    target = np.array([row["target_x"], row["target_y"]], dtype=np.float64)
    dx, dy = target - origin
    angle = float(np.arctan2(dy, dx))
    row["angle_to_goal"], row["distance_to_goal"] = angle, float(np.hypot(dx, dy))
    row["robot_vx"], row["robot_vy"] = map(float, turned(row["robot_field_vx"], row["robot_field_vy"], angle))
    ball_x, ball_y = row["ball_x"] - row["robot_x"], row["ball_y"] - row["robot_y"]
    row["ball_forward"], row["ball_left"] = map(float, turned(ball_x, ball_y, row["robot_heading"]))
    if row["opponents_x"]:
        places = np.stack([row["opponents_x"], row["opponents_y"]], axis=-1)
        which = nearest_to_line(origin, target, places)
        row["opp_x_global"], row["opp_y_global"] = (float(value) for value in places[which])
        offset_x, offset_y = (places[which] - origin).tolist()
        along, across = map(float, turned(offset_x, offset_y, angle))
        row["opp_x"], row["opp_y"] = along, across
        row["distance_to_opp"] = float(np.hypot(along, across))
        vx, vy = (row[name][which] if row[name] else math.nan for name in ("opponents_vx", "opponents_vy"))
        row["opp_vx"], row["opp_vy"] = map(float, turned(vx, vy, angle))
        row["v_towards_ball"] = -float(np.sign(across)) * row["opp_vy"]
    return row


def nearest_to_line(origin: ArrayLike, target: ArrayLike, opponents: ArrayLike) -> int:
    """Return the index of the one of the (K, 2) opponents that is nearest to the segment origin -> target."""
    start = np.asarray(origin, dtype=np.float64)
    way = np.asarray(target, dtype=np.float64) - start
    offsets = np.asarray(opponents, dtype=np.float64) - start
    length = float(way @ way)
    share = np.clip(offsets @ way / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(offsets))
    gaps = offsets - share[:, None] * way
    return int(np.argmin(np.hypot(gaps[:, 0], gaps[:, 1])))


def turned(
    x: float | FloatArray, y: float | FloatArray, angle: float | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return field-frame vectors in a frame whose first axis points along ``angle``."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.asarray(cos * x + sin * y), np.asarray(cos * y - sin * x)
