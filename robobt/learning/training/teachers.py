"""Teachers for demonstrations: the hand-written skills, and minimal scripts.

A teacher decides the actions of one task's arenas. The scripts see a learned policy's observation; the skills
see the field, as in a match.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np

from robobt.config.errors import RobobtError
from robobt.learning.envs import ArenaTask
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.learning.opponents.play_settings import PlaySettings
from robobt.learning.opponents.plays import PlayedRobots
from robobt.models.actions import ActionScaling
from robobt.models.policy import load_policy
from robobt.plays import PLAYS
from robobt.sim.records import COMMAND, size
from robobt.skills.store import Store
from robobt.tree.runner import TreeRunner
from robobt.world.command import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.state import BallState, Frame, RobotState
from robobt.world.team_view import places_of, team_view_rows


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


class TeamTeacher(Protocol):
    """Decides for all learners of a task's arenas."""

    def begin(self, which: IntArray) -> None:
        """Start new episodes in these arenas."""

    def act(self) -> FloatArray:
        """Return the actions in the arenas as they are now, (n, learners * action), in [-1, 1]."""


class PlayTeacher:
    """A play in every learner; the learners of a team share its plan.

    What an action cannot express is left out: every kick has the same speed and stays on the ground.
    """

    def __init__(self, task: SoccerTask, play: PlaySettings) -> None:
        self._task = task
        limits = [task.settings.simulator.limits] * task.robots
        for index in task.learners:
            limits[index] = within(task.settings.robot_limits, task.action)
        plays = dict.fromkeys(task.learners, play)
        self._played = PlayedRobots(plays, task.blue, limits, task.n, task.game)

    def begin(self, which: IntArray) -> None:
        """See :class:`TeamTeacher`."""
        self._played.restart(self._task.arenas, which)

    def act(self) -> FloatArray:
        """See :class:`TeamTeacher`."""
        task = self._task
        commands = np.zeros((task.n, task.robots, size(COMMAND)))
        self._played.decide(task.arenas, commands, task.settings.decide_every)
        return actions_of(commands[:, list(task.learners)], task.action).reshape(task.n, -1)


class ModelTeacher:
    """A trained policy in every learner; it may observe fewer robots than there are."""

    def __init__(self, task: SoccerTask, model: str) -> None:
        self._task, self._policy = task, load_policy(model, kind="policy")
        card = self._policy.card
        places = places_of(card.observation.name)
        if places is None or places.told or card.action != task.action:
            raise TeacherError(
                f"{model}: observes {card.observation.name}, or acts otherwise than {task.observation.name}"
            )
        self._places = places

    def begin(self, which: IntArray) -> None:
        """Do nothing: a policy has no memory."""

    def act(self) -> FloatArray:
        """See :class:`TeamTeacher`."""
        task, places = self._task, self._places
        arenas, field = task.arenas, task.settings.field
        who = np.array(task.learners, dtype=np.int64)
        goal = field.half_length, field.goal_width / 2
        rows = team_view_rows(
            arenas.robots, arenas.balls, who, task.blue, places.mates, places.opponents, *goal, 0
        )
        actions: FloatArray = self._policy(rows.reshape(task.n * len(who), -1))
        return np.clip(actions, -1.0, 1.0).reshape(task.n, -1)


def teacher_of(task: ArenaTask, name: str, params: Mapping[str, Any]) -> TeamTeacher:
    """Return a teacher for the learners of a task: the play of that name, else the model.

    Args:
        task: the arenas.
        name: a play, or a model by name or file.
        params: parameters of the play.

    Raises:
        TeacherError: the task is not one of several robots, or the model does something else.
        ModelError: there is no such model, or it cannot be used.
    """
    if not isinstance(task, SoccerTask):
        raise TeacherError(f"imitation is for tasks of several robots, not {task.observation.name}")
    if name in PLAYS:
        return PlayTeacher(task, PlaySettings(play=name, params=dict(params)))
    return ModelTeacher(task, name)


def actions_of(commands: FloatArray, scaling: ActionScaling) -> FloatArray:
    """Return the actions of driving and kicking that are closest to commands.

    Args:
        commands: (..., command), rows of :class:`robobt.sim.records.Command`.
        scaling: of the actions.

    Returns:
        (..., 4) velocity, turning rate and kick, in [-1, 1].
    """
    velocity = commands[..., :2] / scaling.max_speed
    length = np.hypot(velocity[..., :1], velocity[..., 1:])
    turn = np.clip(commands[..., 2:3] / scaling.max_turn, -1.0, 1.0)
    kick = np.where(commands[..., 3:4] > 0.0, 1.0, -1.0)
    return np.concatenate((velocity / np.maximum(length, 1.0), turn, kick), axis=-1)
