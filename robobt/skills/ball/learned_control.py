"""Compute one robot's command from a frame with a trained policy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from math import inf, isnan
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np

from robobt.config.errors import RobobtError
from robobt.config.resources import models_folder
from robobt.models.actions import commander
from robobt.models.file import ModelError, ModelFile, UnknownModelError
from robobt.models.find import find_model, read_fitting_model
from robobt.models.policy import load_policy
from robobt.motion.dribbling import carry, drive_gently
from robobt.skills.kicker import has_kicked
from robobt.skills.store import TeamStore
from robobt.tree import Registry
from robobt.tree.by_name import ByName
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS, among_robots_of
from robobt.world.command import RobotCommand
from robobt.world.features import (
    GO_TO_BALL,
    GO_TO_BALL_TO_SHOOT,
    SHOOT,
    ObservationSpec,
    find_observation,
    go_to_ball_of,
    go_to_ball_to_shoot_of,
    shoot_of,
)
from robobt.world.geometry import FloatArray, distance
from robobt.world.memory import Memory, MemorySize, memory_of
from robobt.world.observation import OWN_OBSERVATIONS
from robobt.world.scoring import SCORE_ON_GOALKEEPER, score_on_goalkeeper_of
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotState
from robobt.world.team_view import places_of, team_view_of

OBSERVERS: Mapping[str, Callable[[Frame, RobotState], FloatArray]] = {
    GO_TO_BALL.name: go_to_ball_of,
    GO_TO_BALL_TO_SHOOT.name: go_to_ball_to_shoot_of,
    GO_TO_BALL_AMONG_ROBOTS.name: among_robots_of,
    SHOOT.name: shoot_of,
    SCORE_ON_GOALKEEPER.name: score_on_goalkeeper_of,
}
"""The function that computes each observation from a frame, except the observations of robots in a team."""

P = TypeVar("P")
_Ready: TypeAlias = tuple[Callable[[FloatArray], list[float]], Callable[[list[float]], RobotCommand]]

_EARLIEST = 0.004
"""How much earlier than a period of its training a decision may follow another to be remembered [s]."""

_shipped: dict[Path, ModelFile] = {}
"""Shipped models in use. Their networks are loaded at the first decision, so most processes need no torch."""

OBSERVATION = "observation"
"""The drawing layer for observations and actions of trained policies."""

_WEAK_HOLD = 1.0
"""A dribbler that holds the ball at less than this acceleration loses it in sharp turns [m/s^2]."""

_AT_BALL = 0.25
"""Distance from robot to ball within which that counts [m]."""

_LARGEST_ACTION = 1.0 + 1e-4
_LEAST_ACTION = -_LARGEST_ACTION
"""Largest and least action that rounding in single precision explains."""


class PolicyError(RobobtError, RuntimeError):
    """A policy's answer is not a valid action; the robot must not act on it."""


