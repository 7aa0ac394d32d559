"""From the table of shots to the arrays that predictors learn from."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from robobt.world.features import ABSENT, SCENE_HEAD, SCENE_OPPONENTS, SHOT_SCENE, shot_scene
from robobt.world.geometry import FloatArray

PLACE_COLUMNS = ("robot_x", "target_x")
"""Columns that say whether a shot's field coordinates were recorded."""

_KINEMATICS = ("x", "y", "heading", "field_vx", "field_vy", "omega")
_UNRECORDED_BALL_AHEAD = 0.11
"""Shooter's centre to a ball in its mouth [m]."""
_OPPONENT_COLUMNS = ("x", "y", "heading", "vx", "vy", "omega")


def shot_inputs(table: pa.Table) -> FloatArray:
    """Return what every predictor takes: the scene of each shot of ``table`` (n, 34), see :data:`SHOT_SCENE`.

    Shots whose field coordinates were not recorded give the entries that the shot
    frame's columns hold, with their one opponent; the others are not-a-number, so
    that a predictor that needs them refuses the data.
    """
    scenes = _from_shot_frame(table)
    placed = np.logical_and(*[np.isfinite(table.column(name).to_numpy()) for name in PLACE_COLUMNS])
    counts = np.array([len(entry) for entry in table.column("opponents_x").to_pylist()])
    moving = np.array([len(entry) for entry in table.column("opponents_vx").to_pylist()]) == counts
    # Rows with equally many opponents are worked out together.
    for count in np.unique(counts[placed & moving]):
        rows = np.flatnonzero(placed & moving & (counts == count))
        scenes[rows] = _from_field(table.take(pa.array(rows)), int(count))
    return scenes


def asked_inputs(table: pa.Table) -> FloatArray:
    """Return the scenes (n, 34) as a rater in play asks about them; only unknown velocities stay unknown.

    Where it was not recorded, the shooter points at its target with the ball before it, which
    moves with it.
    """
    scenes = shot_inputs(table)
    index = {entry.name: i for i, entry in enumerate(SHOT_SCENE.entries)}
    along, across = scenes[:, index["shooter_v_along"]], scenes[:, index["shooter_v_across"]]
    for name, otherwise in (
        ("target_offset", 0.0),
        ("turn", 0.0),
        ("ball_along", _UNRECORDED_BALL_AHEAD),
        ("ball_across", 0.0),
        ("ball_v_along", along),
        ("ball_v_across", across),
    ):
        column = scenes[:, index[name]]
        scenes[:, index[name]] = np.where(np.isnan(column), otherwise, column)
    return scenes


def goals(table: pa.Table) -> NDArray[np.int64]:
    """Return which shots of ``table`` scored: (n,) of 1 and 0."""
    return np.asarray(table.column("success").to_numpy(), dtype=np.int64)


def _from_field(table: pa.Table, count: int) -> FloatArray:
    shooter = np.stack([_column(table, f"robot_{name}") for name in _KINEMATICS], axis=-1)
    ball = np.stack([_column(table, f"ball_{name}") for name in ("x", "y", "vx", "vy")], axis=-1)
    target = np.stack([_column(table, "target_x"), _column(table, "target_y")], axis=-1)
    opponents = np.full((len(table), count, 6), np.nan)
    for i, name in enumerate(_OPPONENT_COLUMNS):
        lists = table.column(f"opponents_{name}").to_pylist()
        if count and all(len(entry) == count for entry in lists):
            opponents[:, :, i] = lists
    return shot_scene(shooter, ball, target, opponents)


def _from_shot_frame(table: pa.Table) -> FloatArray:
    scenes = np.full((len(table), SHOT_SCENE.size), np.nan)
    names = [entry.name for entry in SHOT_SCENE.entries]
    for entry, name in (
        ("target_distance", "distance_to_goal"),
        ("target_angle", "angle_to_goal"),
        ("shooter_v_along", "robot_vx"),
        ("shooter_v_across", "robot_vy"),
        ("opponent_0_along", "opp_x"),
        ("opponent_0_across", "opp_y"),
        ("opponent_0_v_along", "opp_vx"),
        ("opponent_0_v_across", "opp_vy"),
    ):
        scenes[:, names.index(entry)] = _column(table, name)
    scenes[:, SCENE_HEAD + 4 :] = np.tile(ABSENT, SCENE_OPPONENTS - 1)
    nobody = np.isnan(scenes[:, SCENE_HEAD])
    scenes[nobody, SCENE_HEAD : SCENE_HEAD + 4] = ABSENT
    return scenes


def _column(table: pa.Table, name: str) -> FloatArray:
    return np.asarray(table.column(name).to_numpy(), dtype=np.float64)
