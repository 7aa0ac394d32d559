"""Parts of the site that are made: tutorials, reference and llms.txt."""

from __future__ import annotations

import ast
import inspect
import json
import re
from base64 import b64encode
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files

TUTORIALS = Path(__file__).parent / "docs" / "tutorials"
PAPER = "python -m paper"


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the tutorials and the pages of the reference."""
    from mkdocs.structure.files import File

    pages = {f"tutorials/{path.stem}.md": tutorial(path) for path in TUTORIALS.glob("*.ipynb")}
    for name, make in (
        ("commands", commands),
        ("files", file_formats),
        ("observations", observations),
        ("plays", plays),
        ("skills", skills),
        ("python", python_names),
    ):
        pages[f"reference/{name}.md"] = make()
    pages["llms.txt"] = llms_txt(config.site_name, config.site_description, config.nav)
    for name, content in pages.items():
        files.append(File.generated(config, name, content=content))
    return files


def llms_txt(name: str, description: str, nav: list[dict[str, Any]]) -> str:
    """Write the contents of the site for language models, as https://llmstxt.org describes it."""
    sections: dict[str, list[str]] = {}
    for entry in nav:
        for title, inside in entry.items():
            single = isinstance(inside, str)
            lines = sections.setdefault("Start here" if single else title, [])
            for page in [{title: inside}] if single else inside:
                lines += [f"- [{about}]({path.removesuffix('.md')}.html)" for about, path in page.items()]
    parts = [f"## {title}\n\n" + "\n".join(lines) + "\n" for title, lines in sections.items()]
    return "\n".join([f"# {name}\n", f"> {description}\n", *parts])


def tutorial(path: Path) -> str:
    """Return a notebook as a page: prose, code, and below each cell what it printed and showed."""
    parts = []
    for cell in json.loads(path.read_text())["cells"]:
        code = cell["cell_type"] == "code"
        parts.append(f"```python\n{cell['source']}\n```" if code else cell["source"])
        for output in cell.get("outputs", ()):
            data = output.get("data", {"text/plain": output.get("text")})
            if "image/svg+xml" in data:
                picture = b64encode(data["image/svg+xml"].encode()).decode()
                parts.append(f"![What the cell shows](data:image/svg+xml;base64,{picture})")
            elif "text/html" in data:
                parts.append(data["text/html"])
            else:
                parts.append(f"``` {{ .text .output .no-copy }}\n{data['text/plain'].rstrip()}\n```")
    parts.append(f"[This page as a notebook]({path.name})")
    return "\n\n".join(parts) + "\n"


def commands() -> str:
    """Write what every command says of itself."""
    import typer.main

    from paper.__main__ import application
    from robobt.cli import app

    parts = ["# Commands\n", *_command(typer.main.get_command(app), "robobt", 2), options_table()]
    paper = typer.main.get_command(application())
    parts += [f"## {PAPER}\n\n{paper.help} It runs in a clone of the repository.\n"]
    for name, command in paper.commands.items():
        parts += _command(command, f"{PAPER} {name}", 3)
    return "\n".join(parts)


def options_table() -> str:
    """Write what each option means, which is the same in every command that has it."""
    from robobt.cli.options import LETTERS, MEANINGS

    rows = [
        f"| `{name}`{f', `{LETTERS[name]}`' if name in LETTERS else ''} | {_cell(meaning)} |"
        for name, meaning in sorted(MEANINGS.items())
    ]
    head = "An option means one thing in all commands of robobt; a command may add what is its own."
    return "\n".join(["## All options\n", f"{head}\n", "| option | meaning |", "| --- | --- |", *rows, ""])


def _command(command: Any, path: str, level: int) -> Iterable[str]:
    if path != "robobt":
        yield f"{'#' * level} {path}\n\n{_text(inspect.cleandoc(command.help or ''))}\n"
    options = [one for one in command.params if not getattr(one, "hidden", False) and one.name != "help"]
    if options:
        yield "| | |\n| --- | --- |"
        for option in options:
            names = ", ".join(option.opts) if option.param_type_name == "option" else option.name
            yield f"| `{names}` | {_cell(getattr(option, 'help', '') or '')} |"
        yield ""
    for name, inner in getattr(command, "commands", {}).items():
        if inner.hidden:
            continue
        yield from _command(inner, f"{path} {name}", level + (path != "robobt"))