class LearnedControl:
    """A trained policy that decides one robot's command, tick by tick.

    If its observation has a memory, that holds what was seen and done at the last decisions a period of its
    training apart; a longer pause makes it forget.

    The network of a shipped model is loaded at its first decision, or by :func:`load_shipped_policies`; any
    other model is loaded at once, so that its errors are reported before anything moves.

    Args:
        model: name of a shipped model, or the path of a model file.
        skill: the skill the model has to be made for; None for any.
        observation: the observation it has to take; None for any.

    Attributes:
        card: the model's own description.
        remembers: whether its observation has a memory.
        minds_kicker: whether it observes that its robot took a restart and may not touch the ball again yet.

    Raises:
        ModelError: the model cannot be used.
    """

    def __init__(
        self, model: str | Path, skill: str | None = None, observation: ObservationSpec | None = None
    ) -> None:
        file = read_fitting_model(model, skill=skill, observation=observation)
        self.card, self._file = file.card, file
        if self.card.kind != "policy" or self.card.action is None:
            raise ModelError(f"{file.path}: is a {self.card.kind.replace('_', ' ')}, not a policy")
        name = self.card.observation.name
        memory = memory_of(name)
        observe = observer_of(name if memory is None else memory.base)
        if observe is None:
            there = ", ".join(OBSERVERS)
            raise ModelError(
                f"{file.path}: no skill makes the observation {name!r}; there are {there}, "
                "and team_view_M_N with places for M mates and N opponents, which may end in _restarts "
                "or _restarts_double_touch; one of your own comes with --import FILE"
            )
        self._observe: Callable[..., FloatArray] = observe
        places = places_of(name)
        self.minds_kicker = places is not None and places.told > 1
        self.remembers = memory is not None
        self._memory_size, self._memory = memory, None if memory is None else _Recollection(memory)
        self._ready: _Ready | None = None
        self._scaling = self.card.action
        if file.path.parent.resolve() == models_folder().resolve():
            _shipped[file.path] = file
        else:
            self._load()

    def _load(self) -> _Ready:
        self._ready = load_policy(self._file).single(), commander(self._scaling)
        return self._ready

    def decide(
        self, frame: Frame, me: RobotState, sketch: Sketch | None = None, barred: bool = False
    ) -> RobotCommand:
        """Compute the command of one tick.

        Args:
            frame: the frame as its team sees it.
            me: its robot.
            sketch: records its observation and action.
            barred: whether its robot took a restart and may not touch the ball yet; used with
                ``minds_kicker``.

        Raises:
            PolicyError: the policy fails, its answer is not finite or is outside [-1, 1], or it cannot be
            loaded.
        """
        try:
            infer, command = self._ready or self._load()
            observed = self._observe(frame, me, barred=True) if barred else self._observe(frame, me)
            if self._memory is not None:
                observed = self._memory.recall(observed, frame.time, self.card.period or frame.period)
            action = infer(observed)
            if self._memory is not None:
                self._memory.act(action)
        except ModelError as error:
            raise PolicyError(str(error)) from error
        if sketch is not None and sketch.wants(OBSERVATION):
            self._draw(sketch, observed, action)
        for entry in action:
            if not _LEAST_ACTION <= entry <= _LARGEST_ACTION:
                said = "no number" if isnan(entry) else f"{entry:.3g}, outside [-1, 1]"
                raise PolicyError(f"the policy {self.card.name} answers {said}")
        return command(action)

    def forget(self) -> None:
        """Forget what was seen and done before."""
        if self._memory_size is not None:
            self._memory = _Recollection(self._memory_size)

    def _draw(self, sketch: Sketch, observed: FloatArray, action: list[float]) -> None:
        spec = find_observation(self.card.observation.name)
        assert spec is not None
        for entry, value in zip(spec.entries, observed.tolist(), strict=True):
            sketch.number(OBSERVATION, entry.name, value)
        for place, value in enumerate(action):
            sketch.number(OBSERVATION, f"action {place}", value)


class _Recollection:
    """What one robot remembers of its decisions."""

    def __init__(self, size: MemorySize) -> None:
        self._size = size
        self._memory: Memory | None = None
        self._latest: tuple[float, FloatArray, list[float]] | None = None
        self._now = 0.0
        self._seen = np.zeros((1, 0))

    def recall(self, seen: FloatArray, time: float, period: float) -> FloatArray:
        """Return what is seen at a time [s] followed by what is remembered, decisions a period apart [s]."""
        self._seen, self._now = seen[None], time
        if self._memory is None or self._latest is None or not 0.0 <= time - self._latest[0] < 2.5 * period:
            self._memory, self._latest = Memory(self._size, len(seen)), None
            self._memory.begin(self._seen, slice(None))
        elif time - self._latest[0] > period - _EARLIEST:
            _, before, action = self._latest
            self._memory.remember(before, np.array([action]))
            self._latest = None
        row: FloatArray = self._memory.recall(self._seen)[0]
        return row

    def act(self, action: list[float]) -> None:
        """Note what was decided upon what was recalled last."""
        if self._latest is None:
            self._latest = self._now, self._seen, action


