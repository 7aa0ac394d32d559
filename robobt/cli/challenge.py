"""``robobt challenge``: the league's technical challenges, and the table of their results."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    MAX_SEED,
    Imports,
    Json,
    Progress,
    Workers,
    blaming,
    console,
    cores,
    import_files,
    name_lines,
    parse_assignments,
    print_json,
    say,
    table,
    unknown,
    warn,
)
from robobt.cli.match_summary import tell_failed
from robobt.cli.option_groups.scenario import Set, parse_play
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.config.errors import RobobtError
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.challenges.run import ChallengeEntry, RunResult
    from robobt.challenges.table import Row

TABLE = "table"
"""The word that shows results in place of a challenge."""

RESULTS = "results.jsonl"
"""Name of the file of results in the folder of ``--out``."""


@dataclass(frozen=True)
class Entrants:
    """Who takes the challenge, and under which conditions."""

    blue: Annotated[
        list[str] | None,
        option(
            "--blue",
            "; or ours (the default), november, script or chance, the usual rows; repeat it to compare",
        ),
    ] = None
    yellow: Annotated[str, option("--yellow")] = ""
    settings: Set = None
    realism: Annotated[str | None, option("--realism", "; by default the preset's")] = None
    imports: Imports = None

    def of(self, name: str) -> dict[str, ChallengeEntry]:
        """Return the entries by what their rows are called.

        Raises:
            typer.BadParameter: there is no such challenge, or an option does not fit it.
        """
        from robobt.challenges import CHALLENGES
        from robobt.challenges.run import ChallengeEntry
        from robobt.plays import PLAYS
        from robobt.sim.realism import realism_level

        if name not in CHALLENGES:
            raise unknown(name, CHALLENGES)
        challenge = CHALLENGES[name]
        if self.yellow and not challenge.opponent:
            raise typer.BadParameter(f"{name} has no opponent", param_hint="--yellow")
        settings: dict[str, object] = {}
        if self.realism is not None:
            with blaming("--realism"):
                settings["simulator.realism"] = realism_level(self.realism).model_dump(exclude_none=True)
        settings |= parse_assignments(self.settings or (), "--set")
        yellow = parse_play(self.yellow, "--yellow") if self.yellow else None
        plays = {given: challenge.entrants.get(given, given) for given in self.blue or ["ours"]}
        entries = {
            given: ChallengeEntry(name, parse_play(play, "--blue"), yellow, settings)
            for given, play in plays.items()
        }
        for entry in entries.values():
            if (play := entry.blue[0]).isidentifier() and play not in PLAYS:
                rows = ", ".join(challenge.entrants)
                there = f"no play or row is called {play!r}; rows: {rows}; plays: {PLAYS.meant(play)}"
                raise typer.BadParameter(there, param_hint="--blue")
        return entries


def challenge(
    name: Annotated[
        str,
        typer.Argument(help=f"A challenge (see 'robobt list challenges'); or {TABLE}, to show results."),
    ],
    results: Annotated[
        Path | None, typer.Argument(help=f"The file of results to show, after {TABLE}.")
    ] = None,
    *,
    entrants: Entrants,
    trials: Annotated[int, option("--trials", ", each with a seed of its own", min=1, max=10_000)] = 5,
    seed: Annotated[int, option("--seed", min=0, max=MAX_SEED)] = 1,
    workers: Workers = None,
    out: Annotated[
        Path | None,
        option(
            "--out",
            f": {RESULTS}, to which each row is appended, and recordings of the best and the worst trial",
            metavar="FOLDER",
        ),
    ] = None,
    check: Annotated[bool, option("--check")] = False,
    as_json: Json = False,
) -> None:
    """Play a technical challenge of the league, and score it by its published rules.

    'robobt challenge table FILE' shows the rows of a file of results; --check plays each again and says
    whether the hash over all true states is equal.

    Keys of --json: rows, a list; each has challenge, entrant, blue, params, yellow, yellow_params, settings,
    seed, scores (of each trial), score (their mean), low and high (95 % interval, null where all scores are
    equal), unit, figures (means of all that was counted), trace (hash over all true states), robobt
    (version), commit and source (of the rules); recordings: for each entrant best and worst, lists of
    files, a single trial being the best; repeated: with --check, for each row whether the hash is equal, null
    where it cannot be played.

    Exit code 1 when --check finds a row that is not equal or cannot be played, 3 when a tree failed.
    """
    processes = cores() if workers is None else workers
    if name == TABLE:
        import_files(entrants.imports)
        _show(results, check, processes, as_json=as_json)
        return
    if results is not None or check:
        raise typer.BadParameter(
            f"is for 'robobt challenge {TABLE}'", param_hint="--check" if check else "FILE"
        )
    import_files(entrants.imports)
    entries = entrants.of(name)
    make_folders({"--out": out}, folders=True)
    if out is not None:
        out.mkdir(exist_ok=True)
    rows, recordings, failures = [], {}, []
    for entrant, entry in entries.items():
        row, played = _play(entry, entrant, trials, seed, processes)
        failures += [f"{entrant}: {result.first_error}" for result in played if result.first_error]
        rows.append(row)
        if out is not None:
            recordings[entrant] = _keep(out, row, entry, played)
    if as_json:
        print_json({"rows": [asdict(row) for row in rows], "recordings": recordings, "repeated": None})
    else:
        _print(rows)
        for entrant, files in recordings.items():
            for which, names in files.items():
                say(f"{entrant}, {which} trial: {', '.join(names)}")
    if failures:
        tell_failed(failures[0])


def _play(
    entry: ChallengeEntry, entrant: str, trials: int, seed: int, workers: int
) -> tuple[Row, list[RunResult]]:
    from robobt.challenges.run import play_runs
    from robobt.challenges.table import row_of
    from robobt.config.commit import source_commit
    from robobt.worlds import sim_world

    # Files may change while the trials are played.
    commit = source_commit()
    with Progress(f"{entry.challenge}, {entrant}", trials) as progress:
        played = play_runs(entry, trials, seed, sim_world, workers, lambda _: progress.advance())
    errors = sum(result.errors for result in played)
    if errors:
        warn(f"{entrant}: trees failed in {counted(errors, 'tick')}")
    return row_of(entry, entrant, seed, played, commit), played


def _keep(folder: Path, row: Row, entry: ChallengeEntry, played: list[RunResult]) -> dict[str, list[str]]:
    """Append the row to the results in the folder, and record the best and the worst trial there."""
    from robobt.challenges.run import play_run
    from robobt.challenges.table import append_row
    from robobt.worlds import sim_world

    append_row(folder / RESULTS, row)
    best, worst = max(played, key=lambda one: one.score), min(played, key=lambda one: one.score)
    # Rows are appended, so recordings of trials with another seed stay too.
    safe = re.sub(r"[^\w.-]+", "_", f"{row.challenge}-{row.entrant}")[:150] + f"-seed{row.seed}"
    recordings: dict[str, list[str]] = {}
    kept = {"best": best, "worst": worst} if len(played) > 1 else {"best": best}
    with Progress(f"record {entry.challenge}, {row.entrant}", len(kept)) as progress:
        for which, result in kept.items():
            again = play_run(entry, result.run, row.seed, sim_world, folder / f"{safe}-{which}")
            recordings[which] = list(again.recordings)
            progress.advance()
    return recordings


def _show(path: Path | None, check: bool, workers: int, *, as_json: bool) -> None:
    from robobt.challenges.table import read_rows

    if path is None:
        raise typer.BadParameter(f"'robobt challenge {TABLE}' needs a file of results", param_hint="FILE")
    rows = read_rows(path)
    repeated: list[bool | None] | None = None
    problems: list[str] = []
    if check:
        repeated = []
        with Progress(TABLE, len(rows)) as progress:
            for number, row in enumerate(rows, 1):
                equal, problem = _repeated(row, workers)
                repeated.append(equal)
                if problem is not None:
                    problems.append(f"{path}, row {number}: {problem}")
                progress.advance()
    if as_json:
        print_json({"rows": [asdict(row) for row in rows], "recordings": {}, "repeated": repeated})
    else:
        _print(rows, repeated)
    for problem in problems:
        warn(problem)
    if repeated is not None and not all(repeated):
        raise typer.Exit(1)


def _repeated(row: Row, workers: int) -> tuple[bool | None, str | None]:
    """Play a row again; return whether the hash is equal, or None and why it cannot be played."""
    from robobt.challenges import CHALLENGES
    from robobt.challenges.table import repeats
    from robobt.worlds import sim_world

    if row.challenge not in CHALLENGES:
        missing = f"no challenge is called {row.challenge!r}; {CHALLENGES.meant(row.challenge)}"
        return None, f"challenge: {missing}"
    try:
        return repeats(row, sim_world, workers), None
    except RobobtError as error:
        return None, str(error)


def _print(rows: list[Row], repeated: Sequence[bool | None] | None = None) -> None:
    shown = table("challenge", "entrant", "score", "95 % interval", "trials", "conditions", "hash", "commit")
    for index, row in enumerate(rows):
        same = row.low is None or row.high is None or row.low == row.high
        between = "-" if same else f"{row.low:.1f} to {row.high:.1f}"
        trace = row.trace[:8]
        if repeated is not None:
            trace += {True: " equal", False: " differs", None: " not played"}[repeated[index]]
        shown.add_row(
            row.challenge,
            name_lines(row.entrant, 80),
            f"{row.score:.1f} {escape(row.unit)}",
            between,
            f"{len(row.scores)}, seed {row.seed}",
            name_lines(_conditions(row), 80),
            trace,
            row.commit[:8] + ("+" if row.commit.endswith("+") else ""),
        )
    console.print(shown)


def _conditions(row: Row) -> str:
    """Return the settings of a row, with what they hold where it is short."""
    texts = [
        f"{name}={value}" if not isinstance(value, dict) else f"{name} changed"
        for name, value in row.settings.items()
    ]
    if row.yellow is not None:
        texts.append(f"yellow {row.yellow}")
    return ", ".join(texts) or "-"
