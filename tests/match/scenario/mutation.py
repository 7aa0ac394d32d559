"""Makes broken and odd scenario files out of valid ones, for the fuzz test.

``mutated(rng, texts)`` gives the bytes of one file: some stay valid, some are wrong in a field. Bytes that
are no YAML at all meet the same reader in the fuzz test of tree files.
"""

from __future__ import annotations

import copy
import random
from collections.abc import Sequence
from io import StringIO
from typing import Any

from ruamel.yaml import YAML

from robobt.config.yaml import parse_marked
from robobt.plays import PLAYS
from robobt.tree.parameters import parameters_of

NUMBERS: tuple[float, ...] = (
    0, -1, 1, 2, 0.5, -0.0, 1e-9, 5e-324, 1e308, -1e308, 10**9, 2**53, 2**63, -(2**64), 10**30,
    float("nan"), float("inf"), float("-inf"),
)  # fmt: skip
STRINGS = (
    "", " ", "x", "ball", "towards ball", "towards goal", "blue 0", "yellow 0", "blue 99", "blue -1",
    "null", "~", "division_a", "division_b", "grsim", "erforce", "default", "nan", "1e5", "0x10", "[]",
    "{}", "&a", "*a", "!!int", "é", "球", "🤖", "\u202e", "\x00", "\x07", "\ud7ff", "a\nb", "a: b", "'", '"',
    "#", "../../etc/passwd", "x" * 5000,
)  # fmt: skip


def mutated(rng: random.Random, texts: Sequence[str]) -> bytes:
    """The bytes of one mutated scenario file."""
    data = parse_marked(rng.choice(texts), "seed").plain()
    for _ in range(rng.choice((0, 1, 1, 1, 2, 2, 3, 5, 8))):
        data = rng.choice(_DATA_MUTATIONS)(rng, data)
    return _dump(rng, data)


def _dump(rng: random.Random, data: Any) -> bytes:
    writer, text = YAML(typ="safe", pure=True), StringIO()
    writer.allow_unicode = rng.random() < 0.5
    writer.default_flow_style = rng.choice((None, True, False))
    writer.dump(data, text)
    return text.getvalue().encode(rng.choice(("utf-8", "utf-8", "utf-8", "utf-16", "latin-1")), "replace")


def _spots(data: Any) -> list[tuple[Any, Any]]:
    """Every (container, key) in the data."""
    spots: list[tuple[Any, Any]] = []
    keys: Any = data.keys() if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    for key in list(keys):
        spots.append((data, key))
        spots += _spots(data[key])
    return spots


def _at_a_spot(change: Any) -> Any:
    def mutate(rng: random.Random, data: Any) -> Any:
        spots = _spots(data)
        if spots:
            change(rng, *rng.choice(spots), data)
        return data

    return mutate