def file_formats() -> str:
    """Write the fields of every file that a person writes."""
    from robobt.learning.agents.settings import AgentSettings
    from robobt.learning.envs.go_to_ball.rewards import GoToBallReward
    from robobt.learning.envs.go_to_ball.settings import GoToBallAmongRobotsSettings, GoToBallSettings
    from robobt.learning.envs.score_on_goalkeeper.rewards import ScoreReward
    from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
    from robobt.learning.envs.shoot.rewards import ShootReward
    from robobt.learning.envs.shoot.settings import ShootSettings
    from robobt.learning.envs.soccer.rewards import SoccerReward
    from robobt.learning.envs.soccer.settings import SoccerSettings
    from robobt.learning.training.settings import TrainSettings
    from robobt.match.scenario.scenario import Scenario
    from robobt.models.card import ModelCard
    from robobt.sim import SimSettings
    from robobt.skills.tactics_settings import TacticsSettings
    from robobt.tournament.entrants import EntrantFile

    roots = {
        "Scenario files": Scenario,
        "The simulator's settings": SimSettings,
        "Entrants of tournaments": EntrantFile,
        "Training": TrainSettings,
        "Agents": AgentSettings,
        "The environment Go-To-Ball": GoToBallSettings,
        "The environment Go-To-Ball among robots": GoToBallAmongRobotsSettings,
        "Reward terms of Go-To-Ball": GoToBallReward,
        "The environment Shoot": ShootSettings,
        "Reward terms of Shoot": ShootReward,
        "The environment Score on a goalkeeper": ScoreOnGoalkeeperSettings,
        "Reward terms of Score on a goalkeeper": ScoreReward,
        "Tasks of several robots": SoccerSettings,
        "Reward terms of several robots": SoccerReward,
        "Model cards": ModelCard,
        "Tactics of a team": TacticsSettings,
    }
    told: set[str] = set()
    parts = ["# Files\n\nThe fields of the files that one writes, with their units, as they are checked.\n"]
    for title, model in roots.items():
        schema = model.model_json_schema(mode="validation")
        parts.append(f"## {title}\n\n{_text(inspect.getdoc(model) or '')}\n")
        parts.append(_fields(schema))
        for name, inner in schema.get("$defs", {}).items():
            if name not in told and inner.get("properties"):
                told.add(name)
                parts.append(f"### {name}\n\n{_text(inner.get('description', ''))}\n\n{_fields(inner)}")
    return "\n".join(parts)


def _fields(schema: dict[str, Any]) -> str:
    rows = ["| field | type | default | meaning |", "| --- | --- | --- | --- |"]
    for name, field in schema.get("properties", {}).items():
        default = "required" if name in schema.get("required", ()) else json.dumps(field.get("default"))
        default = default if len(default) < 60 else "see there"
        rows.append(
            f"| `{name}` | {_type(field)} | `{_cell(default)}` | {_cell(field.get('description', ''))} |"
        )
    return "\n".join(rows) + "\n"


def _type(field: dict[str, Any]) -> str:
    if "$ref" in field:
        return _cell(field["$ref"].rpartition("/")[2])
    if "enum" in field or "const" in field:
        return _cell(", ".join(map(str, field.get("enum", [field.get("const")]))))
    for key in ("anyOf", "oneOf", "allOf"):
        if key in field:
            return " or ".join([_type(one) for one in field[key]])
    if field.get("type") == "array" and isinstance(field.get("items"), dict):
        return f"list of {_type(field['items'])}"
    return _cell(str(field.get("type", "any")))


