"""``robobt show``: one thing with all of it, by its name or file."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import Imports, Json, complete_play, import_files
from robobt.cli.option_groups.page import Page
from robobt.cli.options import option
from robobt.cli.outputs import RECORDING, make_folders
from robobt.cli.shown.lists import REGISTERED, list_registered, registry_of
from robobt.cli.shown.play import TREE_FORMATS, Examined, show_play
from robobt.cli.shown.recording import RECORDING_FORMATS, Shown, show_recording
from robobt.league.log.names import LOGS


class ThingKind(StrEnum):
    """What can be shown."""

    PLAY = "play"
    SKILL = "skill"
    RATER = "rater"
    POLICY = "policy"
    MODEL = "model"
    SCENARIO = "scenario"
    TASK = "task"
    RECORDING = "recording"


_PLURALS = {
    ThingKind.SKILL: "skills",
    ThingKind.RATER: "raters",
    ThingKind.POLICY: "policies",
    ThingKind.TASK: "tasks",
}
_FORMATS = {
    ThingKind.PLAY: TREE_FORMATS,
    ThingKind.SCENARIO: (".yaml",),
    ThingKind.MODEL: (".md",),
    ThingKind.RECORDING: RECORDING_FORMATS,
}


def show(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="A play (with parameters, as in PLAY:NAME=VALUE), skill, rater, policy, model, scenario or "
            "task by its name, or the file of a recording, league log, model, tree or scenario.",
            autocompletion=complete_play,
        ),
    ],
    kind: Annotated[ThingKind | None, option("--kind")] = None,
    out: Annotated[
        Path | None,
        option(
            "--out",
            " it; the name's ending is the format: .svg, .dot, .yaml or .xml for a play's tree, .yaml for a "
            "scenario, .html, .gif or .png for a recording, .md for a model's card as model hubs read it",
            metavar="FILE",
        ),
    ] = None,
    *,
    examined: Examined,
    shown: Shown,
    page: Page,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Show a play's tree, a scenario, a model's card, a skill or a recorded match.

    A recording becomes a page that opens in any browser and needs no network, beside the recording unless
    --out says otherwise.

    Keys of --json: of a play: play; nodes, each with path, type and depth; with --lint findings, each with
    path, rule and message, and wiring: entries of the store that are read and that nothing writes, or of
    another type; with --statistics scenario, seed, and robots: for each robot its nodes with path, ticks,
    transitions (of status), successes, failures, runs (ticks that left it running), own_time and time (with
    all below it), in seconds. Of anything else as in 'robobt list', with one entry.

    Exit code 1 when --lint finds wrong wiring, which no match would play.
    """
    import_files(imports)
    what = kind or _kind_of(name)
    _check(what, out, examined, shown, as_json=as_json)
    page.check(shown.live)
    make_folders({"--out": out})
    if what is ThingKind.RECORDING:
        show_recording(Path(name), out, shown, page)
    elif what is ThingKind.PLAY:
        show_play(name, out, examined, as_json=as_json)
    elif what is ThingKind.SCENARIO:
        from robobt.cli.shown.scenarios import show_scenario

        show_scenario(name, out, as_json=as_json)
    elif what is ThingKind.MODEL:
        from robobt.cli.shown.models import show_model

        show_model(name, out, as_json=as_json)
    else:
        from robobt.plays.private_files import private_files, split_play
        from robobt.tree.namespace import within

        with within(private_files(name)):
            list_registered(_PLURALS[what], split_play(name)[1], as_json=as_json)


def _check(
    what: ThingKind,
    out: Path | None,
    examined: Examined,
    shown: Shown,
    *,
    as_json: bool,
) -> None:
    """Refuse options that are for other kinds of things."""
    if what is not ThingKind.PLAY and (given := examined.given()):
        raise typer.BadParameter(f"is for a play, and this is a {what}", param_hint=given)
    if what is not ThingKind.RECORDING and (given := shown.given()):
        raise typer.BadParameter(f"is for a recording, and this is a {what}", param_hint=given)
    if what is ThingKind.RECORDING and as_json:
        raise typer.BadParameter("is not for recordings; see 'robobt record statistics'", param_hint="--json")
    formats = _FORMATS.get(what, ())
    if out is not None and out.suffix.lower() not in formats:
        ends = f"takes a name that ends in {', '.join(formats)}, not '{out}'"
        there = ends if formats else f"does nothing here: a {what} is only printed"
        raise typer.BadParameter(there, param_hint="--out")


