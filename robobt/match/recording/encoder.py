"""Encodes captured ticks as rows of a recording."""

from __future__ import annotations

import json
from collections.abc import Container, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import pyarrow as pa

from robobt.match.recording.capture import Capture, CapturedTick
from robobt.match.recording.header import Event
from robobt.match.recording.numbers import DETECTIONS_TYPE, TickNumbers
from robobt.match.recording.stores import StoreChanges
from robobt.match.recording.stream import RECORDING_COLUMNS
from robobt.tree.recording import TreeChanges
from robobt.world.sketch import Shape

_encode = json.JSONEncoder(ensure_ascii=False, separators=(",", ":"), default=asdict).encode


@dataclass(slots=True)
class EncodedTicks:
    """Some ticks as the columns of a recording.

    Attributes:
        times: times of the ticks [s].
        truth: values of the column ``truth``.
        observed: values of the column ``observed``; the object ``truth`` itself if all ticks are equal.
        commands: values of the column ``commands``.
        changes: the changes of each tick, by the names of
            :class:`~robobt.match.recording.stream.TickChanges`.
        detections: values of the column ``detections``; None if cameras told nothing.
    """

    times: list[float]
    truth: pa.Array
    observed: pa.Array
    commands: pa.Array
    changes: list[dict[str, Any]]
    detections: pa.Array | None = None

    def batch(self) -> pa.RecordBatch:
        """Return the rows."""
        texts = [_encode(changes) if changes else None for changes in self.changes]
        columns = [
            pa.array(self.times),
            self.truth,
            pa.nulls(len(texts), self.truth.type) if self.observed is self.truth else self.observed,
            self.commands,
            # Invalid Unicode, such as half a surrogate pair, becomes a question mark.
            pa.array([text and text.encode("utf-8", "replace") for text in texts], pa.string()),
            pa.nulls(len(texts), DETECTIONS_TYPE) if self.detections is None else self.detections,
        ]
        return pa.RecordBatch.from_arrays(columns, RECORDING_COLUMNS)


class TickEncoder:
    """Encodes all ticks of a capture, in order.

    Args:
        capture: the capture that the ticks come from.
        layers: layers to keep, as other viewers may have enabled more; None for all.
    """

    def __init__(self, capture: Capture, layers: Container[str] | None = None) -> None:
        self._layers = layers
        self._drawn: dict[str, list[Shape]] = {}
        self._trees = [
            (robot, str(robot), TreeChanges(watch))
            for robot, watch in zip(capture.robots, capture.trees.each, strict=True)
        ]
        self._stores = StoreChanges(capture.stores)
        self._numbers = TickNumbers([robot.id for robot in capture.header.robots])

    def encode(self, ticks: Sequence[CapturedTick]) -> EncodedTicks:
        """Return the columns of the next ticks, at least one."""
        truths = [tick.truth for tick in ticks]
        truth = self._numbers.poses(truths)
        observed = [tick.observed for tick in ticks]
        return EncodedTicks(
            [tick.time for tick in ticks],
            truth,
            truth if observed == truths else self._numbers.poses(observed),
            self._numbers.commands([tick.commands for tick in ticks]),
            [self._changes(tick) for tick in ticks],
            self._numbers.detections([(tick.time, tick.detections) for tick in ticks]),
        )

    def _changes(self, tick: CapturedTick) -> dict[str, Any]:
        # Another encoder reads the same ticks, so they must not be changed.
        changes = dict(tick.changes)
        for place, state in tick.states:
            robot, name, tree = self._trees[place]
            change = tree.change(state)
            if change is None:
                continue
            if change.statuses is not None:
                changes.setdefault("statuses", {})[name] = change.statuses
            if change.feedback:
                changes.setdefault("feedback", {})[name] = change.feedback
            if change.error is not None:
                error = Event(round(tick.time, 6), "error", robot.team, robot, change.error)
                changes["events"] = [*changes.get("events", ()), error]
        if self._layers is not None and "drawn" in changes:
            drawn = self._kept(changes.pop("drawn"), self._layers)
            if drawn:
                changes["drawn"] = drawn
        written = self._stores.plain(tick.written) if tick.written else None
        if written:
            changes["written"] = written
        return changes

    def _kept(self, drawn: dict[str, list[Shape]], layers: Container[str]) -> dict[str, list[Shape]]:
        kept = {}
        for name, shapes in drawn.items():
            these = [shape for shape in shapes if shape[0] in layers]
            if these != self._drawn.get(name, []):
                kept[name] = self._drawn[name] = these
        return kept
