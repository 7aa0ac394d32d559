"""``robobt tree``: shows the tree of a play, looks for mistakes in it and counts what its nodes do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    Imports,
    Json,
    Seed,
    complete_play,
    errors,
    import_files,
    parse_assignments,
    print_json,
    say,
    warn,
)
from robobt.cli.outputs import make_folders

if TYPE_CHECKING:
    from robobt.tree import Behaviour


@dataclass(frozen=True)
class Files:
    """Files that the tree is written to."""

    svg: Annotated[Path | None, typer.Option("--svg", help="Write the tree as a picture.")] = None
    dot: Annotated[Path | None, typer.Option("--dot", help="Write the tree for Graphviz.")] = None
    yaml: Annotated[Path | None, typer.Option("--yaml", help="Write the tree as a play in YAML.")] = None
    xml: Annotated[
        Path | None,
        typer.Option("--xml", help="Write the tree as XML that Groot2 opens (BehaviorTree.CPP 4)."),
    ] = None

    def write(self, root: Behaviour, name: str, *, quiet: bool) -> bool:
        """Write the tree to those that are named; whether there was one."""
        from robobt.config.atomic import write_atomically
        from robobt.plays.files import tree_xml, tree_yaml
        from robobt.tree.drawing import tree_dot
        from robobt.tree.svg import tree_svg

        writers: list[tuple[Path | None, Callable[[], str]]] = [
            (self.svg, partial(tree_svg, root)),
            (self.dot, partial(tree_dot, root)),
            (self.yaml, partial(tree_yaml, root, name)),
            (self.xml, partial(tree_xml, root, name)),
        ]
        named = [(path, text) for path, text in writers if path is not None]
        for path, text in named:
            write_atomically(path, text())
            if not quiet:
                say(f"Tree: {path}")
        return bool(named)


def tree(
    play: Annotated[
        str,
        typer.Argument(
            help="Name of a play (see 'robobt plays'), or a tree file (.yaml, .xml).",
            autocompletion=complete_play,
        ),
    ],
    param: Annotated[
        list[str] | None,
        typer.Option("--param", "-p", help="A parameter of the play as name=value; may be given often."),
    ] = None,
    *,
    files: Files,
    lint: Annotated[
        bool, typer.Option("--lint", help="Look for what is seldom meant, and for entries nobody writes.")
    ] = False,
    statistics: Annotated[
        str | None,
        typer.Option(
            "--statistics",
            metavar="SCENARIO",
            help="Play a trial of this scenario and count what the nodes of the robots with this play do.",
        ),
    ] = None,
    seed: Seed = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Show the tree of a play, write it to a file, look for mistakes in it, or count what its nodes do.

    Keys of --json: play; nodes, each with path, type and depth. With --lint:
    findings, each with path, rule and message; wiring: entries of the store that
    are read and that nobody writes, or of another type. With --statistics:
    scenario, seed, and robots: for each robot its nodes with path, ticks,
    transitions (of status), successes, failures, runs (ticks that left it
    running), own_time and time (with all below it), in seconds.

    Exit code 1 when --lint finds wrong wiring, which no match would play.
    """
    if seed is not None and statistics is None:
        raise typer.BadParameter("is for --statistics", param_hint="--seed")
    import_files(imports)
    root = _build(play, param or [])
    make_folders({f"--{name}": path for name, path in vars(files).items()})
    written = files.write(root, Path(play).stem, quiet=as_json)
    data: dict[str, object] = {"play": play}
    wiring = _wiring(root)
    findings = _findings(root) if lint else []
    if lint:
        data.update(findings=findings, wiring=wiring)
    else:
        for problem in wiring:
            warn(problem)
    if statistics is not None:
        data.update(_statistics(play, statistics, seed, quiet=as_json))
    if as_json:
        print_json({**data, "nodes": _nodes(root)})
    elif lint:
        _print_findings(wiring, findings)
    elif statistics is None and not written:
        from robobt.tree.drawing import tree_text

        say(tree_text(root))
    if lint and wiring:
        raise typer.Exit(1)


def _build(play: str, params: list[str]) -> Behaviour:
    from robobt.config.errors import RobobtError
    from robobt.plays.files import build_play, problem_with_play
    from robobt.plays.mistakes import PlayError, mistake_in_play
    from robobt.tree.parameters import ParameterError

    if problem := problem_with_play(play):
        raise typer.BadParameter(problem)
    given = parse_assignments(params, "--param")
    try:
        return build_play(play, given)
    except ParameterError as error:
        raise typer.BadParameter(f"{error.parameter}: {error}", param_hint="--param") from error
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


def _findings(root: Behaviour) -> list[dict[str, str]]:
    from robobt.tree.devtools import lint_tree

    return [{"path": found.path, "rule": found.rule, "message": found.message} for found in lint_tree(root)]


def _print_findings(wiring: list[str], findings: list[dict[str, str]]) -> None:
    for problem in wiring:
        say(problem)
    for found in findings:
        say(f"{found['path']}: {found['message']} [{found['rule']}]")
    if not wiring and not findings:
        say("Nothing found.")


def _statistics(play: str, source: str, seed: int | None, *, quiet: bool) -> dict[str, object]:
    from robobt.match import load_scenario
    from robobt.match.node_statistics import node_statistics
    from robobt.worlds import sim_world

    scenario = load_scenario(source)
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
