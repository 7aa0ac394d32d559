"""The data of the viewer's page: a constant part, and chunks of ticks.

A replay page has one chunk, all of the recording; a live page is sent one after the other. All
places are in world coordinates; times a robot's ``view``, 1 or -1, they are in that of its own
team, in which its outputs are. Arrays are little-endian and in base64: ``times`` float32 [s];
``ball`` int16 x, y [mm], speed [mm/s], height [mm]; a robot's ``rows`` int16 x, y [mm], heading
[mrad], speed [mm/s]; -32768 off the field. Changes are flat lists whose frame numbers count from the
change before, in a chunk from its own first frame; texts and letters are places in the chunk's tables.
What was drawn is JSON in JSON, for a page reads only that of the moment it shows.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Iterator
from math import isfinite

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from robobt.match.recording import Recording, RecordingHeader, RobotFlag
from robobt.match.recording.capture import FIELD_SKETCHES
from robobt.match.recording.compared import CANDIDATES, Plans, Written, candidates
from robobt.match.recording.recording import Timeline
from robobt.match.recording.stores import plain
from robobt.skills.store import GoalLine
from robobt.world.game import GameState, Team
from robobt.world.rules import own_side
from robobt.world.sketch import Shape

_ABSENT = -(2**15)
_SHOWN_FLAGS = int(RobotFlag.BALL_CONTACT | RobotFlag.DRIBBLER | RobotFlag.KICK)
_GOAL_LINE = "goal_line"


def header_data(header: RecordingHeader, paths: bool = False) -> dict[str, object]:
    """Return the constant part for JSON; with ``paths`` nodes have their ids, for editing."""
    return {
        "scenario": header.scenario,
        "trial": header.trial,
        # As text: a seed may have more digits than a script's numbers hold.
        "seed": str(header.seed),
        "robobt": header.robobt,
        "field": header.field.model_dump(mode="json"),
        "teams": dict(header.teams),
        "robots": [
            {
                "team": robot.team,
                "view": int(-own_side(robot.id.team)),
                "number": robot.number,
                "play": robot.play,
                "radius": robot.radius,
                "mouth": robot.mouth,
                "tree": [
                    [
                        *(node.name, node.type, node.kind, node.depth, node.glyph, node.detail),
                        int(node.condition),
                        *([node.path] if paths else []),
                    ]
                    for node in robot.tree
                ],
            }
            for robot in header.robots
        ],
    }


class ChunkEncoder:
    """Makes the chunks of one match, in order."""

    def __init__(self, header: RecordingHeader) -> None:
        self._header = header
        self._names = [str(robot.id) for robot in header.robots]
        self._published: dict[str, set[tuple[str, str]]] = {name: set() for name in self._names}
        self._plans = {team.value: Plans() for team in Team}

    def chunk(
        self,
        ticks: Recording,
        statuses: list[Timeline[str]],
        feedback: list[Timeline[dict[int, str]]],
        stride: int = 1,
    ) -> dict[str, object]:
        """Return the next ticks, of which every ``stride``-th is shown, as JSON can hold it.

        ``statuses`` and ``feedback`` are those of the ticks' trees, as far as they are shown.
        """
        texts, letters = _Table(), _Table()
        frames = len(ticks.times[::stride])
        x, y, heading, vx, vy = np.moveaxis(ticks.truth.robots[::stride, :, :5], 2, 0)
        rows = _int16(np.stack((x, y, heading, np.hypot(vx, vy)), axis=-1) * 1000.0)
        flags = (ticks.flags[::stride] & _SHOWN_FLAGS).T.tolist()
        robots = []
        for slot, name in enumerate(self._names):
            written, drawn = ticks.written.get(name, []), ticks.drawn.get(name, [])
            robots.append(
                {
                    "rows": _base64(rows[:, slot].tobytes()),
                    "flags": _steps(_runs(flags[slot]), frames, 1),
                    "statuses": _steps(
                        ((tick, letters[word]) for tick, word in statuses[slot]), frames, stride
                    ),
                    "feedback": _feedback_steps(feedback[slot], texts, frames, stride),
                    "written": _written_steps(written, frames, stride),
                    "numbers": self._numbers(name, drawn, frames, stride),
                    "drawn": _steps(_drawings(drawn), frames, stride),
                    "goal_line": _steps(_goal_lines(written, texts), frames, stride),
                    "candidates": _steps(candidates(written), frames, stride),
                }
            )
        ball = ticks.truth.ball[::stride]
        ball_rows = np.column_stack((ball[:, 0], ball[:, 1], np.hypot(ball[:, 2], ball[:, 3]), ball[:, 4]))
        return {
            "frames": frames,
            "times": _base64(ticks.times[::stride].astype("<f4").tobytes()),
            "ball": _base64(_int16(ball_rows * 1000.0).tobytes()),
            "robots": robots,
            "plans": {
                team: _steps(known.follow(ticks.written.get(team, [])), frames, stride)
                for team, known in self._plans.items()
            },
            "drawn": _steps(_drawings(ticks.drawn.get(FIELD_SKETCHES, [])), frames, stride),
            "layers": sorted({it[0] for each in ticks.drawn.values() for _, shapes in each for it in shapes}),
            "games": _steps(((tick, _game(game)) for tick, game in ticks.games), frames, stride),
            "events": [
                [
                    event.time,
                    event.kind,
                    event.team,
                    None if event.robot is None else event.robot.number,
                    event.text,
                ]
                for event in sorted(ticks.events, key=lambda event: event.time)
            ],
            "texts": texts.entries,
            "letters": letters.entries,
        }

    def _numbers(
        self, robot: str, drawn: Timeline[list[Shape]], frames: int, stride: int
    ) -> list[list[object]]:
        """Return the numbers that a robot's skills publish: layer, name, and the changes; null is the end."""
        known, changes = self._published[robot], dict[tuple[str, str], list[tuple[int, object]]]()
        for tick, shapes in drawn:
            now = {(layer, text[0]): value for layer, kind, value, *text in shapes if kind == "number"}
            for name in known - now.keys():
                changes.setdefault(name, []).append((tick, None))
            for name, value in now.items():
                changes.setdefault(name, []).append((tick, value))
            known.clear()
            known |= now.keys()
        return [[*name, _steps(values, frames, stride)] for name, values in changes.items()]


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


