"""The bundled scenarios in a list, and one with all of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rich.markup import escape

from robobt.cli.common import console, print_json, say, table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robobt.match import Scenario


def list_scenarios(*, as_json: bool) -> None:
    """List the bundled scenarios."""
    from robobt.config.resources import bundled_scenarios

    if not as_json:
        _print_list(bundled_scenarios())
        return
    from robobt.match import load_scenario

    loaded = [load_scenario(source, build=False) for source in bundled_scenarios()]
    print_json({"scenarios": [_scenario_data(scenario) for scenario in loaded]})


def show_scenario(name: str, out: Path | None, *, as_json: bool) -> None:
    """Print a scenario, bundled or of a file, or write a copy of its file to ``out``."""
    from robobt.config.resources import bundled_scenarios
    from robobt.match import load_scenario

    bundled = bundled_scenarios()
    # A scenario of one's own is checked as a match would check it, and its models are loaded.
    loaded = load_scenario(name, build=name not in bundled)
    if out is not None:
        from robobt.config.atomic import write_atomically

        write_atomically(out, bundled.get(name, Path(name)).read_bytes())
    if as_json:
        print_json({"scenarios": [_scenario_data(loaded)]})
    elif out is not None:
        say(f"Scenario: {out}")
    else:
        _print_scenario(loaded)
        say(f"All of it as a file to change: robobt show {name} --out mine.yaml")


def _print_list(files: Mapping[str, Path]) -> None:
    """Print what the files say; whether they can be played is looked at by what plays them."""
    from robobt.config.yaml import read_yaml

    listed = table("scenario", "robots", "trials", "what it is")
    listed.columns[0].no_wrap = True
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
