"""UDP sockets bound to one interface, with datagrams of bounded size and number.

Nothing leaves this machine, and nothing from another machine is accepted,
unless the caller names an interface or a host.
"""

from __future__ import annotations

import socket
import struct
import sys
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from ipaddress import IPv4Address
from math import inf
from typing import Generic, TypeVar

from robobt.config.closing import Closing
from robobt.config.errors import RobobtError
from robobt.league.wire.packets import MAX_PACKET, PacketCounts

Address = tuple[str, int]
"""Host and port of a sender."""

SENDER_SILENCE = 2.0
"""Another sender is followed once the present one has been silent for this long [s]."""


_S = TypeVar("_S", bound=Hashable)


class FirstSender(Generic[_S]):
    """Follows the first of several senders, and another one once that has been silent for ``silence`` [s].

    ``sender`` is the one that is followed, None before the first.
    """

    def __init__(self, silence: float = SENDER_SILENCE) -> None:
        self.sender: _S | None = None
        self._silence, self._heard = silence, -inf

    def follows(self, sender: _S, time: float) -> bool:
        """Return whether a packet that arrived at ``time`` from ``sender`` counts [s]."""
        return sender == self.sender or self.sender is None or time - self._heard > self._silence

    def heard(self, sender: _S, time: float) -> None:
        """Take note of a packet that was used."""
        self.sender, self._heard = sender, time


LOOPBACK_ADDRESS = "127.0.0.1"
"""Address of the interface whose packets stay on this machine."""

MOST_DATAGRAMS = 256
"""Most datagrams read in one go, so that a flood cannot starve the caller."""

_RECEIVE_BUFFER = 1 << 20
"""Size of the kernel's receive buffer [bytes]."""

# Linux constants that the socket module of Python 3.11 lacks.
_IP_PKTINFO = 8
_IP_MULTICAST_ALL = 49
_SIOCGIFADDR = 0x8915


class SocketError(RobobtError, OSError):
    """A port or an interface cannot be used; the message is one line."""


@dataclass(slots=True, frozen=True)
class Packet:
    """One datagram and the address it came from."""

    data: bytes
    sender: Address


class _UdpSocket(Closing):
    """A non-blocking UDP socket that works as a context manager."""

    def __init__(self, longest: int = MAX_PACKET) -> None:
        self._longest = longest
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    def close(self) -> None:
        """Release the port."""
        self._socket.close()

    def _read(self) -> Iterator[tuple[bytes, list[tuple[int, int, bytes]], int, tuple[str, int]]]:
        """Yield data, ancillary data, flags and sender of the waiting datagrams, at most a batch."""
        for _ in range(MOST_DATAGRAMS):
            try:
                if sys.platform == "win32":  # which has no recvmsg, and drops a longer datagram itself
                    data, sender = self._socket.recvfrom(self._longest)
                    yield data, [], 0, sender
                    continue
                datagram = self._socket.recvmsg(self._longest, 64)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                # ECONNREFUSED: an earlier datagram of ours had no receiver.
                continue
            yield datagram

    def _send(self, data: bytes, to: tuple[str, int]) -> None:
        try:
            self._socket.sendto(data, to)
        except OSError:
            # There is no receiver, or the network is down; the next packet replaces this one anyway.
            return

    def _join(self, group: str, interface: str) -> None:
        member = socket.inet_aton(group) + socket.inet_aton(interface)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)


