"""Listens to a field and writes the league's log of it."""

from __future__ import annotations

import select
import time
from contextlib import ExitStack, suppress
from pathlib import Path

from robobt.league.log.files import LogKind, LogWriter
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.sockets import Receiver
from robobt.signals import Terminated, check, uninterrupted


def log_field(
    path: str | Path, endpoints: Endpoints, interface: str | None = None, seconds: float | None = None
) -> dict[LogKind, int]:
    """Log the packets of vision, tracker and game controller, until interrupted or for ``seconds``.

    Return the number of packets of each kind that were written.

    Args:
        path: the log; compressed when the name ends in ``.gz``.
        endpoints: where to listen.
        interface: own address of the interface to listen on; none: this machine's packets only.
        seconds: how long [s]; None until interrupted.
    """
    sources = {
        LogKind.VISION: endpoints.vision,
        LogKind.TRACKER: endpoints.tracker,
        LogKind.REFEREE: endpoints.referee,
    }
    written = dict.fromkeys(sources, 0)
    with ExitStack() as opened:
        receivers = {
            opened.enter_context(Receiver(*endpoint, interface)): kind for kind, endpoint in sources.items()
        }
        log = opened.enter_context(LogWriter(path))
        end = None if seconds is None else time.monotonic() + seconds
        # A signal is how one stops listening.
        with suppress(KeyboardInterrupt, Terminated):
            while end is None or time.monotonic() < end:
                check()
                for receiver in select.select(list(receivers), [], [], 0.1)[0]:
                    for packet in receiver.receive():
                        with uninterrupted:  # so that the count is that of the file
                            log.write(time.time_ns(), receivers[receiver], packet.data)
                            written[receivers[receiver]] += 1
    return written
