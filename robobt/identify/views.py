"""From what each camera saw to pictures of all of them, with or without the cameras' offsets."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robobt.identify.cameras import CameraEstimate
from robobt.identify.observations import CameraViews, Observations, without_repeats
from robobt.world.geometry import FloatArray

_ONE_PICTURE = 0.002
"""JoinedPictures of several cameras taken within this time are one [s]."""


class JoinedPictures(NamedTuple):
    """JoinedPictures in order: times, ball (T, 2), poses (T, K, 3), cameras (T,) or -1 where several are one.

    ``alone`` is the mean of 1 over the number of cameras that a place of the ball comes from.
    """

    times: FloatArray
    ball: FloatArray
    poses: FloatArray
    cameras: NDArray[np.int64]
    alone: float


def in_order(
    times: FloatArray,
    cameras: NDArray[np.int64],
    ball: FloatArray,
    poses: FloatArray,
    places: Mapping[int, tuple[float, float, float]],
) -> CameraViews:
    """Return views in the order of their times; the arguments are the fields of :class:`CameraViews`."""
    order = np.argsort(times, kind="stable")
    return CameraViews(times[order], cameras[order], ball[order], poses[order], places)


def together(views: CameraViews) -> JoinedPictures:
    """Put pictures of several cameras that were taken at once into one.

    Args:
        views: what each camera saw.

    Returns:
        the pictures, in which a detection that repeats the one before is none.
    """
    times, cameras, ball, poses = views.times, views.cameras, views.ball, views.poses
    groups: list[list[int]] = []
    for row in range(len(times)):
        group = groups[-1] if groups else []
        taken = [int(cameras[other]) for other in group]
        if group and times[row] - times[group[0]] < _ONE_PICTURE and int(cameras[row]) not in taken:
            group.append(row)
        else:
            groups.append([row])
    with warnings.catch_warnings():
        # What no camera saw has no mean.
        warnings.simplefilter("ignore", RuntimeWarning)
        several = np.array([_mean_poses(poses[group]) for group in groups])
        for robot in range(several.shape[1]):
            several[:, robot] = without_repeats(several[:, robot])
        counts = np.array([int(np.isfinite(ball[group, 0]).sum()) for group in groups])
        return JoinedPictures(
            np.array([times[group].mean() for group in groups]),
            without_repeats(np.array([_mean(ball[group]) for group in groups])),
            several,
            np.array([cameras[group[0]] if len(group) == 1 else -1 for group in groups]),
            float(np.mean(1.0 / counts[counts > 0])) if counts.any() else 1.0,
        )


def without_offsets(seen: Observations, cameras: CameraEstimate) -> Observations:
    """Return observations from which the offsets of cameras that are known are taken.

    Args:
        seen: what cameras saw and what was sent.
        cameras: by how much cameras see things shifted.
    """
    known = {number: it for number, it in cameras.offsets.items() if it.x.seen and it.y.seen}
    if seen.views is None or not known:
        return seen
    views = seen.views
    shifts = np.zeros((len(views.times), 2))
    for number, offset in known.items():
        shifts[views.cameras == number] = offset.x.value, offset.y.value
    poses = np.array(views.poses)
    poses[:, :, :2] -= shifts[:, None]
    moved = replace(views, ball=views.ball - shifts, poses=poses)
    pictures = together(moved)
    # A part of a recording may begin or end between two cameras' views of one picture.
    return replace(
        seen,
        times=pictures.times,
        ball=pictures.ball,
        poses=pictures.poses,
        cameras=None if seen.cameras is None else pictures.cameras,
        views=moved,
    )


def each_alone(seen: Observations) -> Iterator[Observations]:
    """Yield what each camera saw by itself, without commands; or all of it where there is a single view."""
    if seen.views is None:
        yield seen
        return
    views = seen.views
    for camera in sorted(set(views.cameras.tolist())):
        own = views.cameras == camera
        poses = np.array(views.poses[own])
        for robot in range(len(seen.robots)):
            poses[:, robot] = without_repeats(poses[:, robot])
        yield replace(
            seen, times=views.times[own], ball=views.ball[own], poses=poses, cameras=None, views=None
        )


def _mean(values: FloatArray) -> FloatArray:
    result: FloatArray = values[0] if len(values) == 1 else np.nanmean(values, axis=0)
    return result


def _mean_poses(poses: FloatArray) -> FloatArray:
    if len(poses) == 1:
        return _mean(poses)
    heading = np.arctan2(np.nanmean(np.sin(poses[..., 2]), axis=0), np.nanmean(np.cos(poses[..., 2]), axis=0))
    return np.concatenate([_mean(poses[..., :2]), heading[:, None]], axis=1)