def _kind_of(name: str) -> ThingKind:
    """Return what has this name.

    Raises:
        typer.BadParameter: nothing has it, or several things have.
    """
    # The parameters of a play in a file stand behind its name.
    file = name if ".py:" in name or Path(name).exists() else name.partition(":")[0]
    if (of_file := _kind_of_file(file)) is not None:
        return of_file
    from robobt.config.resources import bundled_scenarios
    from robobt.models.file import ModelError, UnknownModelError
    from robobt.models.find import find_model

    play = name.partition(":")[0]
    found = [ThingKind.PLAY] if play in registry_of("plays") else []
    found += [ThingKind.SCENARIO] if name in bundled_scenarios() else []
    found += [
        kind
        for kind, plural in _PLURALS.items()
        if kind is not ThingKind.TASK and name in registry_of(plural)
    ]
    found += [ThingKind.TASK] if _is_task(name) else []
    try:
        find_model(name)
        found.append(ThingKind.MODEL)
    except UnknownModelError:
        pass
    except ModelError:
        # The error is reported where the model is shown, unless the name is another thing's.
        found = found or [ThingKind.MODEL]
    if len(found) > 1:
        there = f"{name!r} is a {' and a '.join(found)}; choose with --kind"
        raise typer.BadParameter(there, param_hint="NAME")
    if not found:
        others = [kind.value for kind, plural in _PLURALS.items() if play in registry_of(plural)]
        there = f"{play!r} is a {others[0]}, which takes no parameters here" if others else _nothing(play)
        raise typer.BadParameter(there, param_hint="NAME")
    return found[0]


def _kind_of_file(name: str) -> ThingKind | None:
    """Return what a file holds, by the ending of its name; None for a name that is no file's."""
    lowered = name.lower()
    if lowered.endswith((RECORDING, *LOGS)):
        return ThingKind.RECORDING
    if lowered.endswith((".pt", ".onnx")):
        return ThingKind.MODEL
    if ".py:" in name:
        return _kind_in_python(name)
    if lowered.endswith((".xml", ".btproj", ".py")):
        return ThingKind.PLAY
    if lowered.endswith((".html", ".htm")):
        raise typer.BadParameter("is a page: open it in a browser", param_hint="NAME")
    if lowered.endswith((".yaml", ".yml")):
        from robobt.config.yaml import read_yaml

        return ThingKind.SCENARIO if "robots" in read_yaml(Path(name)) else ThingKind.PLAY
    return None


def _kind_in_python(name: str) -> ThingKind:
    """Return what a name in Python files is, as in ``my_team.py:striker``; a play if it is nothing else."""
    from robobt.plays.private_files import private_files, split_play
    from robobt.plays.sources import PythonFileError
    from robobt.tree.namespace import within

    try:
        owner, (_, inner) = private_files(name), split_play(name)
    except PythonFileError:
        # Whoever shows the play says what is wrong with the file.
        return ThingKind.PLAY
    with within(owner):
        kinds = [kind for kind in _PLURALS if kind is not ThingKind.TASK]
        found = [kind for kind in kinds if inner in registry_of(_PLURALS[kind])]
        return found[0] if found and inner not in registry_of("plays") else ThingKind.PLAY


def _is_task(name: str) -> bool:
    """Return whether a task has this name; where what tasks need is not installed, none has."""
    from robobt.config.extras import MissingExtraError

    try:
        return name in registry_of("tasks")
    except MissingExtraError:
        return False


def _nothing(name: str) -> str:
    """Say that nothing has this name, with the reason where a package failed, or with names close to it."""
    from robobt.config.errors import close_names
    from robobt.config.resources import bundled_scenarios
    from robobt.models.find import list_models, model_folders

    kinds = [kind for kind in REGISTERED if kind != "tasks"]
    for kind in kinds:
        if problem := registry_of(kind).problem_with(name):
            return problem
    if name in registry_of("challenges"):
        lists = "'robobt list challenges' says what it is"
        return f"{name!r} is a challenge; {lists}, 'robobt challenge {name}' plays it"
    models = [path.stem for folder in model_folders() for path in list_models(folder)]
    known = [*bundled_scenarios(), *models, *(one for kind in kinds for one in registry_of(kind))]
    meant = close_names(name, dict.fromkeys(known))
    guess = f"did you mean {' or '.join(meant)}? " if meant else ""
    return f"nothing is called {name!r}; {guess}'robobt list plays' and so on list what there is"
