"""The plan of a tournament."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from robobt import __version__
from robobt.config.errors import ConfigError, RobobtError
from robobt.match.loop import WorldFactory
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.results.file import scenario_digest
from robobt.match.scenario.scenario import Scenario
from robobt.tournament.entrants import Entrant, meeting
from robobt.tournament.fixtures import Fixture, fixtures, pairings
from robobt.tournament.guard import STANDSTILL_TIME
from robobt.tournament.store import MatchStore
from robobt.worlds import scenario_settings, sim_world


class TournamentError(RobobtError, ValueError):
    """A tournament cannot be played; the message is one line."""


@dataclass(slots=True, frozen=True)
class Plan:
    """The plan: scenario, entrants and rounds.

    Attributes:
        scenario: the field, the starts, the rules and the ends of every match.
        entrants: the entrants.
        rounds: number of rounds of each pairing, each with a new seed and once from either side.
        seed: seed from which the rounds' seeds are derived.
        against: name of the entrant that all others meet; None for all against all.
        referee: makes the referee of a match.
        silence: time without progress after which a match is given up [s].
        world: makes the world of a match.
        speed: simulated time over real time, for matches with programs; others are as fast as they are.
        first_round: number of the first round; those before it have other seeds.

    Raises:
        TournamentError: two entrants have the same name, there are too few, or ``against`` is none of them.
        ScenarioError: an entrant does not fit the scenario.
    """

    scenario: Scenario
    entrants: tuple[Entrant, ...]
    rounds: int
    seed: int
    against: str | None = None
    referee: RefereeFactory = own_referee
    silence: float = STANDSTILL_TIME
    world: WorldFactory = sim_world
    speed: float = 1.0
    first_round: int = 0

    def __post_init__(self) -> None:
        names = self.names
        for name in names:
            if names.count(name) > 1:
                raise TournamentError(f"two entrants are called {name!r}; give one another name")
        if self.against is not None and self.against not in names:
            raise TournamentError(f"there is no entrant {self.against!r} to play against")
        if len(names) < 2:
            raise TournamentError("a tournament needs two entrants")
        scenario_settings(self.scenario)
        for entrant in self.entrants:
            try:
                meeting(self.scenario, entrant, entrant)
            except ConfigError as error:
                raise entrant.error(str(error)) from error

    @property
    def names(self) -> list[str]:
        """Return the entrants' names."""
        return [entrant.name for entrant in self.entrants]

    @property
    def plays(self) -> list[str]:
        """Return the names of the plays of all robots, those that the scenario gives them too."""
        own = [part.play for entrant in self.entrants for part in entrant.parts]
        return list(dict.fromkeys([*own, *[setup.play for _, setup in self.scenario.robots]]))

    @property
    def pairings(self) -> list[tuple[str, str]]:
        """Return the pairings."""
        return pairings(self.names, self.against)

    def fixtures(self) -> list[Fixture]:
        """Return all matches, round by round."""
        return list(fixtures(self.pairings, self.rounds, self.first_round))

    def open_store(self, path: Path, **besides: str) -> MatchStore:
        """Open its store, or make it, and return it with the entrants entered.

        Args:
            path: the file.
            besides: what else is played, by field.

        Raises:
            StoreError: the file is another tournament's, or not a store.
        """
        played = {
            "scenario": self.scenario.name,
            "digest": scenario_digest(self.scenario),
            "seed": self.seed,
            "referee": getattr(self.referee, "name", "own"),
            "robobt": __version__,
            **besides,
        }
        store = MatchStore(path, played)
        try:
            store.enter(self.entrants)
            store.define("scenario", self.scenario.model_dump_json())
        except BaseException:
            store.close()
            raise
        return store
