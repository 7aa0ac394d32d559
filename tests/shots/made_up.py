"""Shots that nobody took, with goals by a law that predictors can learn."""

from functools import cache

import numpy as np
import pyarrow as pa
import pytest

from robobt.shots.data.schema import SCHEMA, complete_row
from robobt.shots.predict.batched import Recipe

QUICK = Recipe(warm_up=5, epochs=10, patience=3)


def train_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let networks learn for less time than the paper's recipe gives them."""
    monkeypatch.setattr("robobt.shots.predict.network_classifier.Recipe", lambda: QUICK)


@cache
def made_up_table(count: int = 160, seed: int = 0, opponents: int = 1, split: bool = False) -> pa.Table:
    """Shots at a 1 m goal; an opponent saves what it gets within 0.1 m of in the ball's time."""
    rng = np.random.default_rng(seed)
    rows = []
    for i in range(count):
        robot, target = rng.uniform((0.5, -1.5), (2.8, 1.5)), np.array([4.5, rng.uniform(-0.45, 0.45)])
        places = rng.uniform((3.2, -0.6), (4.4, 0.6), (opponents, 2))
        speeds = rng.uniform(-1.0, 1.0, (opponents, 2))
        way = (target - robot) / np.hypot(*(target - robot))
        saved = False
        for place, speed in zip(places, speeds, strict=True):
            x, y = way @ (place - robot), way[0] * (place - robot)[1] - way[1] * (place - robot)[0]
            v = -np.sign(y) * (way[0] * speed[1] - way[1] * speed[0])
            saved |= bool(abs(y) - 0.1 - 0.5 * (1.2 + v) * x / 6.5 < rng.normal(0.0, 0.02))
        recorded = {
            "robot_x": robot[0],
            "robot_y": robot[1],
            "robot_heading": float(np.arctan2(way[1], way[0])),
            "robot_field_vx": 0.1,
            "robot_field_vy": 0.0,
            "robot_omega": 0.0,
            "ball_x": robot[0] + 0.1 * way[0],
            "ball_y": robot[1] + 0.1 * way[1],
            "ball_vx": 0.0,
            "ball_vy": 0.0,
            "target_x": target[0],
            "target_y": target[1],
            "opponents_x": places[:, 0],
            "opponents_y": places[:, 1],
            "opponents_heading": np.zeros(opponents),
            "opponents_vx": speeds[:, 0],
            "opponents_vy": speeds[:, 1],
            "opponents_omega": np.zeros(opponents),
            "early_stop_split": ("train", "train", "valid", "test")[i % 4] if split else "",
            "success": int(not saved),
        }
        rows.append(complete_row(recorded))
    return pa.Table.from_pylist(rows, schema=SCHEMA)
