"""Selection of camera senders: several may share a field's cameras, but they must not contradict each other.

No sockets and no clock: all times are arguments.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot, inf
from typing import Literal

from robobt.league.wire.notices import Notices
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.sockets import SENDER_SILENCE, Address, FirstSender, Packet
from robobt.league.wire.tracker import detections_in, read_tracked
from robobt.league.wire.vision import CameraFrame, VisionPacket, read_vision
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import RobotId

_RESTART = 0.25
"""Silence after which a sender that began later on the same machine is a program that was restarted [s]."""

_AGREEMENT_TIME = 0.2
"""How long a further sender has to agree with what is seen before it is followed too [s]."""

_NEW = 5.0
"""A sender that is heard no longer than this is ignored as a whole for one camera of another's [s]."""

_DISAGREEMENT = 0.5
"""How long one sees robots elsewhere before that is reported [s]: they may just have been put there."""

_ELSEWHERE_DISTANCE = 0.5
"""A robot further from where it is seen is elsewhere [m]: it may drive, and frames may be late."""

_GEOMETRY = 10.0
"""Longest pause between two packets of geometry [s]."""

_MOST_SENDERS = 64
"""Senders that are remembered."""


@dataclass(slots=True)
class _Source:
    """A sender: since when and until when it was heard, and from when on it may be followed [s]."""

    began: float
    heard: float
    followed: bool = False
    free: float = inf
    odd: float = inf


class VisionSources:
    """Follows the first sender of each camera, and of further senders those that agree with it.

    Real fields may have several vision computers, each with cameras of its own. A sender is ignored while it
    sends frames of a camera that another one sends, or sees robots elsewhere; a new one is also while it sees
    nothing. Another takes over once those that are followed have been silent for 2 s, or 0.25 s where it
    began after that on the same machine.
    """

    def __init__(self, notices: Notices) -> None:
        self._notices = notices
        self._sources: dict[Address, _Source] = {}
        self._cameras: dict[int, Address] = {}
        self._geometry = FirstSender[Address](_GEOMETRY)

    def shows_field(self, sender: Address, time: float) -> bool:
        """Return whether a geometry packet that arrived at ``time`` is used [s].

        That is one of a sender whose frames are used, or of a program that publishes nothing else.
        """
        source, geometry = self._sources.get(sender), self._geometry
        used = geometry.follows(sender, time) if source is None else source.followed
        if used:
            geometry.heard(sender, time)
        return used

    def takes(
        self, frame: CameraFrame, sender: Address, time: float, seen: Callable[[], Mapping[RobotId, Point]]
    ) -> bool:
        """Return whether a frame that arrived at ``time`` is used [s].

        ``seen`` returns where robots are seen by then, in the coordinates of the frame [m].
        """
        source = self._sources.get(sender)
        if source is None or time - source.heard > SENDER_SILENCE:
            if len(self._sources) >= _MOST_SENDERS:
                self._sources = {
                    one: it
                    for one, it in self._sources.items()
                    if time - it.heard <= SENDER_SILENCE and it.followed
                }
            source = self._sources[sender] = _Source(time, time)
        source.heard = time
        others = self._others(sender, source, time)
        owner = self._cameras.get(frame.camera)
        contested = owner in others
        if contested:
            self._contest(source, sender, frame.camera)
        elif others and not source.followed:
            self._try(source, frame, sender, time, seen)
        else:
            # A sender that sees nothing does not take over, because the other may only pause.
            source.followed |= bool(frame.robots or frame.balls) or set(self._cameras.values()) <= {sender}
        if contested or not source.followed:
            return False
        self._cameras[frame.camera] = sender
        return True

    def _contest(self, source: _Source, sender: Address, camera: int) -> None:
        """Exclude a sender whose camera another sender covers."""
        source.free = source.heard + SENDER_SILENCE
        # A sender followed for long loses only that camera.
        source.followed &= source.heard - source.began > _NEW
        owner = self._cameras[camera]
        # A restarted program is soon the only sender.
        if self._sources[owner].heard > source.began:
            self._notices.tell(
                f"vision of {sender[0]}",
                f"two vision sources send camera {camera}: following {_name(owner)}, "
                f"ignoring {_name(sender)}; stop one of them, or give its cameras other numbers",
            )

    def _try(
        self,
        source: _Source,
        frame: CameraFrame,
        sender: Address,
        time: float,
        seen: Callable[[], Mapping[RobotId, Point]],
    ) -> None:
        """Find out whether a further sender agrees with what is seen."""
        if not (frame.robots or frame.balls):
            return
        if _elsewhere(frame, seen()):
            source.odd = min(source.odd, time)
            source.free = max(time + _AGREEMENT_TIME, source.free if source.free < inf else time)
            if time - source.odd > _DISAGREEMENT:
                self._notices.tell(
                    f"vision of {sender[0]}",
                    f"two vision sources see robots in different places: ignoring {_name(sender)}; "
                    "stop one of them",
                )
            return
        source.odd = inf
        if source.free == inf:
            source.free = time + _AGREEMENT_TIME
        source.followed = time >= source.free

    def _others(self, sender: Address, source: _Source | None, time: float) -> list[Address]:
        """Return the other senders that are followed."""
        others = []
        for other, it in self._sources.items():
            if other == sender or not it.followed:
                continue
            restarted = other[0] == sender[0] and (source is None or source.began > it.heard)
            if time - it.heard <= (_RESTART if restarted else SENDER_SILENCE):
                others.append(other)
            else:
                it.followed = False
        return others


