"""``robobt tree``: shows the tree of a play."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import one_line_errors, parse_assignments, say, unknown


def add_to(app: typer.Typer) -> None:
    """Enter the group's commands."""
    app.command()(tree)


@one_line_errors
def tree(
    play: Annotated[
        str, typer.Argument(help="Name of a play (see 'robobt plays'), or a tree file (.yaml, .xml).")
    ],
    param: Annotated[
        list[str] | None,
        typer.Option("--param", "-p", help="A parameter of the play as name=value; may be given often."),
    ] = None,
    svg: Annotated[Path | None, typer.Option("--svg", help="Write the tree as a picture.")] = None,
    dot: Annotated[Path | None, typer.Option("--dot", help="Write the tree for Graphviz.")] = None,
    yaml: Annotated[Path | None, typer.Option("--yaml", help="Write the tree as a play in YAML.")] = None,
    xml: Annotated[
        Path | None,
        typer.Option("--xml", help="Write the tree as XML that Groot2 opens (BehaviorTree.CPP 4)."),
    ] = None,
) -> None:
    """Show the tree of a play, or write it to a file."""
    from robobt.match.problems import naming
    from robobt.plays import PLAYS
    from robobt.plays.files import find_play, is_play_file, tree_xml, tree_yaml
    from robobt.tree.drawing import tree_dot, tree_svg, tree_text
    from robobt.tree.parameters import ParameterError, check_parameters

    if not is_play_file(play) and play not in PLAYS:
        raise unknown("play", play, PLAYS)
    builder = find_play(play)
    try:
        root = builder(**check_parameters(play, builder, parse_assignments(param or [], "--param")))
    except ParameterError as error:
        raise typer.BadParameter(f"{error.parameter}: {error}", param_hint="--param") from error
    name = Path(play).stem
    writers: list[tuple[Path | None, Callable[[], str]]] = [
        (svg, partial(tree_svg, root)),
        (dot, partial(tree_dot, root)),
        (yaml, partial(tree_yaml, root, name)),
        (xml, partial(tree_xml, root, name)),
    ]
    for path, write in writers:
        if path is not None:
            with naming(path):
                path.write_text(write(), encoding="utf-8")
            say(f"Tree: {path}")
    if all(path is None for path, _ in writers):
        say(tree_text(root))
