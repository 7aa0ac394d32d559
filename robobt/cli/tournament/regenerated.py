"""What ``robobt tournament results --regenerate`` does: stored matches are played again from their seeds."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.markup import escape

from robobt.cli.common import Progress, console, cores, print_json, say, table, warn
from robobt.cli.outputs import make_folders
from robobt.config.extras import need
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.tournament.played import PlayedMatch
    from robobt.tournament.regenerate import Regenerated
    from robobt.tournament.store import MatchStore


class Tracking(StrEnum):
    """How the tracking of a regenerated match is written."""

    ARROWS = "arrows"
    PARQUET = "parquet"
    MCAP = "mcap"


def regenerate_matches(
    store: MatchStore,
    matches: Sequence[PlayedMatch],
    folder: Path,
    tracking: Tracking,
    workers: int | None,
    said: dict[str, object],
    *,
    as_json: bool,
) -> None:
    """Play matches again, write their tracking, and print whether their hashes are equal.

    The exit code is 1 unless all of them are.
    """
    need("record", "pyarrow")
    if tracking is Tracking.MCAP:
        need("mcap", "mcap_protobuf", "foxglove_schemas_protobuf")
    from robobt.tournament.regenerate import differences, regenerate

    wanted = [match for match in matches if match.trace]
    if not wanted and not as_json:
        say("No such match.")
        return
    make_folders({"--regenerate": folder}, folders=True)
    differing = differences(store, wanted)
    for line in differing:
        warn(f"{line}; hashes may differ")
    files: dict[object, str] = {}
    with Progress("playing again", len(wanted)) as progress:

        def take(again: Regenerated, recording: Path) -> None:
            files[again.match.fixture] = str(_written(recording, tracking))
            progress.advance()

        processes = min(cores(), len(wanted)) if workers is None else workers
        again = regenerate(store, wanted, folder, processes, on_match=take)
    equal = sum(one.equal for one in again)
    if as_json:
        told = [
            {
                **{name: getattr(one.match, name) for name in ("blue", "yellow", "round", "seed")},
                "trace": one.match.trace,
                "again": one.trace or None,
                "equal": one.equal,
                "problem": one.problem or None,
                "file": files.get(one.match.fixture),
            }
            for one in again
        ]
        print_json({**said, "differences": differing, "equal": equal, "regenerated": told})
    else:
        _print(again)
        count = counted(len(again), "match", "matches")
        say(f"{equal} of {count} went the same way, bit for bit. Files: {folder}")
    if equal < len(again):
        raise typer.Exit(1)


def _written(recording: Path, tracking: Tracking) -> Path:
    """Turn a match's recording into the file that is asked for, in its place."""
    if tracking is Tracking.ARROWS:
        return recording
    from robobt.match.recording import load_recording

    loaded = load_recording(recording)
    out = recording.with_name(f"{recording.name.partition('.robobt')[0]}.{tracking.value}")
    if tracking is Tracking.PARQUET:
        from robobt.match.recording.parquet import write_parquet

        write_parquet(loaded, out)
    else:
        from robobt.match.recording.mcap import write_mcap

        write_mcap(loaded, out)
    recording.unlink()
    return out


def _print(again: Sequence[Regenerated]) -> None:
    listed = table("round", "blue", "yellow", "goals", "hash", "hash now", "")
    for one in again:
        match = one.match
        verdict = "equal" if one.equal else f"failed: {one.problem}" if one.problem else "differs"
        listed.add_row(
            str(match.round),
            escape(match.blue),
            escape(match.yellow),
            f"{match.blue_score} : {match.yellow_score}",
            match.trace[:8],
            one.trace[:8],
            escape(verdict),
        )
    console.print(listed)
