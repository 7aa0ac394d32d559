"""One match of a tournament, played by a worker process."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

import robobt
from robobt.config.errors import one_line
from robobt.config.resources import models_folder
from robobt.league.programs.program import ForfeitError
from robobt.league.programs.staying import programs_in
from robobt.league.referee.process import GameControllerError
from robobt.league.wire.stream import StreamError
from robobt.match.loop import MatchLoop
from robobt.match.runner import trial_seed
from robobt.plays import PLAYS
from robobt.plays.base import Play
from robobt.plays.python_files import imported_files
from robobt.tournament.entrants import Entrant, meeting
from robobt.tournament.fixtures import Fixture
from robobt.tournament.guard import guarded, noted
from robobt.tournament.plan import Plan
from robobt.tournament.played import FORFEITS, PlayedMatch, SideResult
from robobt.tournament.recordings import Recordings, file_name
from robobt.world.game import Team


def code_digest() -> str:
    """Hash robobt's code, its models and the files that were imported, which decide a match too."""
    digest = hashlib.blake2b(digest_size=8)
    root = Path(robobt.__file__).parent
    for path in (*sorted(root.rglob("*.py")), *sorted(models_folder().glob("*.*")), *imported_files()):
        digest.update(path.read_bytes())
    return digest.hexdigest()


@dataclass(slots=True, frozen=True)
class Failure:
    """A match could not be played.

    Attributes:
        fixture: the match.
        problem: the reason.
        again: whether it may be played again, because neither side's play failed.
    """

    fixture: Fixture
    problem: str
    again: bool = False


@dataclass(slots=True, frozen=True)
class Job:
    """Everything that a worker needs to play any of the matches.

    The registered plays are there because they are sent by name: a worker that receives them has imported
    the modules that register them.
    """

    plan: Plan
    notes: Path
    outputs: Path
    tell_outputs: bool
    recordings: Recordings | None
    plays: tuple[Play, ...]
    code: str

    @classmethod
    def of(
        cls, plan: Plan, notes: Path, outputs: Path, recordings: Recordings | None, tell_outputs: bool = True
    ) -> Self:
        """Return the job of a plan.

        Args:
            plan: the tournament's plan.
            notes: folder for notes on who is deciding.
            outputs: folder for what programs print.
            recordings: which matches are recorded.
            tell_outputs: whether a match that is lost by rule says where that is.
        """
        plays = tuple({PLAYS[name] for name in plan.plays if name in PLAYS})
        return cls(plan, notes, outputs, tell_outputs, recordings, plays, code_digest())

    def play(self, fixture: Fixture, _report: object) -> PlayedMatch | Failure:
        """Play a match."""
        plan, sides = self.plan, self._sides(fixture)
        record = None if self.recordings is None else self.recordings.path(fixture)
        programs = {team: one.program for team, one in sides.items() if one.program is not None}
        try:
            scenario = meeting(plan.scenario, sides[Team.BLUE], sides[Team.YELLOW])
            seed = trial_seed(plan.seed, fixture.round)
            with ExitStack() as opened:
                world = plan.world(scenario)
                if programs:
                    outputs = {team: self._printed(fixture, team) for team in programs}
                    places = {team: Path(sides[team].source).parent for team in programs}
                    world = opened.enter_context(
                        programs_in(world, scenario, programs, places, outputs, plan.speed)
                    )
                match = MatchLoop(scenario, seed, lambda _: world, record, fixture.round, plan.referee)
                with guarded(match, self._note(fixture), plan.silence):
                    result = match.play()
        except (GameControllerError, StreamError) as error:
            return Failure(fixture, one_line(f"{type(error).__name__}: {error}"), again=True)
        except OSError:
            raise
        except ForfeitError as error:
            printed = self._printed(fixture, error.team)
            kept = f"; its output: {printed}" if self.tell_outputs and printed.exists() else ""
            return self._forfeit(fixture, error.team, f"{error}{kept}")
        except Exception as error:
            return Failure(fixture, one_line(f"{type(error).__name__}: {error}"))
        return PlayedMatch.of_result(fixture, result, self.code, _now(), match.events)

    def lost(self, fixture: Fixture, problem: str) -> PlayedMatch | Failure:
        """Return the result of a match whose process has died."""
        culprit = noted(self._note(fixture))
        if culprit is None:
            return Failure(fixture, problem)
        return self._forfeit(fixture, culprit, problem)

    def _sides(self, fixture: Fixture) -> dict[Team, Entrant]:
        by_name = {entrant.name: entrant for entrant in self.plan.entrants}
        return {Team.BLUE: by_name[fixture.blue], Team.YELLOW: by_name[fixture.yellow]}

    def _forfeit(self, fixture: Fixture, loser: Team, problem: str) -> PlayedMatch:
        """Return a match that a team has lost by rule."""
        said = f"{fixture.blue if loser is Team.BLUE else fixture.yellow}: {problem}"
        return PlayedMatch(
            *fixture,
            seed=trial_seed(self.plan.seed, fixture.round),
            outcome=FORFEITS[loser],
            time=0.0,
            blue_score=0,
            yellow_score=0,
            in_play=0.0,
            ticks=0,
            trace="",
            code=self.code,
            finished=_now(),
            sides={team.value: SideResult(first_error=said if team is loser else None) for team in Team},
        )

    def _printed(self, fixture: Fixture, team: Team) -> Path:
        """Return the file for what a team's program prints."""
        return self.outputs / file_name(fixture) / f"{team.value}.txt"

    def _note(self, fixture: Fixture) -> Path:
        return self.notes / hashlib.blake2b(repr(fixture).encode(), digest_size=8).hexdigest()


def set_up(know: Callable[[], None]) -> None:
    """Prepare a worker: redirect plays' output, which must not mix with the figures.

    Args:
        know: tells it the users' Python files.
    """
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    know()


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
