"""The official game controller as a child process that ends with its match.

Source of flags and settings: ssl-game-controller, ``cmd/ssl-game-controller`` and ``config/config.go``.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from robobt.config.closing import Closing
from robobt.config.errors import RobobtError, one_line
from robobt.config.systems import need_posix
from robobt.league.wire.sockets import LOOPBACK_ADDRESS
from robobt.league.wire.stream import MessageStream
from robobt.signals import uninterrupted

PROGRAM = "ssl-game-controller"
"""What the official program is called."""

VARIABLE = "ROBOBT_GAME_CONTROLLER"
"""The environment variable that names it."""

_STARTING_TIMEOUT = 20.0
"""How long the program may take until it listens, on a busy machine [s]."""

_SHUTDOWN_TIMEOUT = 10.0
"""How long the shell that guards the program may take to end everything [s]."""

_PORT_TRIES = 5
"""How often another port is tried: between finding a free one and using it somebody else may."""

_GUARD_SHELL = """
exec 3<&0
"$@" 3<&- & child=$!
{ read -r _ <&3 || rm -rf -- "$0"; kill -KILL 0; } & wait "$child"
"""
"""A shell that ends with the program, and ends it when its own input ends, however this process does.

Without a word from this process, which then was killed, it also removes the program's folder, ``$0``.

It leads a group of processes, all of which it kills: a program may be a script that started another, stand
still or mind no other signal.
"""


class GameControllerError(RobobtError, RuntimeError):
    """The official game controller cannot be used, or has failed; the message is one line."""


def find_game_controller(path: str | Path | None = None) -> Path:
    """Return the official program: ``path``, else what the environment names, else the one on PATH.

    Raises:
        GameControllerError: there is none; the message says where to get it.
    """
    named = path or os.environ.get(VARIABLE)
    # A Path has lost the "./" without which only the PATH would be searched.
    found = (shutil.which(Path(named).absolute()) if named else None) or shutil.which(named or PROGRAM)
    if found is not None:
        return Path(found).absolute()
    problem = f"{one_line(str(named))} is no program" if named else f"{PROGRAM} is not on PATH"
    if named and Path(named).is_file():
        problem += " until it may be executed (chmod +x)"
    raise GameControllerError(
        f"{problem}: the official game controller is a program of its own, which "
        "https://github.com/RoboCup-SSL/ssl-game-controller/releases has for every system; name it with "
        f"--game-controller or {VARIABLE}, or play with --referee own"
    )


def check_game_controller(program: Path) -> None:
    """Start a program once, to find out at once whether it is the official game controller.

    Raises:
        GameControllerError: it does not start as one.
    """
    GameControllerProcess(program).close()


class GameControllerProcess(Closing):
    """The program in its simulation mode, in a fresh folder, publishing nothing. A context manager.

    Args:
        program: the official program.
        game: its settings of the game, by its names; durations as in "5m0s".

    Attributes:
        stream: the connection through which it is stepped.

    Raises:
        GameControllerError: it does not start.
        SystemUnfitError: this is Windows.
    """

    def __init__(self, program: Path, game: Mapping[str, object] | None = None) -> None:
        need_posix("the official game controller")
        self._folder = tempfile.TemporaryDirectory(prefix="robobt-gc-", ignore_cleanup_errors=True)
        self._process: subprocess.Popen[bytes] | None = None
        try:
            self._write_settings(game or {})
            self.stream = self._start(program)
        except BaseException:
            self._end()
            raise

    def close(self) -> None:
        """End the program and remove its folder."""
        self.stream.close()
        self._end()

    def crash(self) -> str:
        """Return its message about a crash, empty without a crash."""
        lines = self._log.read_text(errors="replace").splitlines() if self._log.exists() else []
        return next((one_line(line) for line in lines if line.startswith(("panic:", "fatal error:"))), "")

    @property
    def _log(self) -> Path:
        return Path(self._folder.name) / "log"

    def _write_settings(self, game: Mapping[str, object]) -> None:
        config = Path(self._folder.name) / "config"
        config.mkdir()
        # An address that is left out is the league's, on every interface.
        settings = {"network": {"publish-address": ""}, "game": dict(game)}
        # JSON is YAML.
        (config / f"{PROGRAM}.yaml").write_text(json.dumps(settings))

    def _start(self, program: Path) -> MessageStream:
        for _ in range(_PORT_TRIES):
            port = _free_port()
            with uninterrupted:
                self._process = self._spawn(program, port)
            end = time.monotonic() + _STARTING_TIMEOUT
            while time.monotonic() < end and self._process.poll() is None and not self._refused():
                try:
                    return MessageStream(
                        socket.create_connection((LOOPBACK_ADDRESS, port)), "the game controller"
                    )
                except OSError:
                    time.sleep(0.005)
            refused = self._refused()
            self._stop()
            if not refused:
                break
        raise GameControllerError(f"{program}: the game controller does not start{self._last_words()}")

    def _spawn(self, program: Path, port: int) -> subprocess.Popen[bytes]:
        # Only the port that is used has to be known; the others are the system's choice.
        others = ("address", "autorefAddress", "teamAddress", "remoteControlAddress")
        flags = [text for flag in others for text in (f"-{flag}", f"{LOOPBACK_ADDRESS}:0")]
        command = [
            *("/bin/sh", "-c", _GUARD_SHELL, self._folder.name, str(program)),
            *(
                "-backendOnly",
                "-timeAcquisitionMode",
                "ci",
                "-ciAddress",
                f"{LOOPBACK_ADDRESS}:{port}",
                *flags,
            ),
        ]
        with self._log.open("wb") as log:
            return subprocess.Popen(
                command,
                cwd=self._folder.name,
                # It does one thing at a time, and what it does is short: more threads only cost time.
                env={**os.environ, "GOMAXPROCS": "1"},
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                # Ctrl-C in a terminal is for this process, which ends the program itself.
                start_new_session=True,
            )

    def _last_words(self) -> str:
        lines = self._log.read_text(errors="replace").splitlines()
        return f": {one_line(lines[-1])}" if lines else ""

    def _refused(self) -> bool:
        return "Failed to listen" in self._log.read_text(errors="replace")

    def _stop(self) -> None:
        process, self._process = self._process, None
        if process is not None and process.stdin is not None:
            with suppress(BrokenPipeError):
                process.stdin.write(b"\n")
                process.stdin.close()
            try:
                process.wait(_SHUTDOWN_TIMEOUT)
            except subprocess.TimeoutExpired:
                # The program has stopped or killed what was to end it.
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def _end(self) -> None:
        with uninterrupted:
            self._stop()
            self._folder.cleanup()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind((LOOPBACK_ADDRESS, 0))
        port: int = probe.getsockname()[1]
        return port