def observations() -> str:
    """Write what each observation vector holds, and what the environments are."""
    from robobt.learning import envs
    from robobt.world import features, scoring

    said = {}
    for module in (features, scoring):
        body = ast.parse(inspect.getsource(module)).body
        for line, after in pairwise(body):
            if isinstance(line, ast.Assign) and isinstance(after, ast.Expr):
                said[ast.unparse(line.targets[0])] = ast.literal_eval(after.value)
    parts = [
        "# Observations and environments\n\nWhat learned skills and predictors are given, by the name that a "
        "model's card says. Lengths are in metres, angles in radians.\n"
    ]
    for spec in features.OBSERVATIONS.values():
        parts.append(f"## {spec.name}, version {spec.version}\n\n{_text(said.get(spec.name.upper(), ''))}\n")
        parts.append("| index | entry | unit | range | scale |\n| --- | --- | --- | --- | --- |")
        parts += [
            f"| {place} | `{one.name}` | {one.unit} | {one.range} | {one.scale} |"
            for place, one in enumerate(spec.entries)
        ]
        parts.append("")
    parts.append("## Environments\n\nHow each is used: [training environments](../environments.md).\n")
    specified = envs.GoToBallTask, envs.GoToBallAmongRobotsTask, envs.ShootTask, envs.ScoreOnGoalkeeperTask
    parts += [f"::: {kind.__module__}.{kind.__qualname__}\n" for kind in specified]
    return "\n".join(parts)


def plays() -> str:
    """Write every play."""
    from robobt.plays import PLAYS

    return _objects("Plays", [PLAYS[name] for name in PLAYS])


def skills() -> str:
    """Write every skill and condition, with its parameters and what it reads and writes."""
    from robobt.skills import SKILLS
    from robobt.tree.parameters import parameters_of
    from robobt.tree.signatures import meanings_of

    parts = [
        "# Skills and conditions\n\nWhat leaves of a tree there are: `from robobt.skills import ...`. A "
        "**condition** only looks: it succeeds or fails at once and commands nothing.\n"
    ]
    for name in SKILLS:
        skill = SKILLS[name]
        meanings = meanings_of(skill)
        kind = "**Condition.** " if skill.condition else ""
        parts.append(f"## {name}\n\n{kind}{_text(re.split(r'(?m)^Args:', inspect.getdoc(skill) or '')[0])}")
        own = [one for one in parameters_of(skill) if one.name != "name"]
        if own:
            parts.append("| parameter | type | default | meaning |\n| --- | --- | --- | --- |")
        for one in own:
            default = "required" if one.required else _cell(str(one.default))
            meaning = _cell(meanings.get(one.name, ""))
            parts.append(f"| `{one.name}` | {_cell(one.kind)} | `{default}` | {meaning} |")
        for verb, entries in (("Reads", skill.reads), ("Writes", skill.writes)):
            if entries:
                parts.append(f"\n{verb} {', '.join(f'`{entry}`' for entry in entries)}.")
        parts.append("")
    return "\n".join(parts)


def python_names() -> str:
    """Write the names of a first session, those of trees and those of tests."""
    import robobt
    import robobt.testing
    import robobt.tree
    import robobt.tree.nodes

    names = [getattr(robobt, name) for name in robobt.__all__]
    names += [getattr(robobt.tree.nodes, name) for name in dir(robobt.tree.nodes)]
    names += [getattr(robobt.tree, name) for name in dir(robobt.tree)]
    names += [getattr(robobt.testing, name) for name in dir(robobt.testing)]
    own = {id(one): one for one in names if getattr(one, "__module__", "").startswith("robobt.")}
    return _objects(
        "Python", [one for one in own.values() if inspect.isclass(one) or inspect.isfunction(one)]
    )


def _objects(title: str, objects: Iterable[Any]) -> str:
    entries = [f"::: {one.__module__}.{one.__qualname__}\n" for one in objects]
    return f"# {title}\n\n" + "\n".join(entries)


def _text(text: str) -> str:
    """Return a docstring as Markdown: roles and double backticks become code."""
    text = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", text).replace("``", "`")
    return text.replace("\n    ", "\n")


def _cell(text: str) -> str:
    return " ".join(_text(str(text)).split()).replace("|", "\\|")
