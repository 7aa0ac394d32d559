"""By how much each camera sees things shifted, from what two cameras saw at once.

What all cameras share cannot be seen, so a camera's offset counts from the mean of those cameras that it is
compared with, over others if need be.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from math import hypot, sqrt
from typing import NamedTuple

import numpy as np

from robobt.identify.estimate import Estimate, from_error, not_negative, quantile, unseen
from robobt.identify.observations import CameraViews
from robobt.world.geometry import FloatArray

_LONGEST_SIGHT_GAP = 0.05
"""A thing is where it is between two detections of a camera that are at most this far apart [s]."""

_SIGHT_BLOCK, _LEAST_IN_BLOCK = 1.0, 5
"""What two cameras see of one thing within this time counts once [s], if they see it this often together."""

_LEAST_BLOCKS = 5
"""Number of such times below which a camera's offset is not seen enough."""

_MOST_OFFSET_ERROR = 0.01
"""Half width of an interval beyond which an offset is not seen enough [m]."""

_REWEIGHTINGS, _LARGE_DIFFERENCE = 10, 2.5
"""A difference beyond this many standard deviations, such as that of a ball in the air, counts less."""

_LEAST_DIFFERENCE = 1e-4
"""Least such standard deviation [m]."""


class CameraOffset(NamedTuple):
    """By how much a camera sees things shifted, less what all cameras share, in world coordinates.

    Attributes:
        x: along x [m].
        y: along y [m].
    """

    x: Estimate
    y: Estimate


class CameraEstimate(NamedTuple):
    """The systematic errors of cameras.

    Attributes:
        offsets: each camera's, by number; empty where there is a single view.
        size: root mean square of the offsets' lengths [m].
    """

    offsets: dict[int, CameraOffset]
    size: Estimate


class _Difference(NamedTuple):
    """Where one camera saw a thing, less where another did, (2,) [m], over one block of time."""

    camera: int
    other: int
    apart: FloatArray


def identify_cameras(views: CameraViews | None) -> CameraEstimate:
    """Identify by how much each camera sees things shifted.

    Args:
        views: what each camera saw; None for a single view.

    Returns:
        the offsets, each with its interval; that of a camera that never saw something together with another
        is not seen enough.
    """
    if views is None:
        return CameraEstimate({}, unseen(0, "m"))
    numbers = sorted(set(views.cameras.tolist()))
    if len(numbers) < 2:
        return CameraEstimate({}, unseen(0, "m"))
    offsets = {camera: CameraOffset(unseen(0, "m"), unseen(0, "m")) for camera in numbers}
    differences = list(_differences(views))
    for cameras in _connected(differences):
        own = [it for it in differences if it.camera in cameras]
        offsets |= _offsets(cameras, own)
    return CameraEstimate(offsets, _size(list(offsets.values())))


def _differences(views: CameraViews) -> Iterator[_Difference]:
    """Yield what cameras say differently of robots and ball."""
    things = [views.ball, *views.poses[:, :, :2].transpose(1, 0, 2)]
    cameras = sorted(set(views.cameras.tolist()))
    for thing in things:
        known = np.isfinite(thing[:, 0])
        tracks = {camera: np.flatnonzero(known & (views.cameras == camera)) for camera in cameras}
        for i, camera in enumerate(cameras):
            for other in cameras[i + 1 :]:
                if len(tracks[camera]) and len(tracks[other]) > 1:
                    yield from _between(views.times, thing, tracks, camera, other)


def _between(
    times: FloatArray, thing: FloatArray, tracks: dict[int, np.ndarray], camera: int, other: int
) -> Iterator[_Difference]:
    """Yield the differences of two cameras about one thing, a block of time each."""
    own, track = tracks[camera], tracks[other]
    after = np.clip(np.searchsorted(times[track], times[own]), 1, len(track) - 1)
    early, late = track[after - 1], track[after]
    step = times[late] - times[early]
    share = (times[own] - times[early]) / np.maximum(step, 1e-9)
    good = (step > 0.0) & (step < _LONGEST_SIGHT_GAP) & (share >= -1e-6) & (share <= 1.0 + 1e-6)
    apart = thing[own] - thing[early] - share[:, None] * (thing[late] - thing[early])
    blocks = np.floor((times[own] - times[0]) / _SIGHT_BLOCK)
    for block in np.unique(blocks[good]):
        inside = good & (blocks == block)
        if inside.sum() >= _LEAST_IN_BLOCK:
            yield _Difference(camera, other, np.median(apart[inside], axis=0))


def _connected(differences: list[_Difference]) -> list[list[int]]:
    """Return the groups of cameras that can be compared, each sorted."""
    group: dict[int, set[int]] = defaultdict(set)
    for it in differences:
        joined = {it.camera, it.other} | group[it.camera] | group[it.other]
        for camera in joined:
            group[camera] = joined
    return [list(it) for it in {tuple(sorted(cameras)) for cameras in group.values()}]


def _offsets(cameras: list[int], differences: list[_Difference]) -> dict[int, CameraOffset]:
    """Return the offsets of cameras that can be compared: least squares, in which outliers count less."""
    count = len(differences)
    rows = np.zeros((count + 1, len(cameras)))
    for row, it in zip(rows, differences, strict=False):
        row[cameras.index(it.camera)], row[cameras.index(it.other)] = 1.0, -1.0
    # Their sum is 0.
    rows[-1] = 1.0
    apart = np.array([*[it.apart for it in differences], np.zeros(2)])
    weights = np.ones(count + 1)
    for _ in range(_REWEIGHTINGS):
        inverse = np.linalg.inv(rows.T @ (weights[:, None] * rows))
        found = inverse @ rows.T @ (weights[:, None] * apart)
        misses = apart - rows @ found
        size = np.hypot(*misses.T)
        spread = max(1.4826 * float(np.median(size[:-1])), _LEAST_DIFFERENCE)
        weights[:-1] = 1.0 / np.maximum(1.0, size[:-1] / (_LARGE_DIFFERENCE * spread))
    freedom = max(count - len(cameras) + 1, 1)
    pull = (weights[:, None] * rows)[:-1]
    offsets = {}
    for i, camera in enumerate(cameras):
        told = int(sum(camera in (it.camera, it.other) for it in differences))
        axes = []
        for axis in range(2):
            meat = pull.T @ (misses[:-1, axis, None] ** 2 * pull)
            error = sqrt(float((inverse @ meat @ inverse)[i, i]) * count / freedom)
            estimate = from_error(
                float(found[i, axis]), error, told, told >= _LEAST_BLOCKS, "m", freedom=freedom
            )
            axes.append(replace(estimate, seen=estimate.seen and estimate.half_width < _MOST_OFFSET_ERROR))
        offsets[camera] = CameraOffset(*axes)
    return offsets


def _size(offsets: list[CameraOffset]) -> Estimate:
    """Return the root mean square of the lengths of all cameras' offsets."""
    axes = [axis for it in offsets for axis in it]
    count = min((axis.count for axis in axes), default=0)
    if not all(axis.seen for axis in axes):
        return unseen(count, "m")
    errors = np.array([axis.half_width / quantile(0) for axis in axes])
    values = np.array([axis.value for axis in axes])
    cameras = len(offsets)
    # What the errors add to the squares is taken off.
    size = sqrt(max(float(np.sum(values**2) - np.sum(errors**2)), 0.0) / cameras)
    slope = hypot(*(values * errors)) / cameras
    error = slope / size if size > 0.0 else hypot(*errors) / sqrt(cameras)
    return not_negative(from_error(size, error, count, True, "m"))
