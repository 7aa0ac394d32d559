"""Which of several places that one object is reported at is believed.

Cameras report false balls, and robots under another robot's number. Detections away from an object's track
are gathered by place. A place takes over when the track is no longer seen, or when the place is
seen more often and more surely than the track.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import exp, hypot, inf
from operator import itemgetter
from typing import Protocol, TypeVar

_EVIDENCE_TIME = 1.0
"""Time constant with which evidence fades, and after which an unseen place is forgotten [s]."""

_EVIDENCE_RATIO = 1.25
"""A rival needs this many times the evidence of the track."""

_EVIDENCE_ALONE = 2.0
"""Sum of confidences that a rival needs where the track is no longer seen."""

_SURE_SHARE = 0.8
"""A detection with less than this share of another's confidence is less sure."""

_WEAK = 0.5
"""A detection with less than this share of the track's usual confidence is weak."""

_CONFIDENCE_SMOOTHING = 0.05
"""Weight of the newest detection in the track's usual confidence."""

_LONGEST_REACH_TIME = 0.035
"""An object that was not seen for longer is expected no further away than after this time [s]."""

_MOST_RIVALS = 16
"""Number of rivals remembered; a flood of false detections must not pile up."""


class _Detection(Protocol):
    """What is needed of a detection."""

    x: float
    y: float
    confidence: float


Seen = TypeVar("Seen", bound=_Detection)


@dataclass(slots=True)
class Evidence:
    """How often and how surely one place is seen, by the camera that sees it best."""

    _sums: dict[int, tuple[float, float]] = field(default_factory=dict)

    def add(self, camera: int, confidence: float, time: float) -> None:
        """Add a detection of one camera at a time [s]."""
        last, value = self._sums.get(camera, (time, 0.0))
        self._sums[camera] = (
            max(time, last),
            value * exp(-max(0.0, time - last) / _EVIDENCE_TIME) + confidence,
        )

    def at(self, time: float) -> float:
        """Return the sum of confidences, faded with age, of the camera with the largest sum."""
        # Not the sum over cameras: a spare ball where two overlap is no surer than the one in play.
        return max(
            (value * exp(-max(0.0, time - last) / _EVIDENCE_TIME) for last, value in self._sums.values()),
            default=0.0,
        )


@dataclass(slots=True)
class _Rival:
    """A place away from the track: since when it is seen, and what was seen since the track last was."""

    x: float
    y: float
    since: float
    time: float
    evidence: Evidence
    detections: int = 0
    confidence: float = 0.0


class Rivals:
    """The places away from an object's track at which it is reported.

    Args:
        confirmations: number of detections at one place, in none of which the track was seen, after which
            the place is believed.
        reach: distance between two detections of one place, if the object does not move.
        speed: how much that grows with the time between them [1/s].
    """

    def __init__(self, confirmations: int, reach: float, speed: float) -> None:
        self._confirmations, self._reach, self._speed = confirmations, reach, speed
        self._known: list[_Rival] = []
        self._evidence = Evidence()
        self._usual = 0.0
        self._track_seen = -inf

    def saw_track(self, camera: int, confidence: float, time: float) -> None:
        """Take in a detection of the track [s]."""
        self._forget(time)
        self._evidence.add(camera, confidence, time)
        self._usual += _CONFIDENCE_SMOOTHING * (confidence - self._usual)
        self._saw_track(time)

    def own(self, seen: Sequence[tuple[float, Seen]], gate: float, track_seen: float) -> Seen | None:
        """Return the detection that is the track's own, None if there is none.

        It is the nearest of those within reach of the track that are not much less sure than another.

        Args:
            seen: distance from the track and detection, of each.
            gate: largest distance of the track's own detection [m].
            track_seen: when the track was last seen [s].
        """
        own = [
            (gap, found)
            for gap, found in seen
            if gap <= self._reach or (gap <= gate and not self._doubts(found, track_seen))
        ]
        surest = max((found.confidence for _, found in own), default=0.0)
        sure = [(gap, found) for gap, found in own if found.confidence >= _SURE_SHARE * surest]
        _, nearest = min(sure, key=itemgetter(0), default=(0.0, None))
        return nearest

    def _doubts(self, found: _Detection, track_seen: float) -> bool:
        """Return whether a detection that the track may have reached is another's.

        It is if it is weak, or if something was seen there while the track was still seen elsewhere.
        """
        rival = self._at(found.x, found.y, track_seen)
        return found.confidence < _WEAK * self._usual or (rival is not None and rival.since < track_seen)

    def believes(
        self,
        x: float,
        y: float,
        camera: int,
        confidence: float,
        time: float,
        track: tuple[float, float] | None = None,
        occupied: bool = False,
        confirmations: int = 0,
    ) -> bool:
        """Take in a detection away from the track; return whether that place is now believed.

        The ``track`` has to be restarted there then, and the place where it was is a rival. An ``occupied``
        place, where another object is tracked, is believed on better evidence only, not because the track
        is no longer seen. ``confirmations``, where given, replaces the usual number.
        """
        self._forget(time)
        rival = self._at(x, y, time)
        if rival is None:
            rival = self._add(_Rival(x, y, time, time, Evidence()))
        rival.x, rival.y, rival.time = x, y, max(time, rival.time)
        rival.evidence.add(camera, confidence, time)
        if time > self._track_seen:
            rival.detections += 1
            rival.confidence += confidence
        own, often = self._evidence.at(time), rival.evidence.at(time)
        enough = max(_EVIDENCE_ALONE, _WEAK * self._usual * rival.detections)
        unseen = rival.detections >= (confirmations or self._confirmations) and rival.confidence >= enough
        if not (unseen and not occupied) and not (
            often >= _EVIDENCE_ALONE and often > _EVIDENCE_RATIO * own > 0.0
        ):
            return False
        self._known.remove(rival)
        if track is not None:
            self._add(_Rival(*track, time, time, self._evidence))
        self._evidence, self._usual = rival.evidence, confidence
        self._saw_track(time)
        return True

    def _saw_track(self, time: float) -> None:
        self._track_seen = max(time, self._track_seen)
        for rival in self._known:
            rival.detections, rival.confidence = 0, 0.0

    def _forget(self, time: float) -> None:
        self._known = [rival for rival in self._known if time - rival.time <= _EVIDENCE_TIME]

    def _add(self, rival: _Rival) -> _Rival:
        if len(self._known) >= _MOST_RIVALS:
            self._known.remove(min(self._known, key=lambda known: known.time))
        self._known.append(rival)
        return rival

    def _at(self, x: float, y: float, time: float) -> _Rival | None:
        nearest: _Rival | None = None
        least = inf
        for rival in self._known:
            gap = hypot(x - rival.x, y - rival.y)
            elapsed = min(_LONGEST_REACH_TIME, max(0.0, time - rival.time))
            if gap <= self._reach + self._speed * elapsed and gap < least:
                nearest, least = rival, gap
        return nearest
