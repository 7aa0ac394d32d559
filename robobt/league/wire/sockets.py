"""Datagrams in and out: bound to one interface, of bounded size and number, counted when dropped.

Nothing here leaves this machine, and nothing from another machine is let in,
unless the caller names an interface or a host.
"""

from __future__ import annotations

import socket
import struct
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from ipaddress import IPv4Address
from typing import Self, TypeVar

from robobt.league.wire.messages import DecodeError, Message

LOOPBACK = "127.0.0.1"
"""The interface whose packets stay on this machine."""

MAX_PACKET = 16384
"""Longest packet that is looked at [bytes]; those of the league have a tenth of that."""

_BATCH = 256
"""Most packets read in one go, so that a flood cannot keep the caller from its work."""

_BUFFER = 1 << 20
"""What the kernel keeps for a socket that is not read in time [bytes]."""

# Linux numbers that the socket module of Python 3.11 does not name.
_IP_PKTINFO = 8
_IP_MULTICAST_ALL = 49
_SIOCGIFADDR = 0x8915

_M = TypeVar("_M", bound=Message)


@dataclass(slots=True)
class PacketCounts:
    """What became of the packets of one port.

    Attributes:
        accepted: used.
        unreadable: no message of the port's kind, or a truncated one.
        incomplete: a message without a field that is required.
        implausible: numbers that cannot be (not finite, far outside any field), or nothing of use.
        oversized: longer than :data:`MAX_PACKET`.
        foreign: from another interface, or another machine, than the configured.
    """

    accepted: int = 0
    unreadable: int = 0
    incomplete: int = 0
    implausible: int = 0
    oversized: int = 0
    foreign: int = 0

    @property
    def dropped(self) -> int:
        """All that were not used."""
        return self.unreadable + self.incomplete + self.implausible + self.oversized + self.foreign

    def to_json(self) -> dict[str, int]:
        """The counts by name."""
        return asdict(self)


@dataclass(slots=True, frozen=True)
class Packet:
    """One datagram and where it came from."""

    data: bytes
    sender: tuple[str, int]


def decode(kind: type[_M], data: bytes, counts: PacketCounts) -> _M | None:
    """The message in ``data``, or None, counted, when there is none."""
    try:
        message: _M = kind.FromString(data)
    except (DecodeError, ValueError):
        counts.unreadable += 1
        return None
    if not message.IsInitialized():
        counts.incomplete += 1
        return None
    return message


