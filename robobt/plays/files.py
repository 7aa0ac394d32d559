"""Plays in files: every skill, play and rater by its name."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from robobt.plays.base import PLAYS, Play
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS, ShotRater
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
    write_xml,
    write_yaml,
)

VOCABULARY = Vocabulary(
    SKILLS, PLAYS, (RefereeSwitch, StayOut, AvoidCrash, TaskSwitch), {ShotRater: RATERS}, Store
)
"""What the files of plays may name."""


def load_play(path: str | Path) -> FilePlay:
    """Load a play from a file (.yaml, .xml), to be called like those of :data:`~robobt.plays.base.PLAYS`.

    Raises:
        TreeFileError: one line that names the file, the line and what is wrong.
    """
    return FilePlay(load_tree_file(path, VOCABULARY), VOCABULARY)


def is_play_file(name: str) -> bool:
    """Return whether a play's name is a file's (.yaml, .yml, .xml)."""
    return name.endswith(FILE_ENDINGS)


def find_play(name: str, folder: str | Path = ".") -> Play:
    """Return a play by its name, or a file's play where the name ends in .yaml, .yml or .xml.

    A file is read again only when it has changed.

    Args:
        name: of a play, or of a file.
        folder: what the paths of files are relative to.

    Raises:
        KeyError: no play has that name.
        TreeFileError: the file does not hold a play.
    """
    if not is_play_file(name):
        return PLAYS[name]
    path = Path(folder) / name
    try:
        stat = path.stat()
    except (OSError, ValueError):
        return load_play(path)
    return _load_once(path, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=64)
def _load_once(path: Path, _changed: int, _size: int) -> Play:
    return load_play(path)


def tree_yaml(root: Behaviour, name: str) -> str:
    """Write a tree as the YAML of a play.

    Raises:
        ValueError: a node is not registered, or has a parameter that is not plain data.
    """
    return write_yaml(describe_tree(root, VOCABULARY, name))


def tree_xml(root: Behaviour, name: str) -> str:
    """Write a tree as the XML of BehaviorTree.CPP 4, with all skills in Groot2's palette.

    Raises:
        ValueError: as :func:`tree_yaml`, or XML cannot express it.
    """
    return write_xml(describe_tree(root, VOCABULARY, name), VOCABULARY)
