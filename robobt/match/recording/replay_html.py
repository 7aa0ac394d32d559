"""A recording as one HTML page that needs nothing else: no network, no files beside it.

The page's address may say where to start: ``#t=12.5&robot=blue 3&labels``.
"""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from importlib.resources import files
from math import isfinite
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from robobt.config.errors import naming
from robobt.match.recording import Recording, RobotFlag, load_recording
from robobt.match.recording.compared import CANDIDATES, candidates, plans
from robobt.match.recording.recording import Timeline
from robobt.match.recording.statistics import recorded_statistics
from robobt.match.recording.stores import plain
from robobt.skills.store import GoalLine
from robobt.world.game import GameState
from robobt.world.rules import own_side

MOST_FRAMES = 36_000
"""Frames a page holds, ten minutes at 60 Hz; of a longer recording every second, third, ... is shown."""

MOST_FEEDBACK = 40_000
"""Changes of feedback a page holds as they came; beyond, a node's words change ten times a second at most."""

_ABSENT = -(2**15)
_SHOWN = int(RobotFlag.BALL_CONTACT | RobotFlag.DRIBBLER | RobotFlag.KICK)
_FEEDBACK_PERIOD = 0.1
_GOAL_LINE = "goal_line"

_Written: TypeAlias = Timeline[dict[str, JsonValue]]


def write_html(recording: Recording | str | Path, path: str | Path) -> Path:
    """Write the page of a recording, or of a recording's file, and return where it is."""
    if not isinstance(recording, Recording):
        recording = load_recording(recording)
    path = Path(path)
    with naming(path):
        path.write_text(replay_html(recording), encoding="utf-8")
    return path


def replay_html(recording: Recording) -> str:
    """Return the page: field, robots, ball, timeline, and the tree of the robot that is selected."""
    page = files("robobt.match.recording").joinpath("replay.html").read_text(encoding="utf-8")
    header = recording.header
    title = html.escape(f"{header.scenario or 'match'}, trial {header.trial} · robobt replay")
    # Cut the page before anything is put in: what a recording says may look like a place to fill.
    head, rest = page.split("{{title}}")
    middle, tail = rest.split("{{data}}")
    return f"{head}{title}{middle}{_for_script(page_data(recording))}{tail}"


