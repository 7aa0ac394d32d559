"""A technical challenge of the league: scenario, rules and score, each a part that can be replaced."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.scenario.scenario import Scenario
from robobt.tree import Registry
from robobt.world.game import GameState
from robobt.world.state import Frame

Figures = Mapping[str, float]
"""What was counted, by name; the first is the score."""


class Judge(Protocol):
    """Judges one attempt by the true frames alone; it knows nothing of the plays."""

    def see(self, frame: Frame, game: GameState) -> bool:
        """Take in the next true ``frame``, seen from blue's side, and the state of the ``game`` there.

        Returns:
            Whether the attempt is over.
        """

    def figures(self) -> Figures:
        """Return what was counted so far."""


@dataclass(slots=True, frozen=True)
class ChallengeAttempt:
    """One attempt at a challenge.

    Attributes:
        name: which part of the challenge it is, such as a published scenario; part of file names.
        scenario: field, starts and time limit; blue is the team that takes the challenge.
        judge: makes the judge of the attempt.
        referee: makes the referee; by default the scenario's own.
    """

    name: str
    scenario: Scenario
    judge: Callable[[], Judge]
    referee: RefereeFactory = own_referee


class Challenge(ABC):
    """A challenge: its attempts, and the score that they come to.

    Attributes:
        title: one line for lists.
        source: the document with the rules, with year and version.
        unit: what the score counts.
        most: the greatest possible score, None without one.
        entrants: the rows of comparison, each with the play of blue's robots as ``--blue`` takes it.
        opponent: whether yellow plays too, so that ``--yellow`` may replace its play.
    """

    title: ClassVar[str]
    source: ClassVar[str]
    unit: ClassVar[str]
    most: ClassVar[float | None] = None
    entrants: ClassVar[Mapping[str, str]]
    opponent: ClassVar[bool] = False

    @abstractmethod
    def attempts(self, generator: np.random.Generator) -> Sequence[ChallengeAttempt]:
        """Return the attempts of one run, in order; ``generator`` draws what the rules leave open."""

    @abstractmethod
    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the figures of a run from those of its attempts; the first is the score."""


class FixedChallenge(Challenge):
    """A challenge whose rules leave nothing open, so that every run has the same attempts."""

    @abstractmethod
    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return the attempts of every run, in order."""

    def attempts(self, generator: np.random.Generator) -> Sequence[ChallengeAttempt]:  # noqa: ARG002
        """Return the attempts of every run; nothing is drawn from ``generator``."""
        return self.fixed_attempts()


CHALLENGES: Registry[type[Challenge]] = Registry(
    "challenge",
    group="robobt.challenges",
    fits=lambda entry: isinstance(entry, type) and issubclass(entry, Challenge),
)
"""Every challenge by name."""