def load_shipped_policies() -> None:
    """Load the networks of all controls built so far, before a match in real time."""
    for file in _shipped.values():
        # An error in a model is reported where the model is used.
        with suppress(ModelError):
            load_policy(file)


class PacedControl:
    """A trained policy that decides as often as in training; its last command holds in between.

    With the ball in its mouth the robot drives sideways only as fast as its dribbler can hold the ball. A
    robot whose dribbler hardly holds a ball, and whose policy was trained with a better one, changes its
    velocity at the ball no faster than the robot in training sped up.

    Args:
        model: as for :class:`LearnedControl`.
        skill: as for :class:`LearnedControl`.
        observation: as for :class:`LearnedControl`.

    Attributes:
        card: the model's own description.

    Raises:
        ModelError: the model cannot be used.
    """

    def __init__(
        self, model: str | Path, skill: str | None = None, observation: ObservationSpec | None = None
    ) -> None:
        self._control = LearnedControl(model, skill, observation)
        self.card = self._control.card
        self._period = self.card.period or 0.0
        self._decided, self._command = -inf, RobotCommand()

    def restart(self) -> None:
        """Forget the last decision."""
        self._decided = -inf
        self._control.forget()

    def decide(
        self, frame: Frame, me: RobotState, sketch: Sketch | None = None, team: TeamStore | None = None
    ) -> RobotCommand:
        """Return the command of one tick: a new decision or the last one; see :meth:`LearnedControl.decide`.

        ``team`` is the team's store, which remembers who took a restart.

        Raises:
            PolicyError: the policy's answer is not finite or is outside [-1, 1].
        """
        barred = team is not None and self._control.minds_kicker and has_kicked(frame, team, me.id)
        # Half a tick of tolerance, because times are sums of periods with rounding errors.
        if not 0.0 <= frame.time - self._decided < self._period - frame.period / 2:
            self._decided = -inf
            self._command = self._control.decide(frame, me, sketch, barred)
            self._decided = frame.time
        command = self._command.copy()
        carry(command, me)
        trained = self.card.limits
        if (
            trained is not None
            and me.limits.hold_acceleration < min(_WEAK_HOLD, trained.hold_acceleration)
            and distance(me.position, frame.ball.position) < _AT_BALL
        ):
            drive_gently(command, me, trained.acceleration, trained.turn_acceleration, frame.period)
        return command


def observer_of(name: str) -> Callable[[Frame, RobotState], FloatArray] | None:
    """Return the function that computes the named observation from a frame, or None if there is none."""
    places = places_of(name)
    if places is None:
        own = OWN_OBSERVATIONS.get(name)
        return OBSERVERS.get(name) if own is None else own.of
    return partial(team_view_of, **places._asdict())


def policies_by_name(registry: Registry[Callable[..., object]], *besides: str) -> ByName:
    """Return a reader for the policies of a skill by name; other names are ``besides`` or models' names."""
    also = "".join([f"{name}, and " for name in besides]) + "models by name or file (robobt list models)"
    return ByName(registry, others=lambda name: name in besides or _may_be_model(name), also=f"also {also}")


def _may_be_model(name: str) -> bool:
    try:
        find_model(name)
    except UnknownModelError:
        return False
    except ModelError:
        # The error is reported where the model is loaded.
        pass
    return True


def find_policy(given: object, by_name: ByName, learned: Callable[[str], P]) -> P:
    """Return the object that decides for a skill, from its ``policy`` parameter.

    Args:
        given: the name of a policy, a mapping with that and settings, a model by name or file, or a policy.
        by_name: reads the skill's own policies.
        learned: makes a policy of a model.

    Raises:
        ValueError: there is no such policy, its settings do not fit, or its model cannot be used.
    """
    made = by_name.make(given)
    return learned(made) if isinstance(made, str) else made
