"""The tree of a play: as text or in a file, mistakes in it, and what its nodes do in a match."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import MAX_SEED, errors, print_json, say, warn
from robobt.cli.option_groups.scenario import parse_play
from robobt.cli.options import option

if TYPE_CHECKING:
    from robobt.tree import Behaviour, Finding


TREE_FORMATS = (".svg", ".dot", ".yaml", ".xml")
"""How the names of files end that a tree is written to."""


@dataclass(frozen=True)
class Examined:
    """What is asked of a play's tree besides its picture."""

    lint: Annotated[bool, option("--lint", ": what is seldom meant, and entries that nothing writes")] = False
    statistics: Annotated[str | None, option("--statistics")] = None
    seed: Annotated[
        int | None, option("--seed", " of that trial; by default the scenario's", min=0, max=MAX_SEED)
    ] = None

    def given(self) -> str | None:
        """Return one of the options that was given, None if none was."""
        named = {"--lint": self.lint, "--statistics": self.statistics, "--seed": self.seed}
        return next((name for name, value in named.items() if value not in (None, False)), None)


def show_play(text: str, out: Path | None, examined: Examined, *, as_json: bool) -> None:
    """Show the tree of a play, write it to a file, look for mistakes in it, or count what its nodes do.

    Args:
        text: PLAY or PLAY:NAME=VALUE,...
        out: a file to write the tree to, its format by the ending.
        examined: what else is asked.
        as_json: whether to print one JSON object.

    Raises:
        typer.Exit: ``lint`` finds wrong wiring, which no match would play.
    """
    if examined.seed is not None and examined.statistics is None:
        raise typer.BadParameter("is for --statistics", param_hint="--seed")
    play, params = parse_play(text, "NAME")
    root = _build(play, params)
    if out is not None:
        if out.exists() and Path(play).exists() and out.samefile(play):
            raise typer.BadParameter("is the tree itself; give another name", param_hint="--out")
        _write(root, _name_of(play), out)
        if not as_json:
            say(f"Tree: {out}")
    data: dict[str, object] = {"play": play}
    wiring = _wiring(root)
    findings: list[Finding] = []
    if examined.lint:
        from robobt.tree.devtools import lint_tree

        findings = lint_tree(root)
        data.update(findings=[asdict(found) for found in findings], wiring=wiring)
    else:
        for problem in wiring:
            warn(problem)
    if examined.statistics is not None:
        data.update(_statistics(play, params, examined.statistics, examined.seed, quiet=as_json))
    if as_json:
        print_json({**data, "nodes": _nodes(root)})
    elif examined.lint:
        for found in [*wiring, *findings] or ["Nothing found."]:
            say(str(found))
    elif examined.statistics is None and out is None:
        from robobt.tree.drawing import tree_text

        say(tree_text(root))
    if examined.lint and wiring:
        raise typer.Exit(1)


def _name_of(play: str) -> str:
    """Return a play's name without its Python files; the name that a tree file gives, if it is one's."""
    from robobt.plays.files import find_play, is_play_file
    from robobt.plays.private_files import split_play

    inner = split_play(play)[1]
    return find_play(play).__name__ if is_play_file(inner) else inner


def _write(root: Behaviour, name: str, out: Path) -> None:
    from robobt.config.atomic import write_atomically
    from robobt.plays.files import tree_xml, tree_yaml
    from robobt.tree.drawing import tree_dot
    from robobt.tree.svg import tree_svg

    writers: dict[str, Callable[[], str]] = {
        ".svg": partial(tree_svg, root),
        ".dot": partial(tree_dot, root),
        ".yaml": partial(tree_yaml, root, name),
        ".xml": partial(tree_xml, root, name),
    }
    write_atomically(out, writers[out.suffix.lower()]())


def _build(play: str, params: dict[str, object]) -> Behaviour:
    from robobt.config.errors import RobobtError
    from robobt.plays.files import build_play, problem_with_play
    from robobt.plays.mistakes import PlayError, mistake_in_play
    from robobt.tree.parameters import ParameterError

    if problem := problem_with_play(play):
        raise typer.BadParameter(problem)
    try:
        return build_play(play, params)
    except ParameterError as error:
        raise typer.BadParameter(f"{error.parameter}: {error}", param_hint="NAME") from error
    except RobobtError:
        raise
    except Exception as error:
        raise PlayError(mistake_in_play(error)) from error


def _nodes(root: Behaviour) -> list[dict[str, object]]:
    from robobt.tree import node_path, preorder

    depths = {root: 0}
    for node in preorder(root):
        depths.update(dict.fromkeys(node.children, depths[node] + 1))
    return [
        {"path": node_path(node), "type": type(node).__name__, "depth": depths[node]}
        for node in preorder(root)
    ]


def _wiring(root: Behaviour) -> list[str]:
    """Return which entries the tree reads that no node writes, or writes with another type."""
    from robobt.skills.store import GIVEN, Store
    from robobt.tree import WiringError, check_tree

    try:
        check_tree(root, Store, GIVEN)
    except WiringError as error:
        return list(error.problems)
    return []


def _statistics(
    play: str, params: dict[str, object], source: str, seed: int | None, *, quiet: bool
) -> dict[str, object]:
    from robobt.match import load_scenario
    from robobt.match.node_statistics import node_statistics, robots_with
    from robobt.worlds import sim_world

    scenario = load_scenario(source)
    if not robots_with(scenario, play):
        players = [(robot, setup) for robot, setup in scenario.robots if not setup.goalkeeper]
        robot, setup = (players or list(scenario.robots))[0]
        instead = f"{robot} plays it in place of {setup.play}"
        warn(f"{scenario.name!r} has no robot with this play; {instead}")
        scenario = scenario.with_robot(robot, play=play, **params)
    with errors.status("playing"):
        counted = node_statistics(scenario, sim_world, play, seed)
    if not quiet:
        for robot, statistics in counted.items():
            say(f"{robot}\n{statistics.as_table()}")
    robots = {
        str(robot): [
            {name: value for name, value in asdict(one).items() if name != "last"}
            for one in statistics.counts()
        ]
        for robot, statistics in counted.items()
    }
    used = scenario.seed if seed is None else seed
    return {"scenario": scenario.name, "seed": used, "robots": robots}