def _for_script(data: dict[str, object]) -> str:
    """Return JSON that a script element can hold: it has no tag, no comment and no entity in it."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def page_data(recording: Recording) -> dict[str, object]:
    """Return what the page is given, as JSON can hold it.

    All places are in world coordinates; times a robot's ``view``, 1 or -1, they are in that of its own
    team, in which its outputs are. Arrays are little-endian and in base64: ``times`` float32 [s];
    ``ball`` int16 x, y [mm], speed [mm/s], height [mm]; a robot's ``rows`` int16 x, y [mm], heading
    [mrad], speed [mm/s]; -32768 off the field. Changes are flat lists whose frame numbers count from the
    change before.
    """
    header = recording.header
    stride = max(1, -(-len(recording) // MOST_FRAMES))
    texts, letters = _Table(), _Table()
    thin = sum(len(said) for tree in recording.feedback for _, said in tree) > MOST_FEEDBACK
    frames = len(recording.times[::stride])
    statuses = recording.statuses
    robots = []
    for slot, robot in enumerate(header.robots):
        rows = recording.truth.robots[::stride, slot]
        speed = np.hypot(rows[:, 3], rows[:, 4])
        feedback = _thinned(recording, slot) if thin else recording.feedback[slot]
        written = recording.written[str(robot.id)]
        robots.append(
            {
                "team": robot.team,
                "view": int(-own_side(robot.id.team)),
                "number": robot.number,
                "play": robot.play,
                "radius": robot.radius,
                "mouth": robot.mouth,
                "tree": [
                    [node.name, node.type, node.kind, node.depth, node.glyph, node.detail]
                    for node in robot.tree
                ],
                "rows": _int16(np.column_stack((rows[:, 0], rows[:, 1], rows[:, 2], speed)) * 1000.0),
                "flags": _steps(_runs((recording.flags[::stride, slot] & _SHOWN).tolist()), frames, 1),
                "statuses": _steps(((tick, letters[word]) for tick, word in statuses[slot]), frames, stride),
                "feedback": _feedback_steps(feedback, texts, frames, stride),
                "outputs": _steps(_written_texts(written, texts), frames, stride),
                "goal_line": _steps(_goal_lines(written, texts), frames, stride),
                "candidates": _steps(candidates(written), frames, stride),
            }
        )
    ball = recording.truth.ball[::stride]
    ball_rows = np.column_stack((ball[:, 0], ball[:, 1], np.hypot(ball[:, 2], ball[:, 3]), ball[:, 4]))
    return {
        "scenario": header.scenario,
        "trial": header.trial,
        # As text: a seed may have more digits than a script's numbers hold.
        "seed": str(header.seed),
        "robobt": header.robobt,
        "outcome": plain(recording.outcome),
        "field": header.field.model_dump(mode="json"),
        "teams": dict(header.teams),
        "figures": {name: asdict(team) for name, team in recorded_statistics(recording).items()},
        "frames": frames,
        "times": _base64(recording.times[::stride].astype("<f4").tobytes()),
        "ball": _int16(ball_rows * 1000.0),
        "robots": robots,
        "plans": {
            team: _steps(plans(recording.written.get(team, [])), frames, stride)
            for team in ("blue", "yellow")
        },
        "games": _steps(((tick, _game(game)) for tick, game in recording.games), frames, stride),
        "events": [
            [
                event.time,
                event.kind,
                event.team,
                None if event.robot is None else event.robot.number,
                event.text,
            ]
            for event in sorted(recording.events, key=lambda event: event.time)
        ],
        "texts": texts.entries,
        "letters": letters.entries,
    }


class _Table:
    """Texts that come again and again, by number."""

    def __init__(self) -> None:
        self.entries: list[str] = []
        self._places: dict[str, int] = {}

    def __getitem__(self, text: str) -> int:
        place = self._places.setdefault(text, len(self.entries))
        if place == len(self.entries):
            self.entries.append(text)
        return place


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _int16(values: NDArray[np.floating]) -> str:
    most = 2.0**15 - 1.0
    known = np.isfinite(values).all(axis=-1, keepdims=True)
    whole = np.rint(np.clip(np.nan_to_num(values), -most, most))
    return _base64(np.where(known, whole, _ABSENT).astype("<i2").tobytes())


def _runs(values: list[int]) -> Iterable[tuple[int, int]]:
    before = None
    for place, value in enumerate(values):
        if value != before:
            before = value
            yield place, value


def _steps(changes: Iterable[tuple[int, object]], frames: int, stride: int) -> list[object]:
    """Return changes as a flat list of frame differences and values; the last of a frame counts."""
    by_frame: dict[int, object] = {}
    for tick, value in changes:
        # A change between two shown frames is seen from the second one on.
        by_frame[min(frames - 1, -(-tick // stride))] = value
    flat: list[object] = []
    before = 0
    for frame, value in by_frame.items():
        flat += [frame - before, value]
        before = frame
    return flat


def _feedback_steps(changes: Timeline[dict[int, str]], texts: _Table, frames: int, stride: int) -> list[int]:
    by_frame: dict[int, dict[int, str]] = {}
    for tick, said in changes:
        by_frame.setdefault(min(frames - 1, -(-tick // stride)), {}).update(said)
    flat, before = [], 0
    for frame, said in by_frame.items():
        for node, text in said.items():
            flat += [frame - before, node, texts[text]]
            before = frame
    return flat


def _thinned(recording: Recording, slot: int) -> Timeline[dict[int, str]]:
    """Return the feedback of one tree, a node's ten times a second unless the tree changed as well."""
    turns = {tick for tick, _ in recording.letters[slot]}
    times = recording.times.tolist()
    shown: dict[int, float] = {}
    kept = []
    for tick, said in recording.feedback[slot]:
        now = times[tick]
        fresh = {
            node: text
            for node, text in said.items()
            if tick in turns or now - shown.get(node, -1.0) >= _FEEDBACK_PERIOD
        }
        if fresh:
            shown.update(dict.fromkeys(fresh, now))
            kept.append((tick, fresh))
    return kept


def _written_texts(changes: _Written, texts: _Table) -> Iterator[tuple[int, int]]:
    """Give what the skills of a robot have written so far, as one text whenever that changed."""
    written: dict[str, JsonValue] = {}
    for tick, change in changes:
        written.update(change)
        parts = [
            f"{entry} {_say(value)}"
            for entry, value in written.items()
            if value is not None and entry not in (_GOAL_LINE, CANDIDATES)
        ]
        yield tick, texts[" · ".join(parts)]


def _goal_lines(changes: _Written, texts: _Table) -> Iterator[tuple[int, tuple[JsonValue, int] | None]]:
    """Give what a robot thought of the goal line: half its length [mm] and its text, None for nothing."""
    for tick, change in changes:
        if _GOAL_LINE not in change:
            continue
        try:
            line = GoalLine(**change[_GOAL_LINE])  # type: ignore[arg-type]
            reach = float(line.reach) * 1000.0
            if not isfinite(reach):
                raise ValueError("reaches to nowhere")
            found = plain(reach), texts[_base64(base64.b64decode(line.chances))]
        except (TypeError, ValueError):
            # Some other skill's idea of it, which the page shows nothing of.
            yield tick, None
        else:
            yield tick, found


def _say(value: JsonValue) -> str:
    if isinstance(value, dict):
        return ", ".join([f"{key} {_say(item)}" for key, item in value.items()])
    if isinstance(value, list):
        return "(" + ", ".join(map(_say, value)) + ")"
    return f"{value:.3g}" if isinstance(value, float) else "none" if value is None else str(value)


def _game(game: GameState) -> dict[str, object]:
    return {
        "command": game.command.name,
        "blue": game.blue_score,
        "yellow": game.yellow_score,
        "restart": game.restart,
        "team": game.restart_team,
        "placement": plain(game.placement),
    }
