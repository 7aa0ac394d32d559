"""Tasks by their names, and the arenas that belong to a task's settings."""

from __future__ import annotations

import sys
from pathlib import Path

from robobt.learning.envs.arena_task import ArenaTask, task_of
from robobt.learning.envs.per_robot import PerRobot
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.tasks import TASKS, environment_id
from robobt.plays.python_files import REGISTRIES, import_file
from robobt.plays.sources import read_sources

REGISTRIES.append(TASKS)

_digests: dict[str, str] = {}
"""Hashes of the code of users' tasks, by module, taken at first use."""


def find_task(name: str) -> type[ArenaTask]:
    """Return a task by its registered name or by its Gymnasium id.

    Args:
        name: name of the task; ``my_task.py:MyTask`` for a task in a Python file, by its class or its name.

    Raises:
        KeyError: there is no such task; the message lists the known names.
        PythonFileError: the file cannot be read, or raises as it runs.
    """
    file, _, inner = name.rpartition(":")
    if file.endswith(".py") or name.endswith(".py"):
        return _task_in(file or name, inner if file else "")
    if file and Path(f"{file}.py").is_file():
        raise KeyError(f"no task is called {name!r}; write {file}.py:{inner}")
    ids = {environment_id(known): known for known in TASKS}
    found: type[ArenaTask] = TASKS[ids.get(name, name)]
    return found


def _task_in(file: str, name: str) -> type[ArenaTask]:
    module = import_file(file)
    found: dict[str, type[ArenaTask]] = {}
    for task in vars(module).values():
        if isinstance(task, type) and issubclass(task, ArenaTask) and task.__module__ == module.__name__:
            found[task.__name__] = task
            if "name" in vars(task):
                found[task.name] = task
    if name not in found:
        there = ", ".join([f"{file}:{each}" for each in found]) or "no subclass of ArenaTask"
        problem = f"has no task {name!r}" if name else "does not say which task"
        raise KeyError(f"{file}: {problem}; there is {there}")
    return found[name]


def task_file(settings: TaskSettings) -> tuple[str, str]:
    """Return the file of a user's task, and a hash of it and of what it imports from its folder.

    Both are empty for a shipped task, and for a task without a file.
    """
    module = _task(settings).__module__
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None or module.partition(".")[0] == "robobt":
        return "", ""
    # Read once, because edits during a run do not change the code that this process runs.
    if module not in _digests:
        _digests[module] = read_sources([file]).digest()
    return file, _digests[module]


def make_task(settings: TaskSettings, n: int) -> ArenaTask:
    """Return ``n`` arenas of the task with these ``settings``."""
    return _task(settings)(settings, n)


def make_rows(settings: TaskSettings, n: int, central: bool = False) -> ArenaTask | PerRobot:
    """Return arenas of the task with these ``settings`` and ``n`` learners in total, one row per learner.

    With ``central`` each row ends with the additional input of a central critic.

    Raises:
        ValueError: ``n`` does not fill whole arenas.
    """
    each = learners_of(settings)
    if n % each:
        raise ValueError(f"{n} learners are not those of whole arenas, with {each} each")
    task = make_task(settings, n // each)
    return PerRobot(task, central) if central or each > 1 else task


def learners_of(settings: TaskSettings) -> int:
    """Return how many robots learn in an arena with these ``settings``."""
    return len(settings.learners)


def _task(settings: TaskSettings) -> type[ArenaTask]:
    task = task_of(type(settings))
    if task is None:
        # Settings can be created without importing their task's module.
        [TASKS[name] for name in TASKS]
        task = task_of(type(settings))
    if task is None:
        raise TypeError(f"{type(settings).__name__} are the settings of no task")
    return task
