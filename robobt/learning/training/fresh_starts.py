"""Policies of a task, its script and its hand-written skill, judged on the same fresh starts."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

from robobt.config.errors import RobobtError
from robobt.learning.agents.networks import policy_of
from robobt.learning.envs import ArenaTask, TaskSettings, make_task, run_starts
from robobt.learning.envs.make import find_task
from robobt.learning.training.preset_files import merged
from robobt.learning.training.results import Evaluation, Policy
from robobt.learning.training.run_folder import RESULT, load_run
from robobt.learning.training.settings import evaluated_on
from robobt.learning.training.teachers import TEACHERS, TeacherError, playing
from robobt.models.file import UnknownModelError
from robobt.models.policy import load_policy

_ARENAS = 128
"""Arenas side by side."""


class JudgingError(RobobtError, ValueError):
    """A policy that cannot be judged; the message is one line."""


def trained_policy(source: str) -> tuple[TaskSettings, Policy]:
    """Return the environment and the policy of a training run's folder, or of a model by name or file.

    The environment is that of training. Where a policy plays against itself there, it is the one in which
    training judged it.

    Raises:
        RunFolderError: the folder holds no run that has ended.
        ModelError: the model cannot be used.
        JudgingError: there is neither run nor model, the model is no policy, or its card does not say which
            task it was trained for.
    """
    if Path(source).is_dir():
        result = load_run(best_seed(Path(source)))
        trained = result.settings.environment
        return (evaluated_on(result.settings) if trained.two_alike else trained), policy_of(result.actor)
    try:
        policy = load_policy(source, kind="policy")
    except UnknownModelError as error:
        raise JudgingError(f"{error}, or the folder of a training run") from error
    settings = policy.card.training.get("settings")
    task = settings.get("task") if isinstance(settings, dict) else None
    if not isinstance(settings, dict) or not isinstance(task, str):
        raise JudgingError(f"{source}: its card names no task; give the folder of its training run")
    try:
        model = find_task(task).Settings
        environment = model.model_validate(policy.card.environment)
        if environment.two_alike:
            data, judged = environment.model_dump(), settings.get("evaluation", {})
            for name in ("environment", "held_out_environment"):
                data = merged(data, judged.get(name, {}))
            environment = model.model_validate(data)
        return environment, policy
    except (KeyError, ValueError) as error:
        raise JudgingError(f"{source}: the environment on its card cannot be made: {error}") from error


def best_seed(folder: Path) -> Path:
    """Return the folder of the best seed where ``folder`` holds several, else ``folder`` itself."""
    try:
        seed = json.loads((folder / RESULT).read_text(encoding="utf-8"))["best_seed"]
    except (OSError, ValueError, KeyError, TypeError):
        return folder
    return folder / f"seed_{seed}"


def judge(
    environment: TaskSettings, policies: Mapping[str, Policy], starts: int, seed: int, teachers: bool = True
) -> dict[str, Evaluation]:
    """Play each policy once from each start, and the task's script and skill where it has them.

    Args:
        environment: where; its type tells the task.
        policies: by name; each maps observations (n, O) to actions (n, A).
        starts: how many, drawn from ``seed``.
        seed: of starts, noise and randomisation; training uses none below 2**62.
        teachers: whether the task's script and skill play too.

    Returns:
        Results by name: the policies', then those of "skill" and "script".

    Raises:
        JudgingError: a policy takes another observation than the task has, or is called as a teacher is.
    """
    if taken := [name for name in policies if name in TEACHERS]:
        raise JudgingError(f"{taken[0]}: this name is that of the task's own {taken[0]}; write ./{taken[0]}")
    players: dict[str, Callable[[ArenaTask], Policy]] = {}
    for name, policy in policies.items():
        players[name] = lambda task, policy=policy: task.jointly(policy)  # type: ignore[misc]
    for name, teacher in TEACHERS.items() if teachers else ():
        players[name] = lambda task, teacher=teacher: playing(task, teacher(task))  # type: ignore[misc]
    found = {}
    for name, player in players.items():
        task = make_task(environment, min(_ARENAS, starts))
        rows = task.sample_starts(seed, starts)
        try:
            episodes = run_starts(task, player(task), rows, seed)
        except TeacherError:
            continue
        except (ValueError, RuntimeError) as error:
            raise JudgingError(f"{name}: cannot play {task.name}: {error}") from error
        times = getattr(episodes, task.timed)
        found[name] = Evaluation(episodes.success, times, episodes.optimum, episodes.total_reward)
    return found
