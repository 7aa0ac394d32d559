"""Matches that were never played, and small tournaments that can be."""

from __future__ import annotations

from typing import Any

from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.tournament.entrants import Entrant, read_entrant
from robobt.tournament.plan import Plan
from robobt.tournament.played import PlayedMatch, SideResult
from tests.match.scripted import PlainWorld, data


def played(
    blue: str,
    yellow: str,
    number: int,
    goals: tuple[int, int] = (0, 0),
    *,
    trace: str | None = None,
    outcome: str = "full_time",
    **figures: Any,
) -> PlayedMatch:
    """A match that is like no other, unless its trace is given; figures are blue's."""
    return PlayedMatch(
        blue,
        yellow,
        number,
        seed=number,
        outcome=outcome,
        time=600.0,
        blue_score=goals[0],
        yellow_score=goals[1],
        in_play=0.5,
        ticks=36000,
        trace=f"{blue} {yellow} {number}" if trace is None else trace,
        sides={
            "blue": SideResult(goals=goals[0], **figures),
            "yellow": SideResult(goals=goals[1]),
        },
    )


def drill(seconds: float = 3.0, **changes: Any) -> Scenario:
    """Two robots run to a ball somewhere in the middle and kick it."""
    robot = {"number": 0, "play": "scripted", "start": {"position": [-2.0, 0.0], "heading": 0.0}}
    return scenario_from(
        data(
            robots={"blue": [robot], "yellow": [robot]},
            ball={"position": {"center": [0.0, 0.0], "radius": 1.0}},
            ends={"time_limit": seconds},
            **changes,
        ),
        "drill.yaml",
    )


def runner(speed: float, **params: Any) -> Entrant:
    """A team of scripted robots, the faster the better."""
    return read_entrant("scripted", {"speed": speed, "kick": 4.0, **params}, f"at {speed:g}")


def plan(rounds: int = 2, **changes: Any) -> Plan:
    """Three runners against each other, in a world that costs nothing."""
    given = {"scenario": drill(), "entrants": (runner(2.0), runner(1.0), runner(0.5)), "seed": 3}
    return Plan(rounds=rounds, **{**given, "world": PlainWorld, **changes})
