"""Notes whose tree is being ticked, for the case that a match crashes or hangs.

Plays run inside the process of the match. One that ends the process, or never returns, takes the match with
it; the note that is left says which side it was.
"""

from __future__ import annotations

import faulthandler
import mmap
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from robobt.match.loop import MatchLoop
from robobt.match.players import Player
from robobt.tree import Status
from robobt.world.game import Team

STANDSTILL_TIME = 300.0
"""Longest time without progress of a match; compiling takes a minute or two on a busy machine [s]."""

_TEAM_LETTERS = {Team.BLUE: ord("b"), Team.YELLOW: ord("y")}
_NO_TREE = ord("-")

_TICKS = 1000
"""Number of ticks between resets of the watchdog; a reset costs as much as ticking a tree."""


@contextmanager
def guarded(match: MatchLoop, note: Path, silence: float = STANDSTILL_TIME) -> Iterator[None]:
    """Note in a file whose tree is being ticked, and end this process if there is no more progress.

    Args:
        match: the match played inside the block.
        note: the file; removed when the block ends, unless by what ends the process.
        silence: longest time without progress [s].
    """
    note.write_bytes(bytes([_NO_TREE]))
    try:
        with (
            note.open("r+b") as file,
            mmap.mmap(file.fileno(), 1) as shared,
            Path(os.devnull).open("w") as nowhere,
        ):

            def wind_up() -> None:
                faulthandler.dump_traceback_later(silence, exit=True, file=nowhere)

            counter = _Counter(wind_up)
            for player in match.players:
                _note(player, shared, counter)
            wind_up()
            try:
                yield
            finally:
                faulthandler.cancel_dump_traceback_later()
                # The trees keep what they call, which must not write to a closed map.
                for player in match.players:
                    del player.runner.__dict__["tick"]
    except Exception:
        note.unlink()
        raise
    # A play that ends the process gets past here, and its note stays.
    note.unlink()


def noted(note: Path) -> Team | None:
    """Return whose tree was being ticked when a process died, or None."""
    try:
        letter = note.read_bytes()[:1]
    except OSError:
        return None
    note.unlink(missing_ok=True)
    return next((team for team, sign in _TEAM_LETTERS.items() if letter == bytes([sign])), None)


class _Counter:
    """Calls a function once in :data:`_TICKS` counts."""

    def __init__(self, call: Callable[[], None]) -> None:
        self._call, self._left = call, _TICKS

    def count(self) -> None:
        self._left -= 1
        if self._left == 0:
            self._left = _TICKS
            self._call()


def _note(player: Player, shared: mmap.mmap, counter: _Counter) -> None:
    tick, letter = player.runner.tick, _TEAM_LETTERS[player.robot.team]

    def noting() -> Status:
        shared[0] = letter
        try:
            status = tick()
        except Exception:
            shared[0] = _NO_TREE
            raise
        shared[0] = _NO_TREE
        counter.count()
        return status

    player.runner.tick = noting  # type: ignore[method-assign]
