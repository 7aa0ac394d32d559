"""``robobt list``: what there is, by its kind."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import Imports, Json, import_files
from robobt.cli.options import option


class ListedKind(StrEnum):
    """What can be listed."""

    PLAYS = "plays"
    SKILLS = "skills"
    RATERS = "raters"
    POLICIES = "policies"
    MODELS = "models"
    SCENARIOS = "scenarios"
    TASKS = "tasks"
    CHALLENGES = "challenges"


def list_(
    kind: Annotated[ListedKind, typer.Argument(help="What to list.")],
    path: Annotated[list[Path] | None, option("--path", "; for models")] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List plays, skills, raters, policies, models, scenarios, tasks or challenges.

    Skills and conditions are listed with what they read and write in the robot's store. Raters judge shots
    for SelectShot and others; policies drive GoToBall. A file names a rater or policy alone, or with its
    settings, as in rater: {name: expected_goal, threshold: 0.8}. 'robobt show NAME' shows one thing with
    all of it.

    Keys of --json: the kind, a list. Of plays, skills, raters, policies, tasks and challenges each has name,
    description, parameters (name, type, required, default), package (the distribution it came with, null for
    robobt's own and imported files') and, for skills, reads, writes and condition (whether it is one). Of
    models: file, format, size (bytes), sha256, listed (whether the manifest beside it lists it) and card. Of
    scenarios: name, description, file, field (length and width in metres), period and time_limit (seconds),
    trials, referee (whether there is one), ball (where it starts) and robots (robot, play, params, start: in
    the own team's view, own goal at -x). problems: what is wrong with models or other packages' entries.
    """
    import_files(imports)
    if path and kind is not ListedKind.MODELS:
        raise typer.BadParameter("is for models", param_hint="--path")
    if kind is ListedKind.MODELS:
        from robobt.cli.shown.models import list_models

        list_models(path or (), as_json=as_json)
    elif kind is ListedKind.SCENARIOS:
        from robobt.cli.shown.scenarios import list_scenarios

        list_scenarios(as_json=as_json)
    else:
        from robobt.cli.shown.lists import list_registered

        list_registered(kind.value, None, as_json=as_json)