def _elsewhere(frame: CameraFrame, seen: Mapping[RobotId, Point]) -> bool:
    """Return whether most of the robots in a frame are not where they are seen."""
    near = far = 0
    for robot in frame.robots:
        if robot.robot in seen:
            x, y = seen[robot.robot]
            if hypot(robot.x - x, robot.y - y) > _ELSEWHERE_DISTANCE:
                far += 1
            else:
                near += 1
    return far > near


def _name(sender: Address) -> str:
    return f"{sender[0]}:{sender[1]}"


class VisionReader:
    """Reads the packets of cameras, or of a tracker, and leaves out those of further senders.

    Args:
        source: whose packets these are.
        counts: what happens to the packets.
        notices: warns of further senders.
    """

    def __init__(self, source: Literal["vision", "tracker"], counts: PacketCounts, notices: Notices) -> None:
        self._source, self._counts, self._notices = source, counts, notices
        self._senders = VisionSources(notices)
        self._tracker = FirstSender[tuple[str, Address]]()

    def read(
        self,
        packet: Packet,
        arrived: float,
        field: FieldGeometry,
        seen: Callable[[], Mapping[RobotId, Point]],
    ) -> VisionPacket | None:
        """Return what is of use in a packet.

        Args:
            packet: the packet.
            arrived: when it arrived [s].
            field: dimensions for tracked frames, which do not hold them.
            seen: returns where robots are seen by then, in the packet's coordinates [m].
        """
        if self._source == "tracker":
            return self._read_tracked(packet, arrived, field)
        read = read_vision(packet.data, self._counts)
        if read is None:
            return None
        if read.frame is not None and not self._senders.takes(read.frame, packet.sender, arrived, seen):
            self._counts.refuse()
            return None
        geometry = read.field is not None or bool(read.cameras)
        if geometry and not self._senders.shows_field(packet.sender, arrived):
            return VisionPacket(read.frame, None)
        return read

    def _read_tracked(self, packet: Packet, arrived: float, field: FieldGeometry) -> VisionPacket | None:
        tracked = read_tracked(packet.data, field, self._counts)
        if tracked is None:
            return None
        followed, tracker = self._tracker, (tracked[0], packet.sender)
        if followed.sender is not None and not followed.follows(tracker, arrived):
            self._counts.refuse()
            first, second = (f"{name} at {it[0]}:{it[1]}" for name, it in (followed.sender, tracker))
            self._notices.tell("trackers", f"several trackers send: following {first}, ignoring {second}")
            return None
        followed.heard(tracker, arrived)
        return VisionPacket(detections_in(tracked[1]), None)
