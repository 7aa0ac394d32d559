"""The official ssl-game-controller in its CI mode: one step of its clock for each input.

Source of ports, messages and field numbers: ssl-game-controller, ``proto/ci`` and ``proto/api``.
"""

from __future__ import annotations

import socket
import struct
import subprocess
import time
from pathlib import Path
from types import TracebackType
from typing import Any, Self

_QUIET = 0.002
"""A tick may be answered by several outputs; after this long without another it is complete [s]."""

TEAMS = {"yellow": 1, "blue": 2}
COMMANDS = {
    "HALT": 1,
    "STOP": 2,
    "NORMAL_START": 3,
    "FORCE_START": 4,
    "DIRECT": 5,
    "KICKOFF": 7,
    "PENALTY": 8,
    "TIMEOUT": 9,
    "BALL_PLACEMENT": 10,
}


def encode(fields: dict[int, Any]) -> bytes:
    """The bytes of a message from its fields by number: numbers, texts, bytes, messages and lists of them."""
    out = b""
    for number, value in fields.items():
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, int):
                out += _varint(number << 3) + _varint(each & (2**64 - 1))
            elif isinstance(each, float):
                out += _varint(number << 3 | 5) + struct.pack("<f", each)
            else:
                data = (
                    encode(each)
                    if isinstance(each, dict)
                    else each.encode()
                    if isinstance(each, str)
                    else each
                )
                out += _varint(number << 3 | 2) + _varint(len(data)) + data
    return out


def _varint(value: int) -> bytes:
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


class OfficialController:
    """The official program as a child process, on ports of its own and publishing nothing."""

    def __init__(self, binary: str, folder: Path) -> None:
        (folder / "config").mkdir()
        (folder / "config" / "ssl-game-controller.yaml").write_text('network:\n  publish-address: ""\n')
        ports = [_free_port() for _ in range(5)]
        flags = ("address", "ciAddress", "autorefAddress", "teamAddress", "remoteControlAddress")
        options = [
            text
            for flag, port in zip(flags, ports, strict=True)
            for text in (f"-{flag}", f"127.0.0.1:{port}")
        ]
        self._log = (folder / "log").open("wb")
        self._process = subprocess.Popen(
            [binary, "-backendOnly", "-timeAcquisitionMode", "ci", *options],
            cwd=folder,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )
        self._socket = _connect(ports[1])
        self._buffer = b""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._socket.close()
        self._process.terminate()
        self._process.wait(5.0)
        self._log.close()

    def step(self, seconds: float, tracked: bytes | None = None, *inputs: dict[int, Any]) -> bytes:
        """Let its clock be ``seconds``; return its referee message.

        Args:
            seconds: simulated time [s].
            tracked: a tracker packet.
            inputs: API inputs, by field number.
        """
        message: dict[int, Any] = {1: 1_700_000_000_000_000_000 + round(seconds * 1e9)}
        if tracked is not None:
            message[2] = tracked
        if inputs:
            message[3] = list(inputs)
        data = encode(message)
        self._socket.sendall(_varint(len(data)) + data)
        output = self._output(5.0)
        assert output is not None, "the game controller is silent"
        while True:
            more = self._output(_QUIET)
            if more is None:
                break
            output = more
        # CiOutput has one field, the referee message.
        size, start = _read_varint(output, 1)
        return output[start : start + size]

    def _output(self, wait: float) -> bytes | None:
        self._socket.settimeout(wait)
        while True:
            if self._buffer:
                size, start = _read_varint(self._buffer, 0)
                if len(self._buffer) >= start + size:
                    output = self._buffer[start : start + size]
                    self._buffer = self._buffer[start + size :]
                    return output
            try:
                self._buffer += self._socket.recv(65536)
            except TimeoutError:
                return None


def change(number: int, fields: dict[int, Any]) -> dict[int, Any]:
    """An API input that changes the match: the change's number and its fields."""
    return {1: {1: "UI", number: fields}}


def command(name: str, team: str | None = None) -> dict[int, Any]:
    """The API input of a new command."""
    return change(2, {1: {1: COMMANDS[name], 2: TEAMS.get(team or "", 0)}})


def team_state(team: str, **values: Any) -> dict[int, Any]:
    """The API input that changes what the controller knows of a team."""
    numbers = {"name": 2, "goalkeeper": 4, "on_positive_half": 7, "can_place_ball": 9}
    return change(13, {1: TEAMS[team], **{numbers[name]: {1: value} for name, value in values.items()}})


def _read_varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, at


def _free_port() -> int:
    with socket.socket() as sock:
        sock.bind(("127.0.0.1", 0))
        port: int = sock.getsockname()[1]
        return port


def _connect(port: int) -> socket.socket:
    end = time.monotonic() + 10.0
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=5.0)
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.05)
