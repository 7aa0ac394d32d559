"""``robobt compare``: variants of a scenario, paired by seed."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    Imports,
    Json,
    Progress,
    Seed,
    Workers,
    console,
    cores,
    import_files,
    name_lines,
    print_json,
    say,
    table,
    warn,
    world_of,
)
from robobt.cli.option_groups.scenario import Set, scenario_of, with_teams
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.match import MatchResult, Scenario
    from robobt.match.results.compare import Compared, Difference


@dataclass(frozen=True)
class Variants:
    """What is compared."""

    blue: Annotated[list[str] | None, option("--blue", "; repeat it to compare")] = None
    yellow: Annotated[list[str] | None, option("--yellow", "; repeat it to compare")] = None
    world: Annotated[list[str] | None, option("--world", "; repeat it to compare")] = None

    def of(self, base: Scenario) -> dict[str, tuple[Scenario, str]]:
        """Return every combination by a label of what differs."""
        blues, yellows, worlds = self.blue or [""], self.yellow or [""], self.world or ["sim"]
        found = {}
        for blue, yellow, world in product(blues, yellows, worlds):
            varied = [(blue, len(blues)), (yellow, len(yellows)), (world, len(worlds))]
            label = " | ".join([text or "as it is" for text, options in varied if options > 1])
            if label in found:
                raise typer.BadParameter(f"{label!r} is given twice")
            found[label] = (with_teams(base, blue, yellow), world)
        return found


def compare(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the name of a bundled one.")],
    *,
    varied: Variants,
    settings: Set = None,
    trials: Annotated[
        int | None,
        option("--trials", " with each variant; by default the scenario's number", min=1, max=100_000),
    ] = None,
    seed: Seed = None,
    workers: Workers = None,
    out: Annotated[
        Path | None,
        option(
            "--out",
            " every trial's result; the same command continues a run that was stopped",
            metavar="FOLDER",
        ),
    ] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Play variants of a scenario from the same starts with the same seeds, and compare them pair by pair.

    Each of --blue, --yellow and --world may be given often: all combinations are
    played, the first is what the others are compared with. An empty text ("") is
    the scenario as it is. Intervals are of 95 %.

    Keys of --json: scenario, seed, trials; variants, by what was varied: trials,
    distinct (trials that differ from each other), scored (trials in which blue
    scores: count, rate, low, high), outcomes, to_ball and to_kick (seconds until
    a robot of blue has the ball, and has kicked it: n, mean, variance), errors
    (ticks in which a robot's tree failed), first_error;
    against_first, null for the first: scored, goals (blue's minus yellow's),
    to_ball and to_kick, each a difference, this variant minus the first, with n,
    mean, low and high; only_this and only_first (trials in which blue scores with
    this variant alone, and with the first alone), p (McNemar, exact) and holm (p
    corrected for the number of variants).
    """
    from robobt.match.results.compare import compare_results

    import_files(imports)
    base = scenario_of(scenario, settings)
    variants = varied.of(base)
    if len(variants) < 2:
        raise typer.BadParameter("needs two variants: give --blue, --yellow or --world more than once")
    count = base.trials if trials is None else trials
    used = base.seed if seed is None else seed
    if out is not None and out.exists() and not out.is_dir():
        raise typer.BadParameter(f"'{out}' is not a folder", param_hint="--out")
    make_folders({"--out": out}, folders=True)
    results: dict[str, list[MatchResult]] = {}
    with Progress("compare", count * len(variants)) as progress:
        for label, (variant, address) in variants.items():
            file = None if out is None else out / _file_name(label)
            results[label] = _played(variant, address, count, used, workers, file, progress.advance)
    found = compare_results(results)
    if as_json:
        figures = {label: asdict(one) for label, one in found.items()}
        print_json({"scenario": base.name, "seed": used, "trials": count, "variants": figures})
        return
    console.print(f"[bold]{escape(base.name)}[/bold]: {counted(count, 'trial')} a variant, seed {used}")
    _print(found)


def _file_name(label: str) -> str:
    """Return a name of printable characters, not too long for a folder, that no other label has."""
    digest = hashlib.blake2b(label.encode(), digest_size=4).hexdigest()
    return f"{re.sub(r'[^A-Za-z0-9.-]+', '_', label)[:100].strip('_.')}_{digest}.jsonl"


def _played(
    scenario: Scenario,
    address: str,
    count: int,
    seed: int,
    workers: int | None,
    out: Path | None,
    advance: Callable[[], object],
) -> list[MatchResult]:
    from robobt.match import run_trials_in
    from robobt.worlds import SIM, scenario_settings

    def on_result(_: MatchResult) -> None:
        advance()

    scenario_settings(scenario)
    if address != SIM and workers not in (None, 1):
        raise typer.BadParameter("must be 1 to play over the network", param_hint="--workers")
    processes = workers or (min(cores(), -(-count // 4)) if address == SIM else 1)
    with world_of(address) as factory:
        run = run_trials_in(scenario, factory, count, processes, seed, out, {}, on_result)
    if run.interrupted:
        goes_on = "without --out nothing is kept" if out is None else "the same command goes on with it"
        warn(f"stopped; {goes_on}")
        raise typer.Exit(130)
    return list(run.results)


def _print(found: dict[str, Compared]) -> None:
    rates = table("variant", "blue scores", "95 % interval", "to the ball", "to the kick")
    for label, one in found.items():
        if one.distinct < one.trials:
            warn(
                f"{label}: only {one.distinct} of {counted(one.trials, 'trial')} differ; "
                "vary the starts or add noise"
            )
        if one.errors:
            warn(f"{label}: trees failed in {counted(one.errors, 'tick')}; the first: {one.first_error}")
        rates.add_row(
            name_lines(label, 58),
            f"{one.scored.count} of {one.trials}",
            one.scored.interval(),
            "-" if one.to_ball.mean is None else f"{one.to_ball.mean:.3f} s",
            "-" if one.to_kick.mean is None else f"{one.to_kick.mean:.3f} s",
        )
    console.print(rates)
    (first, _), *others = found.items()
    for label, one in others:
        against = one.against_first
        assert against is not None
        say(f"\n{label}, compared with {first}:")
        gaps = table("", "difference", "95 % interval", "p", "Holm's p")
        tested = (f"{against.p:.2g}", f"{against.holm:.2g}")
        gaps.add_row("blue scores", *_texts(against.scored, 100.0, " points"), *tested)
        gaps.add_row("goals, blue minus yellow", *_texts(against.goals, 1.0, ""))
        gaps.add_row("to the ball", *_texts(against.to_ball, 1.0, " s"))
        gaps.add_row("to the kick", *_texts(against.to_kick, 1.0, " s"))
        console.print(gaps)
        only = f"in {counted(against.only_this, 'trial')}, the other way round in {against.only_first}"
        say(f"Blue scores with {label} but not with {first} {only}.")


def _texts(one: Difference, scale: float, unit: str) -> tuple[str, str]:
    """Return the difference and its interval as text."""
    if one.mean is None:
        return ("-", "-")
    digits = 1 if scale > 1.0 else 3
    mean = f"{one.mean * scale:+.{digits}f}{unit}"
    if one.low is None or one.high is None:
        return (mean, "-")
    return (mean, f"{one.low * scale:+.{digits}f} to {one.high * scale:+.{digits}f}")
