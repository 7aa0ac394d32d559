"""One match of a tournament, as the store keeps it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields

from robobt.match.referee.events import EventKind
from robobt.match.results.results import MatchResult
from robobt.match.results.teams import TeamResult
from robobt.tournament.fixtures import Fixture
from robobt.world.game import Team
from robobt.world.protocol import ReportedEvent

FORFEITS = {team: f"forfeit_{team.value}" for team in Team}
"""Outcomes of matches that a team lost because it crashed or hung."""

MAY_DIFFER = ("wall_time", "finished")
"""Columns that differ between two plays of the same match."""

KEPT_EVENTS = frozenset(
    {
        EventKind.GOAL,
        EventKind.INVALID_GOAL,
        EventKind.PENALTY_KICK_FAILED,
        EventKind.MULTIPLE_FOULS,
        EventKind.MULTIPLE_CARDS,
    }
)
"""The referee's events that a store keeps: goals, penalty kicks and cards."""

_MOST_EVENTS = 25
"""Events that a store keeps of one match, so that a match takes less than 1 kB."""


@dataclass(slots=True)
class SideResult(TeamResult):
    """One side of a match: the team's figures, and its trees' failures.

    Attributes:
        errors: ticks in which a robot's tree failed.
        first_error: the first of them; None without one.
    """

    errors: int = 0
    first_error: str | None = None


@dataclass(slots=True, frozen=True)
class PlayedMatch:
    """One match of a tournament.

    Attributes:
        blue, yellow: the entrants.
        round: of the tournament, from 0.
        seed: what its randomness followed from.
        outcome: how it ended; "forfeit_blue" and "forfeit_yellow" say who lost by rule, whatever the score.
        time: how long it lasted in the world [s].
        blue_score, yellow_score: goals.
        in_play: share of the time with the ball in play.
        ticks: control periods.
        trace: hash over every true state; equal traces are equal matches.
        sides: figures of each side by its team's name.
        code: hash of robobt's code that played it.
        wall_time: how long it took to play [s].
        finished: when, UTC.
        events: goals, failed penalty kicks and cards, each as "12.35 goal blue 3" with its time [s], joined
            by semicolons; the first 25 of them.
    """

    blue: str
    yellow: str
    round: int
    seed: int
    outcome: str
    time: float
    blue_score: int
    yellow_score: int
    in_play: float
    ticks: int
    trace: str
    code: str = ""
    wall_time: float = 0.0
    finished: str = ""
    events: str = ""
    sides: Mapping[str, SideResult] = field(default_factory=dict)

    @property
    def fixture(self) -> Fixture:
        """Return who met whom in which round."""
        return Fixture(self.blue, self.yellow, self.round)

    @property
    def course(self) -> tuple[object, ...]:
        """Return what two plays of the same match have in common; a forfeit has no trace."""
        return self.trace, self.outcome, self.blue_score, self.yellow_score

    def side(self, name: str) -> SideResult:
        """Return the figures of one of the entrants."""
        return self.sides[(Team.BLUE if name == self.blue else Team.YELLOW).value]

    def lead(self, name: str) -> int:
        """Return by how many goals one of the entrants won."""
        lead = self.blue_score - self.yellow_score
        return lead if name == self.blue else -lead

    def goals(self, name: str) -> int:
        """Return the goals of one of the entrants."""
        return self.blue_score if name == self.blue else self.yellow_score

    @property
    def forfeited_by(self) -> str | None:
        """Return the entrant that lost by rule, because what it plays crashed or hung."""
        return {FORFEITS[Team.BLUE]: self.blue, FORFEITS[Team.YELLOW]: self.yellow}.get(self.outcome)

    def score(self, name: str) -> float:
        """Return what one of the entrants scores: 1 for a win, 0.5 for a draw, 0."""
        lead = self.lead(name)
        if self.forfeited_by is not None:
            return float(self.forfeited_by != name)
        return 0.5 if lead == 0 else float(lead > 0)

    def row(self) -> dict[str, object]:
        """Return the columns of the table."""
        data: dict[str, object] = {name: getattr(self, name) for name in PLAIN}
        for team in Team:
            side = self.sides.get(team.value, SideResult())
            data |= {f"{team.value}_{name}": getattr(side, name) for name in SIDE}
        return data

    @classmethod
    def of_row(cls, row: Mapping[str, object]) -> PlayedMatch:
        """Return the match of a row of the table."""
        sides = {
            team.value: SideResult(
                goals=row[f"{team.value}_score"],  # type: ignore[arg-type]
                **{name: row[f"{team.value}_{name}"] for name in SIDE},  # type: ignore[arg-type]
            )
            for team in Team
        }
        # Stores of earlier versions hold no events.
        known = {name: row[name] for name in PLAIN if name in row}
        return cls(**known, sides=sides)  # type: ignore[arg-type]

    @classmethod
    def of_result(
        cls,
        fixture: Fixture,
        result: MatchResult,
        code: str,
        finished: str,
        events: Iterable[ReportedEvent] = (),
    ) -> PlayedMatch:
        """Return what is kept of a match's result and of the referee's events."""
        sides = {}
        for team in Team:
            robots = [robot for name, robot in result.robots.items() if name.startswith(team.value)]
            figures = result.teams.get(team.value, TeamResult())
            first = next((robot.first_error for robot in robots if robot.first_error is not None), None)
            sides[team.value] = SideResult(
                **asdict(figures), errors=sum(robot.errors for robot in robots), first_error=first
            )
        return cls(
            *fixture,
            seed=result.seed,
            outcome=result.outcome,
            time=result.time,
            blue_score=result.blue_score,
            yellow_score=result.yellow_score,
            in_play=result.in_play,
            ticks=result.ticks,
            trace=result.trace,
            code=code,
            wall_time=result.wall_time,
            finished=finished,
            events=_told(events),
            sides=sides,
        )


def _told(events: Iterable[ReportedEvent]) -> str:
    kept = [event for event in events if event.kind in KEPT_EVENTS][:_MOST_EVENTS]
    return "; ".join([f"{event.time:.2f} {event.kind} {event.robot or event.team or ''}" for event in kept])


PLAIN = tuple(part.name for part in fields(PlayedMatch) if part.name != "sides")
"""Columns that are fields of the match itself."""

SIDE = tuple(part.name for part in fields(SideResult) if part.name != "goals")
"""Columns of a side, behind its team's name; its goals are the match's."""

MATCH_COLUMNS = (*PLAIN, *[f"{team.value}_{name}" for team in Team for name in SIDE])
"""The columns of the table."""