def _drop(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    del container[key]


def _duplicate(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    twin = copy.deepcopy(container[key])
    if isinstance(container, list):
        container.insert(key, twin)
    else:
        container[rng.choice(STRINGS)] = twin


def _rename(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    if isinstance(container, dict):
        value = container.pop(key)
        container[rng.choice((*STRINGS, str(key)[:-1], str(key).upper(), 7, None, True, 1.5))] = value


def _number(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    container[key] = rng.choice(NUMBERS)


def _nudge(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    value = container[key]
    if isinstance(value, bool):
        container[key] = not value
    elif isinstance(value, int):
        container[key] = value + rng.randint(-3, 3)
    elif isinstance(value, float):
        container[key] = value * rng.choice((-1.0, 0.0, 0.5, 0.9, 1.1, 2.0, 10.0))


def _string(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    container[key] = rng.choice(STRINGS)


def _another_type(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    value = container[key]
    container[key] = rng.choice((None, True, False, [], {}, [value], {"a": value}, str(value), [value] * 30))


def _transplant(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    other, at = rng.choice(_spots(data))
    container[key] = copy.deepcopy(other[at])


def _nest(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    for _ in range(rng.choice((3, 15, 19, 25, 60))):
        container[key] = [container[key]] if rng.random() < 0.5 else {"a": container[key]}


def _multiply(rng: random.Random, container: Any, key: Any, data: Any) -> None:
    if isinstance(container[key], list):
        container[key] = [copy.deepcopy(entry) for entry in container[key] * rng.choice((2, 3, 12))]


def _setting(rng: random.Random, data: Any) -> Any:
    """A top-level field with a value of the right kind, often a valid one."""
    if not isinstance(data, dict):
        return data
    field, values = rng.choice(_SETTINGS)
    data[field] = copy.deepcopy(rng.choice(values))
    return data


def _play(rng: random.Random, data: Any) -> Any:
    """A robot with another play, or with any parameter of its play."""
    robots = data.get("robots") if isinstance(data, dict) else None
    teams = (
        [team for team in robots.values() if isinstance(team, list) and team]
        if isinstance(robots, dict)
        else []
    )
    if not teams:
        return data
    robot = rng.choice(rng.choice(teams))
    if not isinstance(robot, dict):
        return data
    if rng.random() < 0.3:
        robot["play"] = rng.choice(list(PLAYS))
        robot["params"] = {}
    play = robot.get("play")
    if isinstance(play, str) and play in PLAYS and isinstance(robot.setdefault("params", {}), dict):
        known = parameters_of(PLAYS[play])
        if known:
            robot["params"][rng.choice(known).name] = rng.choice(
                (*NUMBERS, 0.1, 0.9, 3.0, None, "robobulls", "gaussian")
            )
    return data


_SETTINGS: tuple[tuple[str, tuple[Any, ...]], ...] = (
    (
        "field",
        (
            "division_a",
            "division_b",
            {"length": 6.0, "width": 4.5, "goal_width": 0.8, "defense_width": 1.5, "defense_depth": 0.7},
            {
                "length": 2.0,
                "width": 1.5,
                "goal_width": 0.5,
                "defense_width": 0.6,
                "defense_depth": 0.3,
                "center_radius": 5.0,
            },
            {"length": 50, "width": 50, "goal_width": 20, "defense_width": 50, "defense_depth": 25},
        ),
    ),
    (
        "simulator",
        (
            "default",
            "grsim",
            "rsim",
            "erforce",
            "sumatra",
            "robobulls",
            {"realism": "realistic"},
            {"preset": "grsim", "realism": "friendly"},
            {"ball": {"mass": 0.01}},
            {"kicker": {"max_speed": 20}},
            {"sub_step": 0.001},
            {"realism": {"missing_robot": 1.0, "missing_ball": 1.0, "command_loss": 1.0}},
            {"realism": {"vision_delay": 0.5, "ball_noise": 1.0, "robot_noise": 1.0, "heading_noise": 3.0}},
            {"ball": 3},
            {"ball": {"mass": "heavy"}},
            {"preset": 3},
            {"preset": None},
            {"realism": None},
        ),
    ),
    ("period", (0.005, 0.01, 1 / 60, 0.03, 0.1, 0.0049)),
    (
        "referee",
        (
            True,
            False,
            {},
            {"opening": "force_start"},
            {"stop_time": 0, "placement_delay": 0, "kickoff_wait": 0, "grace": 0},
            {"half_length": 0.05, "half_time": 0},
            {"max_dribble": None},
        ),
    ),
    (
        "ball",
        (
            {"position": [0, 0]},
            {"position": {"x": [-4, 4], "y": [-2, 2]}, "velocity": [20, -20]},
            {"position": {"center": [1, 1], "radius": 0.3}},
            {"held_by": "blue 0"},
            {"held_by": "yellow 1"},
            {"position": [4.5, 3]},
        ),
    ),
    (
        "ends",
        (
            {"time_limit": 5},
            {"time_limit": 5, "held_by_goalkeeper": 0, "ball_at_rest": 0},
            {"time_limit": 0.001},
            {"time_limit": 60, "score_limit": 1},
        ),
    ),
    ("clearance", (0, 0.5, 2)),
    ("seed", (0, 1, 2**53 - 1)),
)

_DATA_MUTATIONS: tuple[Any, ...] = (
    *(_at_a_spot(change) for change in (_drop, _duplicate, _rename, _number, _nudge, _nudge, _nudge, _string,
                                         _another_type, _transplant, _nest, _multiply)),
    _setting, _setting, _setting, _setting, _play, _play, _play,
)  # fmt: skip
