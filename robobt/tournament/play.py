"""Plays a tournament's missing matches on worker processes, robust against crashing entrants."""

from __future__ import annotations

import tempfile
import time
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from robobt.engines.run import engine, run_tasks
from robobt.engines.work import Work
from robobt.league.programs.staying import end_staying
from robobt.plays.private_files import sender
from robobt.signals import uninterrupted
from robobt.tournament.claims import Claims
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import Failure, Job, set_up
from robobt.tournament.plan import Plan, TournamentError
from robobt.tournament.played import PlayedMatch
from robobt.tournament.recordings import Recordings
from robobt.tournament.store import MatchStore

Enough = Callable[[Collection[PlayedMatch], Collection[Fixture]], bool]

Needless = Callable[[Fixture], bool]

_CLAIM_POLL = 1.0
"""Interval for checking whether another program has finished its claimed matches [s]."""

_TELLS = 15
"""Number of checks without progress after which a message is printed: the other program may be suspended."""


@dataclass(slots=True)
class Played:
    """The result of a tournament.

    Attributes:
        matches: those that the store holds of the plan, in the order of rounds and names.
        failed: what kept a match from being played, by match; it is tried again the next time.
        interrupted: whether it was stopped (Ctrl-C).
    """

    matches: list[PlayedMatch]
    failed: dict[Fixture, str] = field(default_factory=dict)
    interrupted: bool = False


def play_tournament(
    plan: Plan,
    store: MatchStore,
    workers: int = 0,
    *,
    recordings: Recordings | None = None,
    on_match: Callable[[PlayedMatch], object] | None = None,
    enough: Enough | None = None,
    needless: Needless | None = None,
    on_wait: Callable[[int], object] | None = None,
    tell_outputs: bool = True,
    job: type[Job] = Job,
) -> Played:
    """Play what is missing in the store, and return all that is there.

    A match that cannot be played without either play's fault is left out. If a play twice ends a match's
    process, or hangs forever, its side loses the match. Several programs may do this at once with one store:
    each match is played by one of them.

    Args:
        plan: what is played.
        store: opened for this plan.
        workers: processes; 0 is this process itself, which an entrant that crashes takes with it.
        recordings: which matches are recorded; none by default.
        on_match: called with each match as it is there, first with those that the store holds already.
        enough: called after each match with all that are there and those that could not be played; once
            it says True no further match begins, and those in progress are not waited for.
        needless: returns, before a match begins, whether its result is no longer needed.
        on_wait: called once when nothing is left but matches that another program has claimed, and it has not
            ended one for a while, with their number.
        tell_outputs: whether a match that a program has lost by rule says where what it printed lies, which
            is beside the store.
        job: plays a match.

    Raises:
        StoreError: the store cannot be written.
        OSError: a recording cannot be written.
    """
    driver = _Driver(plan, store, recordings, on_match, enough, needless)
    interrupted, looks = False, 0

    def lost(fixture: Fixture, problem: str) -> PlayedMatch | Failure:
        # A process may also be killed from outside, as for want of memory, or have stood still with this one;
        # a match that a play has ended ends again. An engine elsewhere has tried more than once already.
        if fixture in driver.begun_anew or engine() is not None:
            return works.lost(fixture, problem)
        return Failure(fixture, problem, again=True)

    with tempfile.TemporaryDirectory(prefix="robobt-notes-") as notes, Claims(store.path) as claims:
        outputs = store.path.with_suffix(".output")
        works = job.of(plan, Path(notes), outputs, recordings, tell_outputs)
        try:
            while missing := driver.missing():
                tasks = run_tasks(
                    Work(works.play, "match", TournamentError, (OSError,)),
                    driver.claimed(missing, claims),
                    min(workers, len(missing)),
                    setup=partial(set_up, sender(plan.plays)),
                    lost=lost if workers else None,
                )
                waits = True
                with closing(tasks) as results:
                    for result in results:
                        waits = False
                        driver.take(result)
                        claims.release(result.fixture)
                        if driver.stop:
                            break
                if not waits:
                    looks = 0
                elif left := driver.missing():
                    looks = looks + 1 if left == missing else 0
                    if looks == _TELLS and on_wait is not None:
                        on_wait(len(left))
                    time.sleep(_CLAIM_POLL)
        except KeyboardInterrupt:
            interrupted = True
        finally:
            end_staying()
    return Played([driver.done[one] for one in sorted(driver.done, key=_order)], driver.failed, interrupted)


class _Driver:
    """What has been played so far, and what follows from each match.

    Attributes:
        done: matches that are played; ``failed`` says of others why not.
        begun_anew: matches that are played once more, as their process died or their referee was lost.
        stop: whether it is enough.
    """

    def __init__(
        self,
        plan: Plan,
        store: MatchStore,
        recordings: Recordings | None,
        on_match: Callable[[PlayedMatch], object] | None,
        enough: Enough | None,
        needless: Needless | None,
    ) -> None:
        self._store, self._recordings, self._on_match, self._enough = store, recordings, on_match, enough
        self._needless = needless or (lambda _: False)
        self._wanted = plan.fixtures()
        self.done: dict[Fixture, PlayedMatch] = {}
        self.failed: dict[Fixture, str] = {}
        self.begun_anew: set[Fixture] = set()
        self.stop = False
        # Those of earlier rounds come first, as a sequential test waits for them.
        self._again: deque[Fixture] = deque()
        held = {match.fixture: match for match in store.matches(plan.names)}
        for fixture in self._wanted:
            if fixture in held:
                self._known(held[fixture])
        self._judge()

    def missing(self) -> list[Fixture]:
        """Return what is still to be played, nothing once it is enough."""
        if self.stop:
            return []
        known = (self.done, self.failed)
        return [one for one in self._wanted if not any(one in of for of in known) and not self._needless(one)]

    def claimed(self, missing: Iterable[Fixture], claims: Claims) -> Iterator[Fixture]:
        """Yield matches that no other program is playing; those finished meanwhile count as played."""
        left = deque(missing)
        self._again.clear()
        while (self._again or left) and not self.stop:
            fixture = self._again.popleft() if self._again else left.popleft()
            if self._needless(fixture) or not claims.take(fixture):
                continue
            theirs = self._store.match(fixture)
            if theirs is None:
                if self._recordings is not None:
                    # What another tournament has left there is not of this match.
                    self._recordings.remove(fixture)
                yield fixture
            else:
                claims.release(fixture)
                self._finished(theirs)

    def take(self, result: PlayedMatch | Failure) -> None:
        """Take in a match that has just been played."""
        if isinstance(result, Failure) and result.again and result.fixture not in self.begun_anew:
            self.begun_anew.add(result.fixture)
            self._again.append(result.fixture)
            return
        if isinstance(result, Failure):
            self.failed[result.fixture] = result.problem
            return
        with uninterrupted:
            self._store.add(result)
        self._finished(result)
        if self._recordings is not None:
            self._recordings.sort_out(self.done.values())

    def _finished(self, match: PlayedMatch) -> None:
        self._known(match)
        self._judge()

    def _known(self, match: PlayedMatch) -> None:
        self.done[match.fixture] = match
        if self._on_match is not None:
            self._on_match(match)

    def _judge(self) -> None:
        if self._enough is not None and self._enough(self.done.values(), self.failed):
            self.stop = True


def _order(fixture: Fixture) -> tuple[int, str, str]:
    return fixture.round, fixture.blue, fixture.yellow