def _int16(values: NDArray[np.floating]) -> NDArray[np.int16]:
    """Return rows as whole numbers; one that is not known is absent as a whole."""
    most = 2.0**15 - 1.0
    known = np.isfinite(values).all(axis=-1, keepdims=True)
    whole = np.rint(np.clip(np.where(known, values, 0.0), -most, most))
    return np.where(known, whole, _ABSENT).astype("<i2")


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


def _written_steps(changes: Written, frames: int, stride: int) -> list[object]:
    """Return new values that skills wrote and that are not sent otherwise, merged per frame."""
    by_frame: dict[int, dict[str, JsonValue]] = {}
    for tick, change in changes:
        told = {entry: value for entry, value in change.items() if entry not in (_GOAL_LINE, CANDIDATES)}
        if told:
            by_frame.setdefault(-(-tick // stride), {}).update(told)
    return _steps(((frame * stride, told) for frame, told in by_frame.items()), frames, stride)


def _drawings(changes: Timeline[list[Shape]]) -> Iterator[tuple[int, str]]:
    for tick, shapes in changes:
        yield tick, json.dumps([it for it in shapes if it[1] != "number"], separators=(",", ":"))


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


def _goal_lines(changes: Written, texts: _Table) -> Iterator[tuple[int, tuple[JsonValue, int] | None]]:
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
            # Another skill wrote this entry in its own form, which the page does not show.
            yield tick, None
        else:
            yield tick, found


def _game(game: GameState) -> dict[str, object]:
    return {
        "command": game.command.name,
        "blue": game.blue_score,
        "yellow": game.yellow_score,
        "restart": game.restart,
        "team": game.restart_team,
        "placement": plain(game.placement),
        "stage": game.stage.name,
        "upcoming": None if game.upcoming is None else game.upcoming.name,
        "happened": list(game.events[-5:]),
        "teams": [
            {
                "team": team.value,
                "keeper": game.status(team).keeper,
                "most": game.status(team).max_robots,
                "yellow": game.status(team).yellow_cards,
                "red": game.status(team).red_cards,
                "substituting": game.status(team).substituting,
            }
            for team in Team
        ],
    }
