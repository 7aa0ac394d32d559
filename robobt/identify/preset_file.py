"""What was identified, as a file of simulator settings that matches and training can start from."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from robobt.config.atomic import write_atomically
from robobt.config.yaml import write_yaml
from robobt.identify.estimate import Estimate
from robobt.identify.report import Identification
from robobt.identify.robot_motion import DRIVE_PARAMETERS
from robobt.sim.settings import PRESETS

_SIGNIFICANT_DIGITS = 4
"""Significant digits in the file."""

_LIMITS = DRIVE_PARAMETERS[1:]
"""Fields of a robot's limits that are identified: all but its delay."""

_RATES = frozenset({"acceleration", "braking", "side_acceleration", "side_braking"})
"""Limits that are identified as an ellipse, which joins the axes."""

_MOST_HOPS = {"first_hop": 1.0, "other_hops": 1.0, "rebound": 0.95}
"""Greatest values of a ball's hops in settings."""

_SMALLEST = {"ball_noise": 2e-5, "robot_noise": 2e-5, "heading_noise": 1e-4, "vision_delay": 1e-4}
"""What is smaller than this is 0 in the file [m, m, rad, s]: a recording's numbers are not finer."""

_AT_LEAST = {"cross_ahead": -0.5, "cross_aside": -0.5}
"""Least values of limits, where that is not 0."""


def preset_of(identified: Identification, base: str = "default") -> dict[str, object]:
    """Return simulator settings with what was identified; the rest is that of a preset.

    The limits are the medians of the robots whose commands were known, or of all robots without such. A whole
    delay that was identified stands in place of all delays of the preset; what wheels are late by themselves
    is part of it.

    Args:
        identified: what was identified.
        base: the preset that has everything else.

    Returns:
        settings as a scenario file holds them under ``simulator``.
    """
    ball = {
        name: _rounded(figure)
        for name in ("slide_deceleration", "roll_deceleration", "switch_share")
        if (figure := getattr(identified.ball, name)).seen
    }
    ball |= {
        name: min(_rounded(figure), _MOST_HOPS[name])
        for name, figure in identified.hops._asdict().items()
        if figure.seen
    }
    realism = {
        name: _rounded(figure)
        for name, figure in (
            ("ball_noise", identified.ball.noise),
            *identified.noise._asdict().items(),
            ("object_offset", identified.cameras.size),
        )
        if figure.seen
    }
    own = [robot for robot in identified.robots if robot.commanded] or list(identified.robots)
    limits: dict[str, object] = {}
    for name in _LIMITS:
        values = [robot.figures[name].value for robot in own if robot.figures[name].seen]
        if values:
            limits[name] = _digits(max(float(np.median(values)), _AT_LEAST.get(name, 0.0)))
    if PRESETS[base].limits.separate_axes and _RATES & limits.keys():
        limits["separate_axes"] = False
    if identified.delay.seen:
        by_wheels = _delay_of_wheels(base)
        # A team cannot distinguish late pictures from late commands and robots.
        rest = max(0.0, identified.delay.value - by_wheels)
        realism |= {"vision_delay": _digits(rest), "command_delay": 0.0}
        limits |= {"dead_time": 0.0, "reaction": by_wheels}
    realism |= {name: 0.0 for name, least in _SMALLEST.items() if realism.get(name, least) < least}
    settings: dict[str, object] = {"preset": base}
    kicks = identified.kicks
    kept, returned, carried = kicks.kept, kicks.returned, kicks.carried
    if kept.seen:
        limits["touch_kept"] = _digits(min(max(kept.value, 0.0), 1.0))
    if carried.seen:
        limits["kick_carried"] = _digits(carried.value)
    if returned.seen:
        limits["touch_returned"] = _digits(min(max(returned.value, 0.0), 1.0))
    for name, part in (("ball", ball), ("limits", limits), ("realism", realism)):
        if part:
            settings[name] = part
    return settings


def taken_from(identified: Identification, base: str) -> dict[str, object]:
    """Return what a preset file takes from its preset because it was not identified, by dotted names.

    What the preset ``default`` has too is left out.

    Args:
        identified: what was identified.
        base: the preset.
    """
    own = set(_flat(preset_of(identified, base)))
    usual = _flat(PRESETS["default"].model_dump())
    return {
        name: value
        for name, value in _flat(PRESETS[base].model_dump()).items()
        if name not in own and (name not in usual or usual[name] != value)
    }


def write_preset(identified: Identification, path: Path, base: str = "default") -> None:
    """Write a preset file, with every figure and its interval as comments.

    Args:
        identified: what was identified.
        path: of the file, whose name ends in ``.yaml``; replaced if it exists.
        base: the preset that has everything else.

    Raises:
        OSError: the file cannot be written.
    """
    comments = [f"# {name}: {figure.text()}" for name, figure in identified.figures()]
    taken = taken_from(identified, base)
    if taken:
        comments += ["#", f"# Not identified, from the preset {base}; default has other values:"]
        comments += [f"# {name}: {value}" for name, value in taken.items()]
    head = [
        f"# Identified by robobt from {identified.seconds:.0f} s of play: value (95 % interval).",
        "# robobt match SCENARIO --set simulator.preset=THIS_FILE plays in it.",
        "#",
        *comments,
        "",
    ]
    write_atomically(path, "\n".join(head) + write_yaml(preset_of(identified, base)))


def _delay_of_wheels(base: str) -> float:
    """Return by how much robots with a preset's wheels are late whatever the settings say [s]."""
    settings = PRESETS[base]
    return 0.0 if settings.wheels is None else settings.limits.reaction


def _flat(settings: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """Return nested settings by dotted names."""
    flat: dict[str, object] = {}
    for name, value in settings.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{name}.")
        else:
            flat[f"{prefix}{name}"] = value
    return flat


def _rounded(figure: Estimate) -> float:
    return _digits(figure.value)


def _digits(value: float) -> float:
    return float(f"{value:.{_SIGNIFICANT_DIGITS}g}")
