"""Teachers of robots in a team: any play, ticked as in a match, and trained models.

Both see the true state of the arenas.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from robobt.learning.envs import ArenaTask
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.learning.opponents.play_settings import PlaySettings
from robobt.learning.opponents.plays import PlayedRobots
from robobt.learning.training.teachers import TeacherError, within
from robobt.models.actions import ActionScaling
from robobt.models.policy import load_policy
from robobt.plays import PLAYS
from robobt.sim.records import COMMAND, size
from robobt.world.team_view import places_of, team_view_rows


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
