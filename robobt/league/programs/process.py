"""A team's program as a child process that ends with its match, including its own children."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO
from uuid import uuid4

from robobt.config.closing import Closing
from robobt.config.errors import one_line
from robobt.signals import uninterrupted

KEPT_OUTPUT = 1 << 20
"""How much of a program's output is kept [bytes]; the rest is read and dropped."""

MOST_OUTPUT = 64 << 20
"""How much a program may print in a match [bytes]."""

_PROCESS_VARIABLE = "ROBOBT_PROGRAM"
"""Environment variable that everything a program starts inherits."""

_LAST_WORDS_TIMEOUT = 0.5
"""How long the last words of a program that has ended are waited for [s]."""

_CLEANUP_TIMEOUT = 10.0
"""How long the guard may take to end everything [s]."""

_KILL_TIMEOUT = 5.0
"""How long processes killed without the guard may take to disappear [s]."""

_GUARD_SCRIPT = r"""
exec 3<&0 </dev/null
env "$0" "$@" 3<&- & child=$!
{
  read -r _ <&3
  kill -TERM "$child"; sleep 0.3
  for again in 1 2 3; do
    for file in $(grep -lzxF -e "$0" /proc/[0-9]*/environ); do
      file=${file#/proc/}; kill -KILL "${file%/environ}"
    done
  done
  kill -KILL 0
} 2>/dev/null &
wait "$child" 2>/dev/null
"""
"""A shell that ends with the program, and ends it once its own input ends, however this process does.

It leads a group of processes, all of which it kills, and before that whatever bears the mark, ``$0``, in its
environment: a program's children may have left the group.
"""


def is_there(program: str, folder: Path) -> bool:
    """Return whether there is such a program, by its name or in the folder where it is to run."""
    return shutil.which(program, path=os.environ.get("PATH")) is not None or (folder / program).is_file()


class TeamProcess(Closing):
    """A running program. A context manager, at whose end it and all its children are gone.

    Args:
        command: program and arguments.
        folder: where it runs.
        output: file for the beginning of what it prints.

    Attributes:
        printed: how much it has printed [bytes].
        stubborn: whether it, or a child of it, did not end when asked to (Linux).

    Raises:
        OSError: it cannot be started.
    """

    def __init__(self, command: Sequence[str], folder: Path, output: Path) -> None:
        if not is_there(command[0], folder):
            raise FileNotFoundError(errno.ENOENT, "there is no such program", command[0])
        self._mark = f"{_PROCESS_VARIABLE}={uuid4().hex}"
        self._output = output
        self.printed, self.stubborn = 0, False
        self._told: set[int] = set()
        with uninterrupted:
            self._process = subprocess.Popen(
                ["/bin/sh", "-c", _GUARD_SCRIPT, self._mark, *command],
                cwd=folder,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                # Ctrl-C in a terminal is for this process; the group is ended as a whole.
                start_new_session=True,
            )
        assert self._process.stdout is not None
        self._reader = threading.Thread(target=self._keep, args=(self._process.stdout,), daemon=True)
        self._reader.start()

    def ended(self, wait: bool = False) -> str | None:
        """Return how it ended, with its last words; None while it runs.

        Args:
            wait: whether it is about to end, and a moment is waited for that.
        """
        if wait:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_LAST_WORDS_TIMEOUT)
        code = self._process.poll()
        if code is None:
            return None
        how = f"was ended by signal {code - 128}" if code > 128 else f"ended with exit code {code}"
        self._reader.join(_LAST_WORDS_TIMEOUT)
        words = self._output.read_text(errors="replace").split("\n") if self._output.exists() else []
        last = next((line for line in reversed(words) if line.strip()), "")
        return f"its program {how}{f': {one_line(last, 200)}' if last else ''}"

    def tell(self) -> None:
        """Ask it, and everything it has started, to end; each once."""
        for process in self._marked():
            if process not in self._told:
                self._told.add(process)
                with suppress(OSError):
                    os.kill(process, signal.SIGTERM)

    def leave(self, within: float) -> None:
        """Wait ``within`` [s] for its end after a request, and find out whether it is stubborn."""
        end = time.monotonic() + within
        while self._marked():
            if time.monotonic() > end:
                self.stubborn = True
                return
            # Children started meanwhile have not been asked yet.
            self.tell()
            time.sleep(0.02)

    def close(self) -> None:
        """End it and everything it has started, by force."""
        with uninterrupted:
            assert self._process.stdin is not None
            with suppress(OSError):
                self._process.stdin.close()
            end = time.monotonic() + _CLEANUP_TIMEOUT
            # A killed process takes a moment to disappear, and may have started another one meanwhile.
            while (self._group() or self._marked()) and time.monotonic() < end + _KILL_TIMEOUT:
                if time.monotonic() > end:
                    self._kill()
                time.sleep(0.02)
                self._process.poll()
            self._process.wait()
            self._reader.join(_LAST_WORDS_TIMEOUT)

    def _kill(self) -> None:
        """Kill the remaining processes, because the program may have stopped or killed its guard."""
        with suppress(OSError):
            os.killpg(self._process.pid, signal.SIGKILL)
        for process in self._marked():
            with suppress(OSError):
                os.kill(process, signal.SIGKILL)

    def _group(self) -> bool:
        """Return whether a process of the group is left."""
        try:
            os.killpg(self._process.pid, 0)
        except OSError:
            return False
        return True

    def _marked(self) -> list[int]:
        """Return the processes that bear this program's mark; none where there is no /proc."""
        if not sys.platform.startswith("linux"):
            return []
        mark, found = self._mark.encode(), []
        for folder in Path("/proc").iterdir():
            if not folder.name.isdigit() or int(folder.name) == os.getpid():
                continue
            with suppress(OSError):
                if mark in (folder / "environ").read_bytes().split(b"\0"):
                    found.append(int(folder.name))
        return found

    def _keep(self, source: IO[bytes]) -> None:
        """Keep the beginning of what it prints; read all of it, so that it is never held up."""
        with suppress(OSError, ValueError), source, self._output.open("wb", buffering=0) as file:
            while data := source.read1(1 << 16):  # type: ignore[attr-defined]
                file.write(data[: max(0, KEPT_OUTPUT - self.printed)])
                self.printed += len(data)
