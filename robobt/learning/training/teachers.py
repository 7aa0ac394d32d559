"""Teachers for demonstrations: the hand-written skills, and minimal scripts.

A teacher decides the actions of one task's arenas. The scripts see a learned policy's observation; the skills
see the field, as in a match.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from robobt.config.errors import RobobtError
from robobt.learning.envs import ArenaTask
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.models.actions import ActionScaling
from robobt.skills.store import Store
from robobt.tree.runner import TreeRunner
from robobt.world.command import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.state import BallState, Frame, RobotState


class TeacherError(RobobtError, ValueError):
    """A task has no teacher."""


class Teacher(Protocol):
    """Decides the actions of every arena of a task."""

    def begin(self, which: IntArray) -> None:
        """Start new episodes in these arenas."""

    def act(self, observation: FloatArray) -> FloatArray:
        """Map (n, observation) to (n, action) in [-1, 1]."""


class _Script:
    """A script in every arena; it has no memory."""

    def __init__(self, act: Callable[[FloatArray], FloatArray]) -> None:
        self.act = act

    def begin(self, which: IntArray) -> None:
        """Do nothing."""


class SkillTeacher:
    """A hand-written skill in every arena, ticked on the true state of the field."""

    def __init__(self, task: ArenaTask) -> None:
        self._task = task
        # The tasks have no defence areas, and a skill would keep out of the opponents' area.
        self._field = task.settings.field.model_copy(update={"defense_depth": 0.0, "defense_width": 0.0})
        self._limits = within(task.settings.robot_limits, task.action)
        self._runners: dict[int, tuple[TreeRunner, Store]] = {}
        self._ticks = np.zeros(task.n, dtype=np.int64)

    def begin(self, which: IntArray) -> None:
        """Make a new skill for each of these arenas."""
        for arena in which.tolist():
            self._ticks[arena] = 0
            frame = self._frame(arena)
            if arena in self._runners:
                self._runners[arena][0].shutdown()
            store = Store(frame, frame.own[0])
            made = self._task.skill()
            assert made is not None
            self._runners[arena] = (TreeRunner(made, store, on_error="raise"), store)

    def act(self, observation: FloatArray) -> FloatArray:
        """See :class:`Teacher`."""
        actions = np.zeros((len(observation), self._task.action_size))
        for arena, (runner, store) in self._runners.items():
            store.frame = self._frame(arena)
            store.me = store.frame.own[0]
            store.command = RobotCommand()
            runner.tick()
            actions[arena] = action_of(store.command, self._task.action)
        self._ticks += self._task.settings.decide_every
        return actions

    def _frame(self, arena: int) -> Frame:
        arenas, settings = self._task.arenas, self._task.settings
        robot, ball = arenas.robots[arena, 0].tolist(), arenas.balls[arena].tolist()
        contact = bool(arenas.contact[arena, 0])
        x, y, heading, vx, vy, omega = robot
        me = RobotState(0, x, y, heading, vx, vy, omega, contact, self._limits)
        others = tuple(
            RobotState(number, *state) for number, state in enumerate(arenas.robots[arena, 1:].tolist())
        )
        time = float(self._ticks[arena]) * settings.period
        return Frame(time, self._field, BallState(*ball), (me,), others, period=settings.period)


def playing(task: ArenaTask, teacher: Teacher) -> Callable[[FloatArray], FloatArray]:
    """Return the teacher as a policy of a task that has just been reset, for evaluations."""
    ticks = np.full(task.n, np.inf)

    def decide(observation: FloatArray) -> FloatArray:
        # An episode no older than the last one seen is a new episode.
        begun = np.flatnonzero(task.ticks <= ticks)
        teacher.begin(begun)
        ticks[:] = task.ticks
        return teacher.act(observation)

    return decide


def script(task: ArenaTask) -> Teacher:
    """Return the script that does this task.

    Raises:
        TeacherError: there is none.
    """
    found = task.script()
    if found is None:
        raise _nobody(task)
    forgetful = found
    # A script knows nothing of the memory, which tasks with one learner may have.
    seen = len(task.learners) * task.seen_size
    return _Script(lambda observation: forgetful(observation[:, :seen]))


def skill(task: ArenaTask) -> Teacher:
    """Return the skill that does this task.

    Raises:
        TeacherError: there is none.
    """
    if task.skill() is None:
        raise _nobody(task)
    return SkillTeacher(task)


def _nobody(task: ArenaTask) -> TeacherError:
    return TeacherError(f"nobody demonstrates {task.observation.name}: it has no script and no skill")


TEACHERS: dict[str, Callable[[ArenaTask], Teacher]] = {"skill": skill, "script": script}
"""Teachers by name."""


def action_of(command: RobotCommand, scaling: ActionScaling) -> FloatArray:
    """Return the action in [-1, 1] closest to a command, without parts that it cannot express."""
    if scaling.kind == "drive":
        forward, left = command.vx / scaling.max_speed, command.vy / scaling.max_speed
        norm = max(1.0, float(np.hypot(forward, left)))
        raw = [forward / norm, left / norm, command.omega / scaling.max_turn]
    else:
        raw = [command.omega / scaling.max_turn, 1.0 if command.kick_speed > 0.0 else -1.0]
    action: FloatArray = np.clip(np.array(raw), -1.0, 1.0)
    return action


def within(limits: RobotLimits, action: ActionScaling) -> RobotLimits:
    """Return the robot's limits less what actions cannot ask for."""
    fastest = min(limits.max_speed, action.max_speed) if action.kind == "drive" else limits.max_speed
    return limits.model_copy(update={"max_speed": fastest, "max_turn": min(limits.max_turn, action.max_turn)})
