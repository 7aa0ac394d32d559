"""Listens to a field and writes the league's log of it."""

from __future__ import annotations

import select
import time
from pathlib import Path

from robobt.league.log.files import LogKind, LogWriter
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.sockets import Receiver


def log_field(
    path: str | Path, endpoints: Endpoints, interface: str | None = None, seconds: float | None = None
) -> dict[LogKind, int]:
    """Write what vision, tracker and game controller send, until interrupted or for so many seconds.

    Args:
        path: the log; a name that ends in ``.gz`` is compressed.
        interface: own address of the interface to listen on; none: this machine's packets only.

    Returns:
        How many packets of each kind were written.

    Raises:
        OSError: the file cannot be written, or there is no such interface.
    """
    sources = {
        LogKind.VISION: endpoints.vision,
        LogKind.TRACKER: endpoints.tracker,
        LogKind.REFEREE: endpoints.referee,
    }
    written = dict.fromkeys(sources, 0)
    receivers: dict[Receiver, LogKind] = {}
    try:
        for kind, endpoint in sources.items():
            receivers[Receiver(*endpoint, interface)] = kind
        end = None if seconds is None else time.monotonic() + seconds
        with LogWriter(path) as log:
            while end is None or time.monotonic() < end:
                for receiver in select.select(list(receivers), [], [], 0.1)[0]:
                    for packet in receiver.receive():
                        log.write(time.time_ns(), receivers[receiver], packet.data)
                        written[receivers[receiver]] += 1
    except KeyboardInterrupt:
        # What was heard is written; that is how one stops listening.
        return written
    finally:
        for receiver in receivers:
            receiver.close()
    return written
