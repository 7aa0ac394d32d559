"""The tasks by name: shipped ones, and those that other packages and files register."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from importlib.resources import files
from typing import Any, TypeVar

import gymnasium

from robobt.tree.registry import Registry

_C = TypeVar("_C", bound=type[Any])

_ENVS = "robobt.learning.envs"
_SHIPPED_TASKS = {
    "go_to_ball": "go_to_ball.task:GoToBallTask",
    "shoot": "shoot.task:ShootTask",
    "score_on_goalkeeper": "score_on_goalkeeper.task:ScoreOnGoalkeeperTask",
    "go_to_ball_among_robots": "go_to_ball.among_robots:GoToBallAmongRobotsTask",
    "soccer": "soccer.task:SoccerTask",
    "score_on_goalkeeper_and_defenders": "soccer.suite:ScoreOnGoalkeeperAndDefenders",
    "score_on_goalkeeper_and_two_defenders": "soccer.suite:ScoreOnGoalkeeperAndTwoDefenders",
    "save": "soccer.suite:Save",
    "duel": "soccer.suite:Duel",
    "duel_with_script": "soccer.suite:DuelWithScript",
    "keepaway": "soccer.suite:Keepaway",
    "pass": "soccer.suite:Pass",
    "receive": "soccer.suite:Receive",
    "redirect": "soccer.suite:Redirect",
    "attack3v2": "soccer.suite:Attack3v2",
    "small3v3": "soccer.suite:Small3v3",
    "obstacle_course": "obstacle_course.task:ObstacleCourseTask",
    "dribbling": "dribbling.task:DribblingTask",
    "passing": "passing.task:PassingTask",
    "ball_placement": "ball_placement.task:BallPlacementTask",
    "cooperation": "cooperation.task:CooperationTask",
}
"""Modules of the shipped tasks; each is imported at first use."""

_IDS = {"shoot": "ShootTowardsGoal"}
"""Tasks that Gymnasium knows by another name."""


def environment_id(name: str) -> str:
    """Return a task's Gymnasium id without version: ``GoToBall`` for ``go_to_ball``."""
    return _IDS.get(name) or "".join([part[:1].upper() + part[1:] for part in name.split("_")])


class Tasks(Registry[type[Any]]):
    """The registry of tasks, subclasses of :class:`~robobt.learning.envs.ArenaTask`.

    Each has an id for ``gymnasium.make`` and ``gymnasium.make_vec``, see :func:`environment_id`, with the
    version ``-v0``.
    """

    def __init__(self) -> None:
        super().__init__("task", "robobt.tasks", lambda entry: isinstance(entry, type))
        for name in _SHIPPED_TASKS:
            _tell_gymnasium(name, namespace="robobt/")
            _tell_gymnasium(name)

    def register(self, name: str = "") -> Callable[[_C], _C]:
        """Return a decorator that registers a task under ``name``, and with Gymnasium.

        If a file runs again, for example as an imported module, its class replaces the first one.

        Raises:
            TypeError: there is no name.
            ValueError: the name is taken.
        """
        enter = super().register(name)

        def enter_task(task: _C) -> _C:
            if name in _SHIPPED_TASKS:
                raise ValueError(f"task {name!r} is one of robobt's; give yours another name")
            if self._is_again(name, task):
                self._entries[name] = task
            else:
                enter(task)
            task.name = name
            _tell_gymnasium(name)
            return task

        return enter_task

    def __getitem__(self, name: str) -> type[Any]:
        """Return the task; see :meth:`Registry.__getitem__`."""
        return self._shipped(name) if name in _SHIPPED_TASKS else super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        return name in _SHIPPED_TASKS or super().__contains__(name)

    def __iter__(self) -> Iterator[str]:
        return iter((*_SHIPPED_TASKS, *super().__iter__()))

    def __len__(self) -> int:
        return len(_SHIPPED_TASKS) + super().__len__()

    def documentation(self, name: str) -> str:
        """Return a task's docstring.

        That of a shipped task is read from its file: to import all tasks takes longer than the rest of a
        command that lists them.

        Raises:
            KeyError: no such task.
        """
        if name not in _SHIPPED_TASKS:
            return inspect.getdoc(self[name]) or ""
        module, _, inner = _SHIPPED_TASKS[name].partition(":")
        docstrings = _docstrings(module)
        # A task of the suite is made from its settings, and has their docstring.
        return docstrings.get(inner) or docstrings[f"{inner}Settings"]

    def _shipped(self, name: str) -> type[Any]:
        module, _, inner = _SHIPPED_TASKS[name].partition(":")
        task: type[Any] = getattr(import_module(f"{_ENVS}.{module}"), inner)
        task.name = name
        return task

    def _is_again(self, name: str, task: type[Any]) -> bool:
        before = self._entries.get(name)
        if before is None:
            return False
        files = [getattr(sys.modules.get(one.__module__), "__file__", None) for one in (before, task)]
        return files[0] is not None and files[0] == files[1] and before.__qualname__ == task.__qualname__


@cache
def _docstrings(module: str) -> dict[str, str]:
    """Return the docstrings of the classes in a module below :data:`_ENVS`, without importing it."""
    *folders, file = module.split(".")
    source = files("robobt.learning").joinpath("envs", *folders, f"{file}.py").read_text(encoding="utf-8")
    classes = [node for node in ast.parse(source).body if isinstance(node, ast.ClassDef)]
    return {node.name: ast.get_docstring(node) or "" for node in classes}


def _tell_gymnasium(name: str, namespace: str = "") -> None:
    id_ = f"{namespace}{environment_id(name)}-v0"
    # A second registration of one id must not warn; environments end their episodes themselves.
    gymnasium.registry.pop(id_, None)
    gymnasium.register(
        id=id_,
        entry_point=f"{_ENVS}.gymnasium_base:TaskEnv",
        vector_entry_point=f"{_ENVS}.gymnasium_base:TaskVectorEnv",
        kwargs={"task": name},
    )


TASKS = Tasks()
"""The tasks by name."""