class Receiver:
    """Receives datagrams of one port, without ever waiting.

    Args:
        address: a multicast group to join, or an own address to be reached at.
        port: 0 takes a free one.
        interface: own address of the interface to listen on; other machines' packets that
            come in elsewhere are dropped. By default all of other machines' packets are,
            and this machine's own are let in whatever interface they take.

    Attributes:
        port: the port it listens on.
        counts: what became of the packets.

    Raises:
        OSError: the port is taken, or there is no such interface.
        ValueError: an address is none.
    """

    def __init__(self, address: str, port: int, interface: str | None = None) -> None:
        self.counts = PacketCounts()
        self._interface = None if interface is None else _interface_index(interface)
        self._own: dict[str, bool] = {}
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._open(address, port, interface)
        except OSError as error:
            self._socket.close()
            where = "" if interface is None else f" on {interface}"
            raise OSError(f"cannot receive at {address}:{port}{where}: {error.strerror or error}") from error
        self.port: int = self._socket.getsockname()[1]

    def _open(self, address: str, port: int, interface: str | None) -> None:
        sock, group = self._socket, IPv4Address(address).is_multicast
        sock.setblocking(False)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        if sys.platform == "linux":
            sock.setsockopt(socket.IPPROTO_IP, _IP_PKTINFO, 1)
        if group:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # On the group's own address the kernel keeps unicast and other groups away.
        sock.bind((address, port))
        if group:
            if sys.platform == "linux":
                sock.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
            for own in [interface] if interface is not None else _own_addresses():
                join(sock, address, own)

    def fileno(self) -> int:
        """For selectors."""
        return self._socket.fileno()

    def receive(self) -> Iterator[Packet]:
        """The packets that wait, oldest first; at most a batch of them."""
        for _ in range(_BATCH):
            try:
                data, extras, flags, sender = self._socket.recvmsg(MAX_PACKET, 64)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                # An earlier answer found nobody at home (ECONNREFUSED); that is the other side's affair.
                continue
            if not self._welcome(sender[0], extras):
                self.counts.foreign += 1
            elif flags & socket.MSG_TRUNC:
                self.counts.oversized += 1
            else:
                yield Packet(data, sender)

    def answer(self, data: bytes, to: tuple[str, int]) -> None:
        """Send a datagram from this port to whoever sent one here."""
        _send(self._socket, data, to)

    def close(self) -> None:
        """Stop listening."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _welcome(self, sender: str, extras: list[tuple[int, int, bytes]]) -> bool:
        if self._is_own(sender):
            return True
        if self._interface is None:
            return False
        for level, kind, data in extras:
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


class Sender:
    """Sends datagrams to one address.

    Args:
        address, port: a host, or a multicast group.
        interface: own address of the interface a group's packets leave by; the loopback by default.

    Raises:
        OSError: there is no such interface.
        ValueError: the address is none.
    """

    def __init__(self, address: str, port: int, interface: str = LOOPBACK) -> None:
        self._to = (address, port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        if IPv4Address(address).is_multicast:
            try:
                own = socket.inet_aton(interface)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, own)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
                # The interface has to take part in the group for software that joined it on any
                # other interface of this machine to get what is sent over the loopback.
                join(self._socket, address, interface)
            except OSError as error:
                self._socket.close()
                raise OSError(f"cannot send on interface {interface}: {error.strerror or error}") from error

    def fileno(self) -> int:
        """For selectors: answers come in here."""
        return self._socket.fileno()

    def send(self, data: bytes) -> None:
        """Send one datagram; one that cannot be sent is lost, as datagrams are."""
        _send(self._socket, data, self._to)

    def answers(self) -> Iterator[bytes]:
        """What the addressee has sent back, at most a batch; anybody else's packets are left out."""
        for _ in range(_BATCH):
            try:
                data, sender = self._socket.recvfrom(MAX_PACKET)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                continue
            if sender == self._to:
                yield data

    def close(self) -> None:
        """Stop sending."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def join(sock: socket.socket, group: str, interface: str) -> None:
    """Make a socket a member of a multicast group on the interface with this own address."""
    member = socket.inet_aton(group) + socket.inet_aton(interface)
    sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)


def _send(sock: socket.socket, data: bytes, to: tuple[str, int]) -> None:
    try:
        sock.sendto(data, to)
    except OSError:
        # Nobody listens, or the network is down: the next packet replaces this one anyway.
        return


def _can_bind(address: str) -> bool:
    """Whether an address is one of this machine's."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        try:
            sock.bind((address, 0))
        except OSError:
            return False
    return True


def _addresses() -> dict[str, int]:
    """Own address and index of every interface that has one."""
    if sys.platform != "linux":
        return {LOOPBACK: 0}
    import fcntl  # not on every platform

    found = {}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        for index, name in socket.if_nameindex():
            try:
                answer = fcntl.ioctl(sock.fileno(), _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
            except OSError:
                continue
            found[socket.inet_ntoa(answer[20:24])] = index
    return found


def _own_addresses() -> list[str]:
    return list(dict.fromkeys([LOOPBACK, *_addresses()]))


def _interface_index(interface: str) -> int:
    known = _addresses()
    if interface not in known:
        there = ", ".join(known)
        raise OSError(f"no interface of this machine has the address {interface}; there are {there}")
    return known[interface]
