"""What a page shows of a match that stands still while viewers move things."""

from __future__ import annotations

from struct import iter_unpack, pack

_BALL, _ROBOT = 4, 8
"""Numbers of the ball on the ground and of a robot in a packed frame."""


def standing(shown: bytes, before: bytes, now: bytes) -> bytes:
    """Return the frame to show: what viewers have moved where it is now, all else where it was shown.

    The world is a tick ahead of what was shown last, so that without this all would move with the first thing
    that is moved. Frames are packed (:meth:`robobt.world.state.Frame.packed`).

    Args:
        shown: the newest tick's.
        before: the world's when viewers began to move things.
        now: the world's.
    """
    was, there = _parts(before), _parts(now)
    seen = _parts(shown)
    parts = {name: seen.get(name, it) if was.get(name) == it else it for name, it in there.items()}
    counts = [[name[0] for name in parts].count(team) for team in ("own", "opponent")]
    if was["ball", 0.0] != there["ball", 0.0]:
        parts["air", 0.0] = there["air", 0.0]
    numbers = [*parts["time", 0.0], *parts["ball", 0.0]]
    for team, count in zip(("own", "opponent"), counts, strict=True):
        numbers.append(count)
        for name, it in parts.items():
            if name[0] == team:
                numbers += it
    numbers += parts["air", 0.0]
    return pack(f"<{len(numbers)}d", *numbers)


def _parts(frame: bytes) -> dict[tuple[str, float], list[float]]:
    """Return the numbers of a packed frame's time, ball and robots, these by their ids."""
    numbers = [number for (number,) in iter_unpack("<d", frame)]
    parts = {("time", 0.0): numbers[:1], ("ball", 0.0): numbers[1 : 1 + _BALL]}
    at = 1 + _BALL
    for team in ("own", "opponent"):
        count = int(numbers[at])
        at += 1
        for _ in range(count):
            parts[team, numbers[at]] = numbers[at : at + _ROBOT]
            at += _ROBOT
    parts["air", 0.0] = numbers[at:]
    return parts
