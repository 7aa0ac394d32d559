"""Selection of a run's best actor and early stopping, by the validation starts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import torch

from robobt.learning.agents.networks import Actor, ActorBuild
from robobt.learning.training.checkpoint import Arrays
from robobt.learning.training.results import Validation
from robobt.learning.training.setting_groups import EvaluationSettings


class Selection:
    """The evaluations of a run and the weights of its best actor.

    ``best`` is the best of ``validations``, None before the first, with the actor's ``weights``.
    """

    def __init__(self, settings: EvaluationSettings) -> None:
        self._settings = settings
        self.validations: list[Validation] = []
        self.best: Validation | None = None
        self.weights: Arrays = {}

    @property
    def latest(self) -> Validation | None:
        """The last evaluation; None before the first."""
        return self.validations[-1] if self.validations else None

    def add(self, validation: Validation, actor: Actor) -> None:
        """Add an evaluation, and keep its actor if it is the best so far."""
        self.validations.append(validation)
        if self.best is None or self._score(validation) > self._score(self.best):
            self.best = validation
            self.weights = {key: value.numpy().copy() for key, value in actor.state_dict().items()}

    def is_good_enough(self) -> bool:
        """Return whether the run may stop early: the last ``stop_after`` evaluations have met its bar."""
        settings = self._settings
        if settings.stop_success is None or len(self.validations) < settings.stop_after:
            return False
        success, time = settings.stop_success, settings.stop_time
        latest = self.validations[-settings.stop_after :]
        if time is None:
            return all(validation.success >= success for validation in latest)
        return all(validation.reaches(success, time) for validation in latest)

    def _score(self, validation: Validation) -> tuple[float, float]:
        return validation.score(self._settings.enough)

    def actor(self, build: ActorBuild) -> Actor:
        """Return the best actor, frozen; ``build`` is that of the agent's."""
        actor = Actor(**build)
        actor.load_state_dict({key: torch.from_numpy(value) for key, value in self.weights.items()})
        return actor.requires_grad_(False)

    def state(self) -> list[dict[str, Any]]:
        """Return the evaluations as plain data; a resumed run needs :attr:`weights` too."""
        return [asdict(validation) for validation in self.validations]

    def restore(self, validations: Sequence[Mapping[str, Any]], weights: Arrays) -> None:
        """Restore another selection's :meth:`state` and weights."""
        self.validations = [Validation(**validation) for validation in validations]
        self.best = max(self.validations, key=self._score, default=None)
        self.weights = weights
