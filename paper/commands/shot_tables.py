"""``python -m paper table2`` and ``table3``: predictors of shots, beside the paper's."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli import Json, Progress, console, make_folders, one_of, print_json, say, table

if TYPE_CHECKING:
    from paper.table3 import Table3

_Data = Annotated[
    Path | None,
    typer.Option(
        "--data",
        help="Shots: a folder with train.csv and test.csv, as the paper's author published them, or a "
        "Parquet or CSV file of 'robobt shots collect'. By default our own.",
    ),
]


def table2(
    data: _Data = None,
    replications: Annotated[
        int, typer.Option("--replications", "-n", min=1, max=1000, help="How often to replicate the table.")
    ] = 10,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=10**6, help="Of the first one.")] = 0,
    as_json: Json = False,
) -> None:
    """Print Table 2: the network against logistic regression in a 10 x 10 cross-validation.

    Folds, hold-outs and seeds are drawn again for every replication. The third row is logistic regression on
    standardised inputs.

    Keys of --json: source, shots, goals, replications, seed; hold_outs, by share
    (33%, 25%): paper (the published row); network, logistic and standardised, the
    mean accuracy in percent (mean over the replications, low and high of its 95 %
    interval, least, most); test_logistic and test_standardised, the corrected
    resampled paired t-test of the network against either (means of difference,
    variance, t and p, least_p, most_p, significant: replications with p < 0.05).
    """
    import torch

    from paper.table2 import HOLD_OUTS
    from paper.table2 import table2 as run
    from robobt.shots import load_shot_sets

    torch.set_num_threads(1)
    sets = load_shot_sets(data)
    with Progress("table 2", replications * len(HOLD_OUTS)) as progress:
        result = run(sets, replications, seed, progress.advance)
    if as_json:
        print_json(asdict(result))
        return
    say(f"{result.source}: {result.shots} shots, {result.goals} goals, {replications} replications")
    for share, found in result.hold_outs.items():
        paper = found.paper
        listed = table(f"{share} held out", "paper", "mean", "95 % interval", "range")
        for title, published, ours in (
            ("network", f"{paper.network:.2f} %", found.network),
            ("logistic regression", f"{paper.logistic:.2f} %", found.logistic),
            ("standardised logistic regression", "-", found.standardised),
        ):
            interval = _interval(ours.low, ours.high)
            spread = f"{ours.least:.2f} to {ours.most:.2f}"
            listed.add_row(title, published, f"{ours.mean:.2f} %", interval, spread)
        for title, test, row in (
            ("logistic", found.test_logistic, paper),
            ("standardised", found.test_standardised, None),
        ):
            for key, digits in (("difference", 2), ("variance", 1), ("t", 2), ("p", 3)):
                published = "-" if row is None else f"{getattr(row, key):.{digits + 1}f}"
                spread = f"{test.least_p:.3f} to {test.most_p:.3f}" if key == "p" else ""
                ours_is = f"{getattr(test, key):.{digits}f}"
                listed.add_row(f"  {key}, against {title}", published, ours_is, "", spread)
            listed.add_row(f"  p < 0.05, against {title}", "", f"{test.significant} of {replications}")
        console.print(listed)


def table3(
    data: _Data = None,
    seeds: Annotated[
        int, typer.Option("--seeds", "-n", min=1, max=10_000, help="How often the network is trained.")
    ] = 100,
    repeats: Annotated[
        int, typer.Option("--repeats", min=0, max=100, help="Of the tenfold cross-validation; 0 for none.")
    ] = 10,
    model: Annotated[
        list[str] | None,
        typer.Option("--model", help="A predictor by name; may be given often. All by default."),
    ] = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", help="Draw a reliability diagram into this file (.png).")
    ] = None,
    as_json: Json = False,
) -> None:
    """Print Table 3: confusion matrices on the test shots, for the paper's network and all other predictors.

    The network of Table 1 is trained again with the paper's recipe and many seeds;
    what is listed of it is the run with the median accuracy. The author's own
    weights are judged where they lie in the data folder.

    Keys of --json: source, train and test (shots, goals), paper (confusion,
    accuracy), retrained (accuracy over the seeds: mean, low, high, sd, median,
    least, most) and models, by name: confusion (a row for failures, a row for
    successes), accuracy in percent with its Wilson interval (low, high), log_loss,
    calibration_error, reliability (bins), mcnemar against the author's network,
    cross_validation on the training shots (accuracy, log_loss, calibration_error).
    """
    import torch

    from paper.predictors import PREDICTORS
    from paper.reliability_diagram import draw_reliability
    from paper.table3 import table3 as run
    from robobt.shots import load_shot_sets

    torch.set_num_threads(1)
    one_of(model or [], PREDICTORS, "--model")
    make_folders({"--picture": picture})
    sets = load_shot_sets(data)
    models = model or list(PREDICTORS)
    with Progress("table 3", len(models)) as progress:
        result = run(sets, seeds, repeats, models, progress.advance)
    if picture is not None:
        bins = {name: one.reliability for name, one in result.models.items()}
        draw_reliability(bins, f"{result.test.shots} test shots", picture)
    if as_json:
        print_json(asdict(result))
        return
    _print_table3(result)
    if picture is not None:
        say(f"Reliability diagram: {picture}")


def _print_table3(result: Table3) -> None:
    train, test, paper = result.train, result.test, result.paper
    say(
        f"{result.source}: trained on {train.shots} shots ({train.goals} goals), "
        f"tested on {test.shots} ({test.goals} goals)"
    )
    listed = table("on the test shots", "confusion", "accuracy", "95 % interval", "log-loss", "calibration")
    listed.add_row("paper", _matrix(paper.confusion), f"{paper.accuracy:.2f} %")
    for name, one in result.models.items():
        listed.add_row(
            name,
            _matrix(one.confusion),
            f"{one.accuracy:.2f} %",
            _interval(one.low, one.high),
            f"{one.log_loss:.3f}",
            f"{one.calibration_error:.3f}",
        )
    console.print(listed)
    compared = {name: one.mcnemar for name, one in result.models.items() if one.mcnemar is not None}
    if compared:
        against = next(iter(compared.values())).against
        listed = table(f"against {against}", "only this right", "only that right", "McNemar p")
        for name, paired in compared.items():
            counts = str(paired.only_this), str(paired.only_other)
            listed.add_row(name, *counts, f"{paired.p:.3f}")
        console.print(listed)
    validated = {name: one.cross_validation for name, one in result.models.items()}
    if any(validated.values()):
        listed = table("cross-validated on the training shots", "accuracy", "log-loss", "calibration")
        for name, mean in validated.items():
            if mean is not None:
                figures = f"{mean.log_loss:.3f}", f"{mean.calibration_error:.3f}"
                listed.add_row(name, f"{mean.accuracy:.2f} %", *figures)
        console.print(listed)
    again = result.retrained
    if again is not None:
        say(
            f"The paper's recipe, {again.seeds} seeds: mean accuracy {again.mean:.2f} % "
            f"({_interval(again.low, again.high)}), median {again.median:.2f} %, "
            f"range {again.least:.1f} to {again.most:.1f} %; the paper's {paper.accuracy:.2f} %."
        )


def _matrix(confusion: list[list[int]]) -> str:
    return " / ".join(", ".join(str(count) for count in row) for row in confusion)


def _interval(low: float | None, high: float | None) -> str:
    return "" if low is None or high is None else f"{low:.2f} to {high:.2f}"