class Receiver(_UdpSocket):
    """Receives the datagrams of one port without blocking.

    Args:
        address: multicast group to join, or own address to bind to.
        port: port to bind to; 0 picks a free one.
        interface: own address of the interface to listen on; packets from other machines
            that arrive elsewhere are dropped. By default all packets from other machines are
            dropped, and those of this machine accepted on any interface.
        longest: longer datagrams are dropped [bytes].

    Raises:
        SocketError: the port is taken, or no interface has the address.
        ValueError: ``address`` is not an IPv4 address.
    """

    def __init__(
        self, address: str, port: int, interface: str | None = None, longest: int = MAX_PACKET
    ) -> None:
        group = IPv4Address(address).is_multicast
        self._interface = None if interface is None else _interface_index(interface)
        super().__init__(longest)
        self.counts = PacketCounts()
        self._own: dict[str, bool] = {}
        try:
            self._bind(address, port, interface, group)
        except OSError as error:
            self.close()
            where = "" if interface is None else f" on {interface}"
            raise SocketError(
                f"cannot receive at {address}:{port}{where}: {error.strerror or error}"
            ) from error
        self.port: int = self._socket.getsockname()[1]

    def _bind(self, address: str, port: int, interface: str | None, group: bool) -> None:
        sock, linux = self._socket, sys.platform == "linux"
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)
        if linux:
            sock.setsockopt(socket.IPPROTO_IP, _IP_PKTINFO, 1)
        if group:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # Bound to the group's own address, the kernel filters out unicast and other groups; Windows cannot.
        sock.bind(("" if group and sys.platform == "win32" else address, port))
        if group:
            if linux:
                sock.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
            for own in [interface] if interface is not None else {LOOPBACK_ADDRESS: 0, **_addresses()}:
                self._join(address, own)

    def fileno(self) -> int:
        """Return the descriptor, for ``select``."""
        return self._socket.fileno()

    def receive(self) -> Iterator[Packet]:
        """Yield the waiting packets, oldest first, at most a batch."""
        for data, ancillary, flags, sender in self._read():
            if not self._accepts(sender[0], ancillary):
                self.counts.foreign += 1
            elif flags & socket.MSG_TRUNC:
                self.counts.oversized += 1
            else:
                yield Packet(data, sender)

    def answer(self, data: bytes, to: tuple[str, int]) -> None:
        """Send a datagram from this port to the sender of an earlier packet."""
        self._send(data, to)

    def _accepts(self, sender: str, ancillary: list[tuple[int, int, bytes]]) -> bool:
        if self._is_own(sender):
            return True
        if self._interface is None:
            return False
        for level, kind, data in ancillary:
            if level == socket.IPPROTO_IP and kind == _IP_PKTINFO and len(data) >= 4:
                return bool(struct.unpack_from("@i", data)[0] == self._interface)
        return True

    def _is_own(self, address: str) -> bool:
        known = self._own.get(address)
        if known is None:
            known = _can_bind(address)
            if len(self._own) < 1024:
                self._own[address] = known
        return known


class Sender(_UdpSocket):
    """Sends datagrams to one address.

    Args:
        address: host, or multicast group.
        port: the receiver's port.
        interface: own address of the interface that packets to a group leave by; the loopback by default.

    Raises:
        SocketError: no interface has the address.
        ValueError: ``address`` is not an IPv4 address.
    """

    def __init__(self, address: str, port: int, interface: str = LOOPBACK_ADDRESS) -> None:
        group = IPv4Address(address).is_multicast
        super().__init__()
        self._to = (address, port)
        if group:
            try:
                own = socket.inet_aton(interface)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, own)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
                # Programs that joined the group on another interface of this machine receive what
                # is sent over the loopback only if the loopback is a member as well.
                self._join(address, interface)
            except OSError as error:
                self.close()
                raise SocketError(
                    f"cannot send on interface {interface}: {error.strerror or error}"
                ) from error

    def send(self, data: bytes) -> None:
        """Send one datagram; one that cannot be sent is lost, as datagrams are."""
        self._send(data, self._to)

    def answers(self) -> Iterator[bytes]:
        """Yield what the addressee has sent back, at most a batch; packets of others are ignored."""
        for data, _, _, sender in self._read():
            if sender == self._to:
                yield data


def _can_bind(address: str) -> bool:
    """Return whether an address belongs to this machine."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        try:
            sock.bind((address, 0))
        except OSError:
            return False
    return True


def _addresses() -> dict[str, int]:
    """Return own address and index of every interface that has an address."""
    if sys.platform != "linux":
        return {LOOPBACK_ADDRESS: 0}
    import fcntl  # not available on every platform

    found = {}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        for index, name in socket.if_nameindex():
            try:
                answer = fcntl.ioctl(sock.fileno(), _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
            except OSError:
                continue
            found[socket.inet_ntoa(answer[20:24])] = index
    return found


def _interface_index(interface: str) -> int:
    known = _addresses()
    if interface not in known:
        raise SocketError(
            f"no interface of this machine has the address {interface}; use one of {', '.join(known)}"
        )
    return known[interface]
