"""Messages over TCP, each preceded by its length as an unsigned varint.

Source of the format: ssl-game-controller, whose servers for the simulated match, teams, automatic
referees and remote controls all use it.
"""

from __future__ import annotations

import socket
import time

from robobt.config.closing import Closing
from robobt.config.errors import RobobtError

MAX_MESSAGE = 1 << 20
"""Longest message that is accepted [bytes]; a referee message with many events is a hundredth of that."""

_CHUNK = 65536

_SEND_TIMEOUT = 10.0
"""Time without reading after which the other side counts as stopped [s]."""


class StreamError(RobobtError, OSError):
    """The other side closed the connection or sends what is no stream of messages."""


class MessageStream(Closing):
    """The messages of one connection; a context manager that closes it.

    ``peer`` is what error messages call the other side.
    """

    def __init__(self, connection: socket.socket, peer: str) -> None:
        self._socket, self._peer = connection, peer
        # A step is one short message each way: waiting to fill a packet would cost more than all the rest.
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._buffer = bytearray()

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def fileno(self) -> int:
        """Return the socket's number, for ``select``; messages may wait here that it does not know of."""
        return self._socket.fileno()

    def send(self, message: bytes) -> None:
        """Send one message.

        Raises:
            StreamError: the connection is closed, or the other side does not read.
        """
        self._socket.settimeout(_SEND_TIMEOUT)
        try:
            self._socket.sendall(encode_varint(len(message)) + message)
        except TimeoutError as error:
            raise StreamError(f"{self._peer} has read nothing for {_SEND_TIMEOUT:g} s") from error
        except OSError as error:
            raise StreamError(f"{self._peer} closed the connection") from error

    def receive(self, wait: float) -> bytes | None:
        """Return the next message, None when none is complete within ``wait`` [s].

        Raises:
            StreamError: the connection is closed, or what comes is no message.
        """
        end = time.monotonic() + wait
        while (message := self._take()) is None:
            left = max(0.0, end - time.monotonic())
            self._socket.settimeout(left)
            try:
                data = self._socket.recv(_CHUNK)
            except (TimeoutError, BlockingIOError):
                return None
            except OSError as error:
                raise StreamError(f"{self._peer} closed the connection") from error
            if not data:
                raise StreamError(f"{self._peer} closed the connection")
            self._buffer += data
        return message

    def _take(self) -> bytes | None:
        """Take the first complete message out of the buffer."""
        size = shift = 0
        for start, byte in enumerate(self._buffer, start=1):
            size |= (byte & 0x7F) << shift
            shift += 7
            if size > MAX_MESSAGE:
                raise StreamError(f"{self._peer} announces a message of more than {MAX_MESSAGE} bytes")
            if byte < 0x80:
                if len(self._buffer) < start + size:
                    return None
                message = bytes(self._buffer[start : start + size])
                del self._buffer[: start + size]
                return message
            if shift > 28:
                raise StreamError(f"{self._peer} sends a length without end")
        return None


def encode_varint(value: int) -> bytes:
    """Return a number as protobuf writes it: seven bits a byte, the lowest first."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)
