"""Packets of the vision's port, as far as their senders are followed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal

from robobt.league.sources import VisionSources
from robobt.league.wire.notices import Notices
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.senders import Address, FirstSender
from robobt.league.wire.sockets import Packet
from robobt.league.wire.tracker import detections_in, read_tracked
from robobt.league.wire.vision import VisionPacket, read_vision
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import RobotId


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
