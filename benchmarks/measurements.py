"""``python -m benchmarks measurements``: the figures of ``docs/measurements``, and which to repeat."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from benchmarks.behaviour import ROOMS, behaviour, processor
from robobt.cli import Json, Progress, console, print_json, say, table
from robobt.config.atomic import write_atomically
from robobt.config.commit import source_commit
from robobt.config.errors import ConfigError

PAGES = Path(__file__).parents[1] / "docs" / "measurements"

RECORD = PAGES / "behaviour.json"
"""What the rooms did at some commits: their hashes by commit, and on which processor."""

_HEADING = re.compile(r"^##+ (?P<title>.+)$")
_MEASURED = re.compile(r"^Measured (?P<date>\S+) at `(?P<commit>\S+)`; rests on (?P<rooms>.+)\.$")
_DATE, _COMMIT = re.compile(r"\d{4}-\d{2}-\d{2}"), re.compile(r"[0-9a-f]{7,40}")


@dataclass(frozen=True)
class Measurement:
    """A section of a page.

    Attributes:
        page: the page's file name.
        title: the section's heading.
        date: when it was measured, as in 2026-11-24.
        commit: of what, abbreviated.
        rooms: what it rests on, keys of :data:`benchmarks.behaviour.ROOMS`.
    """

    page: str
    title: str
    date: str
    commit: str
    rooms: tuple[str, ...]


def read_page(path: Path) -> list[Measurement]:
    """Return the measurements of a page.

    Raises:
        ConfigError: a line that begins with "Measured" is not of the form "Measured DATE at `COMMIT`; rests
            on ROOM, ROOM."; the message names file and line.
    """
    found, title, fenced = [], "", False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        fenced ^= line.startswith("```")
        if fenced:
            continue
        if heading := _HEADING.match(line):
            title = heading["title"]
        elif line.startswith("Measured "):
            found.append(_measurement(path, number, title, line))
    return found


def _measurement(path: Path, number: int, title: str, line: str) -> Measurement:
    read = _MEASURED.match(line)
    if read is None or not _DATE.fullmatch(read["date"]) or not _COMMIT.fullmatch(read["commit"]):
        wanted = "Measured 2026-11-24 at `1b7a2d5`; rests on sim, skills."
        raise ConfigError(str(path), f"{line!r} is not of the form {wanted!r}", line=number)
    rooms = tuple(read["rooms"].split(", "))
    if unknown := [room for room in rooms if room not in ROOMS]:
        problem = f"there is no room {', '.join(unknown)}; the rooms are {', '.join(ROOMS)}"
        raise ConfigError(str(path), problem, line=number)
    return Measurement(path.name, title, read["date"], read["commit"], rooms)


def changed_rooms(
    one: Measurement, recorded: Mapping[str, Mapping[str, str]], now: Mapping[str, str]
) -> list[str] | None:
    """Return the rooms of a measurement that behave otherwise ``now`` than at its commit.

    Args:
        one: the measurement.
        recorded: hashes of rooms by commit.
        now: hashes of rooms.

    Returns:
        None where nothing was recorded at that commit.
    """
    then = recorded.get(one.commit[:7])
    if then is None:
        return None
    return [room for room in one.rooms if then.get(room) != now[room]]


def measurements(
    stale: Annotated[
        bool,
        typer.Option("--stale", help="Only those whose rooms behave otherwise now, or may: half a minute."),
    ] = False,
    record: Annotated[
        bool, typer.Option("--record", help="Note how the rooms behave at this commit, for later comparison.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the figures of docs/measurements, or those to repeat.

    A figure rests on rooms of the package. It is stale when one of them behaves otherwise than at the commit
    of the figure: short runs with fixed seeds, by their hashes. Hashes are compared on one kind of processor.

    Keys of --json: measurements, a list with page, title, date, commit, rooms and, with --stale, changed (the
    rooms that behave otherwise; null where nothing was recorded at that commit); with --record, behaviour.
    """
    found = [one for page in sorted(PAGES.glob("*.md")) for one in read_page(page)]
    kept: dict[str, Any] = {"processor": processor(), "commits": {}}
    if RECORD.exists():
        kept = json.loads(RECORD.read_text())
    now: dict[str, str] = {}
    if stale or record:
        with Progress("rooms", len(ROOMS)) as progress:
            for room in ROOMS:
                now |= behaviour([room])
                progress.advance()
    if record:
        _record(kept, now)
    if stale and kept["processor"] != processor():
        say(f"Recorded on {kept['processor']}; on {processor()} rooms may differ that have not changed.")
    rows = [(one, changed_rooms(one, kept["commits"], now) if stale else []) for one in found]
    rows = [(one, changed) for one, changed in rows if changed != [] or not stale]
    if as_json:
        listed = [asdict(one) | ({"changed": changed} if stale else {}) for one, changed in rows]
        print_json({"measurements": listed} | ({"behaviour": now} if record else {}))
        return
    _print(rows, stale)


def _record(kept: dict[str, Any], now: Mapping[str, str]) -> None:
    """Add the hashes at this commit to the file; on another processor start a new file."""
    commit = source_commit()
    if not _COMMIT.fullmatch(commit):
        problem = "commit the changes first" if commit else "this is no clone of the repository"
        raise ConfigError("--record", problem)
    if kept["processor"] != processor():
        kept.update(processor=processor(), commits={})
    kept["commits"][commit[:7]] = dict(now)
    write_atomically(RECORD, json.dumps(kept, indent=1) + "\n")
    say(f"Noted the behaviour at {commit[:7]} in {RECORD.name}.")


def _print(rows: Sequence[tuple[Measurement, list[str] | None]], stale: bool) -> None:
    listed = table("page", "figure", "date", "commit", "changed since" if stale else "rests on")
    for one, changed in rows:
        why = "not recorded then" if changed is None else ", ".join(changed if stale else one.rooms)
        listed.add_row(one.page, escape(one.title), one.date, one.commit, why)
    console.print(listed)
    if stale and not rows:
        say("Every figure was measured with what its rooms do now.")
