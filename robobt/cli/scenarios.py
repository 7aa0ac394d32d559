"""``robobt scenarios``: list the bundled scenarios."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Imports, Json, console, import_files, print_json, say, table

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from robobt.match import Scenario


def scenarios(
    name: Annotated[
        str | None, typer.Argument(help="One scenario, bundled or a file, with all of it.")
    ] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List the bundled scenarios, or show one.

    Keys of --json: scenarios, a list with name, description, file, field (length
    and width in metres), period and time_limit (seconds), trials, referee
    (whether there is one), ball (where it starts) and robots (robot, play,
    params, start: in the own team's view, own goal at -x).
    """
    from robobt.config.resources import bundled_scenarios

    import_files(imports)
    if name is None and not as_json:
        _print_list(bundled_scenarios())
        return
    from robobt.match import load_scenario

    bundled = bundled_scenarios()
    # A scenario of one's own is looked at as a match would, and its models are loaded.
    loaded = [load_scenario(source, build=source not in bundled) for source in ([name] if name else bundled)]
    if as_json:
        print_json({"scenarios": [_scenario_data(scenario) for scenario in loaded]})
        return
    _print_scenario(loaded[0])


def _print_list(files: Mapping[str, Path]) -> None:
    """Print what the files say; whether they can be played is looked at by what plays them."""
    from robobt.config.yaml import read_yaml

    listed = table("scenario", "robots", "trials", "what it is")
    # Names stay whole, except where there is no room for them and a second column.
    listed.columns[0].no_wrap = console.width >= 2 * max(map(len, files))
    for name, path in files.items():
        data = read_yaml(path)
        size = " v ".join(str(len(data["robots"].get(team, ()))) for team in ("blue", "yellow"))
        about = " ".join(data["description"].split()).partition(". ")[0].removesuffix(".")
        listed.add_row(escape(data.get("name", name)), size, str(data.get("trials", 1)), escape(about))
    console.print(listed)


def _print_scenario(scenario: Scenario) -> None:
    console.print(f"[bold]{escape(scenario.name)}[/bold]  {escape(scenario.source)}", soft_wrap=True)
    say(" ".join(scenario.description.split()))
    listed = table("", "play", "start, in the own team's view")
    for robot, setup in scenario.robots:
        given = ", ".join([f"{key}={value}" for key, value in setup.params.items()])
        listed.add_row(str(robot), escape(f"{setup.play}({given})"), escape(str(setup.start)))
    listed.add_row("ball", "", escape(str(scenario.ball)))
    console.print(listed)
    ends = scenario.ends.model_dump(exclude_none=True)
    say(f"Ends: {', '.join([f'{key} {value}' for key, value in ends.items()])}")
    referee = "with a referee" if scenario.referee is not None else "no referee"
    say(f"Control every {scenario.period:g} s, {referee}, simulator {scenario.simulator}")


def _scenario_data(scenario: Scenario) -> dict[str, object]:
    return {
        "name": scenario.name,
        "description": " ".join(scenario.description.split()),
        "file": scenario.source,
        "field": {"length": scenario.field.length, "width": scenario.field.width},
        "period": scenario.period,
        "trials": scenario.trials,
        "referee": scenario.referee is not None,
        "time_limit": scenario.ends.time_limit,
        "ball": str(scenario.ball),
        "robots": [
            {"robot": str(robot), "play": setup.play, "params": setup.params, "start": str(setup.start)}
            for robot, setup in scenario.robots
        ],
    }
