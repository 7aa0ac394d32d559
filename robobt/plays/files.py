"""Plays in files, which name skills, plays and raters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path

from robobt.config.errors import short_repr
from robobt.config.process import users_code
from robobt.models.file import SUFFIXES, ModelError
from robobt.models.find import find_model, rename_models
from robobt.plays.base import PLAYS, Play
from robobt.plays.baselines.go_round import GoRound
from robobt.plays.mistakes import PlayError, check_returned, mistake_in_play
from robobt.plays.private_files import join_play, private_files, split_play
from robobt.plays.sources import PythonFileError
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS, Rater
from robobt.skills.defence.avoid_crash import AvoidCrash
from robobt.skills.defence.stay_out import StayOut
from robobt.skills.restarts.referee_switch import RefereeSwitch
from robobt.skills.store import Store
from robobt.skills.tactics.task_switch import TaskSwitch
from robobt.tree import Behaviour
from robobt.tree.interop import (
    FILE_ENDINGS,
    FilePlay,
    Vocabulary,
    describe_tree,
    load_tree_file,
    tree_files,
    write_yaml,
)
from robobt.tree.interop.model import Text, Value
from robobt.tree.namespace import Namespace, within
from robobt.tree.parameters import check_parameters


def _place_models(value: Value, folder: Path) -> Value:
    """Return a value with model paths relative to the working folder, not to the tree file's folder."""
    if isinstance(value, Text):
        return Text(str(_place_models(value.text, folder)))
    return rename_models(value, lambda file: str(folder / file))


VOCABULARY = Vocabulary(
    SKILLS,
    PLAYS,
    (RefereeSwitch, StayOut, AvoidCrash, GoRound, TaskSwitch),
    {RATERS.kind: Rater},
    Store,
    _place_models,
)
"""The names that play files may use."""


def load_play(path: str | Path) -> FilePlay:
    """Load a play from a file, callable like those in :data:`~robobt.plays.base.PLAYS`.

    Args:
        path: a file that ends in .yaml, .yml, .xml or .btproj.

    Raises:
        TreeFileError: one line that names the file, the line and what is wrong.
    """
    return FilePlay(load_tree_file(path, VOCABULARY), VOCABULARY)


def is_play_file(name: str) -> bool:
    """Return whether a play's name is a tree file's (.yaml, .yml, .xml, .btproj)."""
    return name.endswith(FILE_ENDINGS)


def problem_with_play(name: str) -> str | None:
    """Return why no play has this name; None if one has, or if it is a tree file."""
    files, inner = split_play(name)
    where = f" in {', '.join(files)}" if files else ""
    if not files and name.endswith(".py"):
        files, inner = (name,), "NAME"
    try:
        owner = private_files(join_play(files, inner))
    except PythonFileError as error:
        return str(error)
    if owner is not None and not where:
        its = [f"{name}:{play}" for play in owner.of(PLAYS)]
        return f"{name} is a Python file; name a play of it: {', '.join(its) or 'it registers none'}"
    with within(owner):
        if is_play_file(inner) or inner in PLAYS:
            return None
        if _is_model(inner):
            return (
                f"{short_repr(inner)} is a model, not a play; name a play that takes it as a parameter, as "
                f"'attack_learned:policy={inner}' ('robobt show {inner}' names its skill)"
            )
        return PLAYS.problem_with(inner) or (
            f"no play is called {short_repr(inner)}{where}; {PLAYS.meant(inner)}; "
            "those of your own files come with --import FILE or as FILE.py:NAME"
        )


def _is_model(name: str) -> bool:
    try:
        file = find_model(name)
    except ModelError:
        return False
    return file.suffix in SUFFIXES.values() and file.is_file()


def find_play(name: str) -> Play:
    """Return a play by its name, or a tree file's play if the name ends in .yaml, .yml, .xml or .btproj.

    A tree file is read again only when it has changed. A play of a Python file, ``my_team.py:striker``, has
    to be built within its :func:`~robobt.plays.private_files.private_files`.

    Args:
        name: name of a play, or of a file.

    Raises:
        KeyError: no play has that name.
        TreeFileError: the file does not hold a play.
        PythonFileError: the Python file cannot be run.
    """
    owner, (_, inner) = private_files(name), split_play(name)
    with within(owner):
        if not is_play_file(inner):
            return PLAYS[inner]
        path = Path(inner)
        try:
            stats = [file.stat() for file in tree_files(path)]
        except (OSError, ValueError):
            return load_play(path)
        return _load_once(path, tuple([(stat.st_mtime_ns, stat.st_size) for stat in stats]), owner)


def build_play(name: str, params: Mapping[str, object]) -> Behaviour:
    """Build a new tree of a play.

    Args:
        name: as for :func:`find_play`.
        params: the play's parameters as plain data.

    Raises:
        KeyError: no play has that name.
        ParameterError: a parameter is unknown, missing or of another type.
        PlayError: the play does not return a tree, or ends the process.
        Exception: whatever the play raises.
    """
    with within(private_files(name)):
        builder = find_play(name)
        given = check_parameters(name, builder, params)
        try:
            with users_code(name):
                tree = builder(**given)
        except SystemExit as error:
            # Otherwise nothing would report why the process ended.
            raise PlayError(mistake_in_play(error)) from error
    check_returned(name, builder, tree)
    return tree


@lru_cache(maxsize=64)
def _load_once(path: Path, _state: tuple[tuple[int, int], ...], _owner: Namespace | None) -> Play:
    return load_play(path)


def contents_of(name: str) -> list[bytes]:
    """Return the content of the files in a play's name, which decides what it plays; empty without files."""
    owner, (_, inner) = private_files(name), split_play(name)
    tree = [file.read_bytes() for file in tree_files(inner)] if is_play_file(inner) else []
    return [*tree, *([] if owner is None else [owner.sources.digest().encode()])]


def rename_play(name: str, rename: Callable[[str], str]) -> str:
    """Return a play's name with its files renamed."""
    files, inner = split_play(name)
    return join_play([rename(file) for file in files], rename(inner) if is_play_file(inner) else inner)


def tree_yaml(root: Behaviour, name: str) -> str:
    """Return the tree with this ``root`` as the YAML of a play with this ``name``.

    Raises:
        ValueError: a node is not registered, or has a parameter that is not plain data.
    """
    return write_yaml(describe_tree(root, VOCABULARY, name))


def tree_xml(root: Behaviour, name: str) -> str:
    """Return the tree with this ``root`` and ``name`` as BehaviorTree.CPP 4's XML, all skills in its palette.

    Raises:
        ValueError: as for :func:`tree_yaml`, or XML cannot express the tree.
    """
    from robobt.tree.interop import write_xml

    return write_xml(describe_tree(root, VOCABULARY, name), VOCABULARY)
