"""Matches of policies, scripts and plays in tasks in which both teams learn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from robobt.config.errors import RobobtError
from robobt.config.validation import first_problem
from robobt.learning.agents.networks import Actor, policy_of
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import Opponent, against, instead
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.play_settings import PlaySettings
from robobt.learning.training.run_folder import ACTOR, PAST, SETTINGS, load_actor, read_settings
from robobt.learning.training.setting_groups import Script

_ENCOUNTER_ARENAS = 128
"""Arenas side by side in an encounter."""


class MeetingError(RobobtError, ValueError):
    """Contenders that cannot meet; the message is one line."""


@dataclass(frozen=True)
class Contender:
    """A policy, scripted robots of a role, or a play's robots, in place of a team's learners."""

    name: str
    plays: Actor | Opponent


@dataclass(frozen=True)
class PolicyEncounter:
    """Two contenders from ``starts`` starts, each played on both sides; ``won`` are goals of the first."""

    first: str
    second: str
    starts: int
    won: int
    drawn: int
    lost: int

    @property
    def scores(self) -> list[float]:
        """The first one's score in each episode: 1 for its goal, 0 for one against it, 0.5 without."""
        return [1.0] * self.won + [0.5] * self.drawn + [0.0] * self.lost


def script(role: str) -> Contender:
    """Return scripted field players as a contender.

    Raises:
        MeetingError: there are none of that role.
    """
    for known in get_args(Script):
        if known == role:
            return Contender(role, known)
    raise MeetingError(f"there is no script {role!r}; there are {', '.join(get_args(Script))}")


def play(text: str, name: str, params: Mapping[str, object]) -> Contender:
    """Return a play's robots as a contender, called ``text``.

    Raises:
        MeetingError: there is no such play, or it has no such parameters.
    """
    try:
        return Contender(text, PlaySettings(play=name, params=dict(params)))
    except ValidationError as error:
        told = [part for part in first_problem(error, PlaySettings) if part]
        raise MeetingError(f"{text}: {': '.join(told)}") from error


def contenders_of(folder: Path, past: int, name: str = "") -> tuple[SoccerSettings, list[Contender]]:
    """Return the environment of a run and its policies: up to ``past`` of its past selves, and the best.

    Past selves are spread evenly over the run, with the first and the newest; the best is there once the run
    has ended.

    Raises:
        RunFolderError: the settings cannot be read, or a policy is damaged.
        MeetingError: it is no run of two teams that learn, or has no policies yet; or no folder, but a model.
    """
    if not (folder / SETTINGS).exists():
        raise MeetingError(
            f"{folder}: is no folder of a training run; models do not take part in a round robin"
        )
    settings = read_settings(folder)
    environment = settings.environment
    if not isinstance(environment, SoccerSettings) or not environment.two_alike:
        raise MeetingError(f"{folder}: {settings.task} is not a task whose two teams learn")
    files = sorted((folder / PAST).glob("*.pt"))
    chosen = np.unique(np.linspace(0, len(files) - 1, min(past, len(files))).round().astype(int))
    before = f"{name} " if name else ""
    found = [
        Contender(f"{before}after {int(files[index].stem):,}", load_actor(files[index])) for index in chosen
    ]
    if (folder / ACTOR).exists():
        found.append(Contender(f"{before}best", load_actor(folder / ACTOR)))
    if not found:
        raise MeetingError(f"{folder}: has no policies yet")
    return environment, found


def encounters(
    settings: SoccerSettings, contenders: Sequence[Contender], starts: int, seed: int
) -> list[PolicyEncounter]:
    """Play every pair of contenders, from starts derived from ``seed`` and the pair. Return the results.

    Raises:
        MeetingError: a policy has another observation than the environment.
    """
    size = SoccerTask(settings, 1).observation.size
    for one in contenders:
        if isinstance(one.plays, Actor) and len(one.plays.build["scale"]) != size:
            seen = len(one.plays.build["scale"])
            raise MeetingError(f"{one.name}: sees {seen} entries, the robots of the first run {size}")
    found = []
    for number, (first, second) in enumerate(combinations(contenders, 2)):
        drawn = int(np.random.SeedSequence([seed, number]).generate_state(1)[0])
        home = _goals(settings, first, second, starts, drawn)
        away = -_goals(settings, second, first, starts, drawn)
        goals = np.concatenate((home, away))
        won, lost = int((goals > 0).sum()), int((goals < 0).sum())
        found.append(PolicyEncounter(first.name, second.name, starts, won, len(goals) - won - lost, lost))
    return found


def _goals(
    settings: SoccerSettings, blue: Contender, yellow: Contender, starts: int, seed: int
) -> NDArray[np.int64]:
    """Return 1 for each start from which blue scores, -1 if yellow scores, else 0."""
    made = settings
    if not isinstance(yellow.plays, Actor):
        made = against(made, yellow.plays)
    if not isinstance(blue.plays, Actor):
        made = instead(made, blue.plays)
    task = SoccerTask(made, min(_ENCOUNTER_ARENAS, starts))
    sides = [
        (np.flatnonzero(np.array(task.learners, dtype=np.int64) < task.blue), blue.plays),
        (np.flatnonzero(np.array(task.learners, dtype=np.int64) >= task.blue), yellow.plays),
    ]
    deciding = [(rows, policy_of(plays)) for rows, plays in sides if isinstance(plays, Actor)]

    def decide(observation: FloatArray) -> FloatArray:
        seen = observation.reshape(task.n, len(task.learners), task.observation.size)
        actions = np.zeros((task.n, len(task.learners), task.action.size))
        for rows, policy in deciding:
            actions[:, rows] = policy(seen[:, rows])
        return actions.reshape(task.n, -1)

    observation = task.reset_to(task.sample_starts(seed, starts), seed)
    goals, open_ = np.zeros(starts, dtype=np.int64), starts
    while open_ > 0:
        result = task.advance(decide(observation))
        if task.ended is not None:
            scored = task.goals[result.terminated | result.truncated]
            counts = task.ended.start >= 0
            goals[task.ended.start[counts]] = scored[counts]
            open_ -= int(counts.sum())
            task.renew(result)
        observation = result.observation
    return goals
