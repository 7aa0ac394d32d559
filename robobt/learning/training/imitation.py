"""Imitation of a teacher, who acts in some arenas and corrects the learner in the others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from robobt.learning.envs import ArenaTask, VectorTask
from robobt.learning.envs.per_robot import PerRobot, SeveralWorlds
from robobt.learning.envs.task import BoolArray, FloatArray, StepResult
from robobt.learning.training.setting_groups import ImitationSettings
from robobt.learning.training.teachers import TeacherError, TeamTeacher, teacher_of


class Lesson:
    """A teacher in every arena.

    Args:
        task: the arenas, a row for each learner.
        settings: the teachers, and for how many steps they teach.

    Raises:
        TeacherError: nobody can teach this task, or there is not one for each world.
    """

    def __init__(self, task: VectorTask, settings: ImitationSettings) -> None:
        self._steps = settings.steps
        parts = task.parts if isinstance(task, SeveralWorlds) else (task,)
        names = settings.teachers * len(parts) if len(settings.teachers) == 1 else settings.teachers
        if len(names) != len(parts):
            raise TeacherError(f"imitation: {len(names)} teachers for {len(parts)} worlds")
        self._parts = [_Part(*each, settings.params) for each in zip(parts, names, strict=True)]
        self._acts = np.zeros(task.n, dtype=np.bool_)

    def share_out(self, steps: int, rng: np.random.Generator) -> None:
        """Choose the arenas in which the teacher acts, from all in the beginning to none in the end.

        ``steps`` have been taken so far.
        """
        share = 1.0 - steps / self._steps if steps < self._steps else 0.0
        drawn = [np.repeat(rng.random(part.task.n) < share, part.each) for part in self._parts]
        self._acts = np.concatenate(drawn)

    def next(self, action: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what the teacher would do, and what is done, both (n, action).

        ``action`` is the learner's choice, (n, action).
        """
        shown = np.concatenate([part.teacher.act().reshape(-1, action.shape[1]) for part in self._parts])
        return shown, np.where(self._acts[:, None], shown, action)

    def begin(self, step: StepResult) -> None:
        """Tell the teacher which episodes have ended with a step, so that others have begun."""
        first, ended = 0, step.terminated | step.truncated
        for part in self._parts:
            rows: BoolArray = ended[first : first + part.task.n * part.each]
            part.teacher.begin(np.flatnonzero(rows[:: part.each]))
            first += len(rows)


class _Part:
    """Arenas of one world: the task, how many learners an arena has, and the teacher."""

    def __init__(self, part: VectorTask, teacher: str, params: Mapping[str, Any]) -> None:
        task = part.task if isinstance(part, PerRobot) else part
        if not isinstance(task, ArenaTask):
            raise TeacherError("imitation: nobody teaches against a pool of past selves")
        self.task, self.each = task, len(task.learners)
        self.teacher: TeamTeacher = teacher_of(task, teacher, params)
        self.teacher.begin(np.arange(task.n))
