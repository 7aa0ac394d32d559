"""How skills hold where robot and field differ from those of training: delay, kicks, dribbler, simulators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import typer
from rich.markup import escape

from robobt.cli.common import MAX_SEED, Json, console, errors, print_json, table
from robobt.config.errors import short_repr, unknown_name
from robobt.learning.agents.networks import one_thread
from robobt.learning.envs import ShootSettings, TaskSettings, make_task
from robobt.learning.training.fresh_starts import JudgingError, judge, trained_policy
from robobt.learning.training.results import Evaluation
from robobt.models.card import Measured
from robobt.models.export import add_figures, read_amendable
from robobt.models.find import find_model

CELLS: dict[str, dict[str, Any]] = {
    "as trained": {},
    "+60 ms": {"delay": 0.06},
    "+100 ms": {"delay": 0.1},
    "kicks x 0.7": {"randomisation": {"kick_speed": (0.7, 0.7)}},
    "kicks x 1.3": {"randomisation": {"kick_speed": (1.3, 1.3)}},
    "dribbler x 0.5": {"randomisation": {"dribbler": (0.5, 0.5)}},
    "default": {"simulator": "default"},
    "grsim": {"simulator": "grsim"},
    "erforce": {
        "simulator": "erforce",
        "shoot_starts": {"robot_speed": (0.0, 0.5), "robot_turn": (-0.5, 0.5), "ball_aside": (-0.01, 0.01)},
    },
    "sumatra": {"simulator": "sumatra"},
    "rsim": {"simulator": "rsim"},
    "realistic": {"noise": {"robot_position": 0.0013, "ball_position": 0.0014, "heading": 0.01}},
}
"""Changes to the training environment by cell. ``delay`` is the whole delay beyond that of training [s];
all randomisation of training is off, except for its delay's least value. ``shoot_starts`` are those of Shoot:
ER-Force's dribbler holds a ball only near its middle, of a robot that drives slowly."""

_ITS_OWN = ("action", "period", "decide_every", "memory")
"""Settings of an environment by which a policy observes and acts."""


def cell_environment(environment: TaskSettings, changes: Mapping[str, Any]) -> TaskSettings:
    """Return the environment of a cell: that of training without its randomisation, and changed."""
    data = environment.model_dump()
    least = environment.randomisation.control_delay[0]
    delay = least + float(changes.get("delay", 0.0))
    data["randomisation"] = {"control_delay": (delay, delay), **changes.get("randomisation", {})}
    for name in ("simulator", "noise"):
        if name in changes:
            data[name] = changes[name]
    if isinstance(environment, ShootSettings) and "shoot_starts" in changes:
        data["starts"].update(changes["shoot_starts"])
    if "simulator" in changes:
        # Robots are the simulator's own, as far as the policy commands them.
        data["limits"] = None
    return type(environment).model_validate(data)


def degradation(
    sources: Sequence[str], starts: int, seed: int, cells: Sequence[str] = ()
) -> dict[str, dict[str, Evaluation]]:
    """Return results by cell and player, all in the environment that the first policy was trained in.

    In Shoot robots are driven gently if any of the policies needs it.

    Args:
        sources: runs or models of one task; each observes and acts as it was trained to.
        starts: of each cell.
        seed: of starts and noise.
        cells: names of :data:`CELLS`; all if empty.

    Raises:
        JudgingError: a policy cannot be judged, or was trained for another task than the first.
    """
    found: dict[str, dict[str, Evaluation]] = {}
    policies = {source: trained_policy(source) for source in sources}
    first = policies[sources[0]][0]
    for source, (environment, _) in policies.items():
        if type(environment) is not type(first):
            raise JudgingError(f"{source}: was trained for another task than {sources[0]}")
    if isinstance(first, ShootSettings):
        gently = any(getattr(environment, "gentle", False) for environment, _ in policies.values())
        first = first.model_copy(update={"gentle": gently})
    for name, changes in CELLS.items():
        if cells and name not in cells:
            continue
        results: dict[str, Evaluation] = {}
        for source, (environment, policy) in policies.items():
            own = {name: getattr(environment, name) for name in _ITS_OWN}
            cell = cell_environment(first.model_copy(update=own), changes)
            judged = judge(cell, {source: policy}, starts, seed, not results)
            results = {**results, source: judged.pop(source), **judged}
        found[name] = results
    return found


def write_on_card(source: str, found: Mapping[str, Mapping[str, Evaluation]]) -> None:
    """Put a model's success in each cell on its card.

    Args:
        source: the model's name or file, a player in ``found``.
        found: see :func:`degradation`.

    Raises:
        ModelError: there is no such model, or its card cannot be written.
    """
    figures = {}
    for cell, results in found.items():
        one = results[source]
        low, high = one.interval
        figures[f"success, {cell}"] = Measured(
            value=one.rate, low=low, high=high, n=len(one.success), interval="95 % Wilson"
        )
    add_figures(find_model(source), figures)


def command(
    runs: Annotated[list[str], typer.Argument(help="Folders of runs, or models, all of one task.")],
    starts: Annotated[int, typer.Option("--starts", min=1)] = 200,
    seed: Annotated[int, typer.Option("--seed", min=0, max=MAX_SEED)] = 0,
    cells: Annotated[list[str] | None, typer.Option("--only", help="A cell's name.")] = None,
    card: Annotated[
        bool, typer.Option("--card", help="Also put the first one's figures on its card; it must be a model.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Print how often policies, the script and the skill succeed in each cell, with 95 % Wilson intervals.

    Keys of --json: task, starts, seed; cells, by name and player: success, low, high, mean_time (seconds).
    """
    for name in cells or ():
        if name not in CELLS:
            problem = f"no cell is called {short_repr(name)}; {unknown_name(name, CELLS)}"
            raise typer.BadParameter(problem, param_hint="--only")
    if card:
        # Before they are measured for minutes.
        read_amendable(find_model(runs[0]))
    with one_thread(), errors.status("playing"):
        found = degradation(runs, starts, seed, cells or ())
        task = make_task(trained_policy(runs[0])[0], 1).name
    _show(found, task, starts, seed, as_json=as_json)
    if card:
        # Last, so that a card that cannot be written loses no figures.
        write_on_card(runs[0], found)


def _show(
    found: Mapping[str, Mapping[str, Evaluation]], task: str, starts: int, seed: int, *, as_json: bool
) -> None:
    if as_json:
        figures = {
            cell: {
                name: {
                    "success": one.rate,
                    "low": one.interval.low,
                    "high": one.interval.high,
                    "mean_time": one.mean_time,
                }
                for name, one in results.items()
            }
            for cell, results in found.items()
        }
        print_json({"task": task, "starts": starts, "seed": seed, "cells": figures})
        return
    names = list(dict.fromkeys(name for results in found.values() for name in results))
    shown = table("cell", *map(escape, names))
    for cell, results in found.items():
        row = []
        for name in names:
            one = results.get(name)
            row.append(
                "-" if one is None else f"{one.rate:.1%} ({one.interval.low:.0%} to {one.interval.high:.0%})"
            )
        shown.add_row(cell, *row)
    console.print(shown)
