"""Plays the matches of a store again, from their seeds, to full tracking, and compares the hashes."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Collection
from dataclasses import dataclass
from errno import EEXIST
from pathlib import Path

from robobt import __version__
from robobt.match.results.file import scenario_digest
from robobt.match.scenario.scenario import scenario_from
from robobt.tournament.entrants import Entrant
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import code_digest
from robobt.tournament.plan import Plan
from robobt.tournament.play import play_tournament
from robobt.tournament.played import PlayedMatch
from robobt.tournament.recordings import Keep, Recordings, file_name
from robobt.tournament.store import MatchStore, StoreError


@dataclass(slots=True, frozen=True)
class Regenerated:
    """A match that was played again.

    Attributes:
        match: as the store holds it.
        trace: hash over every true state as it was played again; empty if it could not be played.
        problem: why it could not be played again; empty if it was.
    """

    match: PlayedMatch
    trace: str
    problem: str = ""

    @property
    def equal(self) -> bool:
        """Whether it went the same way, bit for bit."""
        return bool(self.trace) and self.trace == self.match.trace


def differences(store: MatchStore, matches: Collection[PlayedMatch]) -> list[str]:
    """Return what differs between who played the matches and this installation, one line each."""
    here, told = code_digest(), []
    if store.played.get("robobt") != __version__:
        told.append(f"robobt {store.played.get('robobt')} played the tournament, this is {__version__}")
    others = {match.code for match in matches if match.code} - {here}
    if others:
        count = sum(match.code in others for match in matches)
        told.append(f"other code ({', '.join(sorted(others))}) played {count} of the matches, this is {here}")
    return told


def plan_of(store: MatchStore) -> Plan:
    """Return the plan by which the matches of a ``store`` are played again.

    Raises:
        StoreError: the store holds too little, its files have changed, or its matches do not repeat.
    """
    held, played = store.definitions(), store.played
    if "scenario" not in held:
        raise StoreError(store.path, "holds no scenario, so an earlier version of robobt made it")
    if played.get("referee") != "own":
        raise StoreError(store.path, f"is {played.get('referee')!r}, which does not repeat itself", "referee")
    scenario = scenario_from(json.loads(held["scenario"]), str(store.path))
    if scenario_digest(scenario) != played.get("digest"):
        raise StoreError(store.path, "a file that the scenario names has changed since", "scenario")
    entrants = []
    for name, digest in store.entrants().items():
        if f"entrant {name}" not in held:
            raise StoreError(
                store.path, "is not held, so an earlier version of robobt entered it", f"entrants: {name}"
            )
        entrant = Entrant.from_json(held[f"entrant {name}"])
        if entrant.program is not None:
            raise StoreError(store.path, "is a program, which does not repeat itself", f"entrants: {name}")
        if entrant.digest() != digest:
            raise StoreError(store.path, "its files have changed since, or its models", f"entrants: {name}")
        entrants.append(entrant)
    rounds = 1 + max((match.round for match in store.matches()), default=0)
    return Plan(scenario, tuple(entrants), rounds, int(played["seed"]))


def regenerate(
    store: MatchStore,
    matches: Collection[PlayedMatch],
    folder: Path,
    workers: int = 0,
    *,
    on_match: Callable[[Regenerated, Path], object] | None = None,
) -> list[Regenerated]:
    """Play matches of a store again and record them.

    Args:
        store: the store.
        matches: those of its matches to play again; forfeits are left out.
        folder: where the recordings are written, one file a match; no file of these matches is there yet.
        workers: number of processes; 0 is this process itself.
        on_match: called with each match and its recording as soon as it has been played.

    Returns:
        The matches in their given order.

    Raises:
        StoreError: the matches cannot be played again; see :func:`plan_of`.
        OSError: a recording cannot be written, or would replace a file.
        KeyboardInterrupt: it was stopped.
    """
    plan = plan_of(store)
    wanted = {match.fixture: match for match in matches if match.trace}
    recordings = Recordings(folder, Keep.ALL, plan.names[0])
    for fixture in wanted:
        # They may be the recordings of the match as it was played, and this one may go another way.
        for there in folder.glob(f"{file_name(fixture)}.*"):
            raise FileExistsError(EEXIST, "is there already; give another folder", str(there))

    def take(again: PlayedMatch) -> None:
        if on_match is not None:
            match = wanted[again.fixture]
            on_match(Regenerated(match, again.trace), recordings.path(match.fixture))

    def needless(fixture: Fixture) -> bool:
        return fixture not in wanted

    with (
        tempfile.TemporaryDirectory(prefix="robobt-") as place,
        plan.open_store(Path(place) / "again.sqlite") as again,
    ):
        played = play_tournament(
            plan,
            again,
            workers,
            recordings=recordings,
            on_match=take,
            needless=needless,
            tell_outputs=False,
        )
    if played.interrupted:
        raise KeyboardInterrupt
    traces = {match.fixture: match.trace for match in played.matches}
    return [
        Regenerated(match, traces.get(fixture, ""), played.failed.get(fixture, ""))
        for fixture, match in wanted.items()
    ]
