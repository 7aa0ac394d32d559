"""Attackers against a goalkeeper, part by part: what the tolerance, the network and the feint each add."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import pi
from os.path import relpath
from pathlib import Path
from statistics import fmean
from typing import TypedDict

from robobt.match import MatchResult, Rate, RobotSetup, Scenario, WorldFactory, load_scenario, run_trials_in
from robobt.statistics import mcnemar
from robobt.worlds import sim_world

ATTACKERS: dict[str, dict[str, object]] = {
    "attack_main": {"play": "attack_main"},
    "attack_main as published": {
        "play": "robobulls_attack_main",
        "rater": {"name": "segment_clearance", "tolerance": 0.1965},
    },
    "attack_main, wide": {
        "play": "attack_main",
        "rater": {"name": "segment_clearance", "tolerance": 0.3645},
    },
    "attack_nn, no feint": {"play": "attack_nn", "feint": False},
    "attack_nn": {"play": "attack_nn"},
    "attack_expected": {"play": "attack_expected"},
}
"""Who attacks, the baseline first: changes to the scenario's attacker, by name.

"as published" is Attack Main with RoboBulls' own kick, counters and clearance; "wide" has the clearance of
AttackNN, so that what the network adds is the step from there to "attack_nn, no feint". Sources: the
paper, and RoboBulls' published code.
"""

PAPER: dict[str, dict[str, tuple[int, int]]] = {
    "half": {"attack_main": (28, 100), "attack_nn": (80, 100)},
    "full": {"attack_main": (19, 50), "attack_nn": (35, 50)},
}
"""The paper's goals and shots, by the goalkeeper's speed and the play."""

GOALKEEPERS = {"default": "goalkeeper", "robobulls": "robobulls_goalkeeper"}
"""The goalkeepers' plays by name: this project's, and the paper's with its own pilot."""

SPEEDS = ("half", "full")
STARTS = ("own half", "2.5 to 4.5 m")
"""The paper's collection on the move, and from in front of the goal, where it may shoot at once."""

SEED = 2026
"""Of the shots reported; nothing was tuned on them."""

_SHOOTER, _GOAL = "blue 0", "goal_blue"
_WALL = (-3.2, 0.4)
_CLOCK = 10.0
_ROBOBULLS = Path(__file__).with_name("robobulls.py")


@dataclass(frozen=True, slots=True)
class Situation:
    """What the attackers face.

    Attributes:
        goalkeeper: one of :data:`GOALKEEPERS`.
        speed: of the goalkeeper, one of :data:`SPEEDS`.
        starts: one of :data:`STARTS`.
        defenders: how many of the play ``defender`` there are besides; with any of them
            there are 10 s to score.
    """

    goalkeeper: str = "default"
    speed: str = "full"
    starts: str = STARTS[0]
    defenders: int = 0

    def __str__(self) -> str:
        others = "" if not self.defenders else f" and {self.defenders} more, 10 s"
        return f"{self.goalkeeper} goalkeeper, {self.speed} speed{others}; from {self.starts}"


SITUATIONS = (
    *(Situation(who, speed, starts) for who in GOALKEEPERS for starts in STARTS for speed in SPEEDS),
    *(Situation(defenders=defenders) for defenders in (1, 2)),
)
"""All that is played by default: the paper's, and the hard ones."""


class Against(TypedDict):
    """McNemar's exact test, paired by trial: trials in which only one of both scored, and two-sided p."""

    only_this: int
    only_other: int
    p: float


class Published(TypedDict):
    """The paper's goals and shots."""

    goals: int
    shots: int


class Attacker(TypedDict):
    """One attacker's figures in a situation.

    The rate has its 95 % Wilson interval (``low``, ``high``, and as text). ``attempts`` are the
    trials in which it shot, ``distinct`` those that differ from each other, ``time_to_shot`` the
    mean time from the start to the kick [s], ``waiting`` the mean of what that takes longer than
    the first attacker's from the same start [s]. ``against_first`` compares with the first
    attacker, ``against_half_speed`` with the same one against the goalkeeper at half speed.
    """

    goals: int
    rate: float
    low: float | None
    high: float | None
    interval: str
    attempts: int
    distinct: int
    outcomes: dict[str, int]
    time_to_shot: float | None
    waiting: float | None
    errors: int
    against_first: Against | None
    against_half_speed: Against | None
    paper: Published | None


class Cell(TypedDict):
    """One situation and all attackers in it."""

    goalkeeper: str
    speed: str
    starts: str
    defenders: int
    attackers: dict[str, Attacker]


class Deployed(TypedDict):
    """All of it."""

    shots: int
    seed: int
    cells: list[Cell]


def deployed(
    shots: int = 100,
    seed: int = SEED,
    workers: int = 1,
    *,
    situations: Sequence[Situation] = SITUATIONS,
    attackers: Sequence[str] = tuple(ATTACKERS),
    progress: Callable[[], object] = lambda: None,
    world: WorldFactory = sim_world,
    out: Path | None = None,
) -> Deployed:
    """Play every attacker in every situation.

    Trial n of every attacker starts from the same places with the same seed, against
    the goalkeeper at half and at full speed alike.

    Args:
        shots: number of trials of each.
        seed: seed of the trials.
        workers: number of processes.
        situations: what they face.
        attackers: some of :data:`ATTACKERS`.
        progress: called after every trial.
        world: where it is played; one of the league takes one worker.
        out: folder that keeps the trials as they finish; those that it holds are not played again.

    Raises:
        ResultsFileError: the folder holds trials of other settings.
        ScenarioError: a play cannot be made, as where a model is missing.
    """

    def played(_: MatchResult) -> None:
        progress()

    cells: list[Cell] = []
    at_half_speed: dict[tuple[object, ...], list[MatchResult]] = {}
    for situation in situations:
        first: list[MatchResult] | None = None
        found: dict[str, Attacker] = {}
        for name in attackers:
            scenario = deployed_scenario(situation, name)
            kept = None if out is None else out / f"{_file_name(situation, name)}.jsonl"
            results = run_trials_in(scenario, world, shots, workers, seed, kept, on_result=played).results
            first = results if first is None else first
            published = PAPER[situation.speed].get(name) if not situation.defenders else None
            match = (name, situation.goalkeeper, situation.starts, situation.defenders)
            if situation.speed == "half":
                at_half_speed[match] = results
            slower = at_half_speed.get(match) if situation.speed == "full" else None
            found[name] = _figures(results, first, slower, published)
        cells.append(
            Cell(
                goalkeeper=situation.goalkeeper,
                speed=situation.speed,
                starts=situation.starts,
                defenders=situation.defenders,
                attackers=found,
            )
        )
    return {"shots": shots, "seed": seed, "cells": cells}


def _file_name(situation: Situation, attacker: str) -> str:
    return re.sub(r"[^\w.]+", "-", f"{situation} {attacker}")


def deployed_scenario(situation: Situation, attacker: str) -> Scenario:
    """Return the shipped scenario with another attacker, goalkeeper, start and defenders."""
    scenario = load_scenario(f"deployed_{situation.speed}")
    scenario = scenario.with_robot("yellow 0", play=_place(GOALKEEPERS[situation.goalkeeper]))
    if situation.starts == STARTS[1]:
        start = {"around": "their goal", "distance": (2.5, 4.5), "bearing": (0.65 * pi, 1.35 * pi)}
        scenario = scenario.with_robot(
            _SHOOTER, start={"position": start, "heading": "towards goal"}, max_distance=None
        )
    if situation.defenders:
        scenario = _defended(scenario, situation.defenders)
    changes = ATTACKERS[attacker]
    return scenario.with_robot(_SHOOTER, **{**changes, "play": _place(str(changes["play"]))})


def _place(play: str) -> str:
    """Return a play's name, behind its file where the file is not in robobt."""
    return f"{relpath(_ROBOBULLS)}:{play}" if play.startswith("robobulls_") else play


def _defended(scenario: Scenario, count: int) -> Scenario:
    x, y = _WALL
    defenders = [
        RobotSetup.model_validate(
            {
                "number": place + 1,
                "play": "defender",
                "params": {"place": place, "size": count},
                "start": {"position": (x, y * (count - 1 - 2 * place)), "heading": "towards ball"},
            }
        )
        for place in range(count)
    ]
    robots = scenario.robots.model_copy(update={"yellow": (*scenario.robots.yellow, *defenders)})
    return scenario.model_copy(update={"robots": robots}).lasting(_CLOCK)


def _figures(
    results: Sequence[MatchResult],
    baseline: Sequence[MatchResult],
    slower: Sequence[MatchResult] | None,
    paper: tuple[int, int] | None,
) -> Attacker:
    goals = _goals(results)
    interval = Rate.of(goals, [result.trace for result in results])
    times = [result.robots[_SHOOTER].total for result in results]
    longer = [
        time - before
        for time, before in zip(times, [one.robots[_SHOOTER].total for one in baseline], strict=True)
        if time is not None and before is not None
    ]
    return {
        "goals": sum(goals),
        "rate": sum(goals) / len(goals),
        "low": interval.low,
        "high": interval.high,
        "interval": interval.interval(),
        "attempts": sum(time is not None for time in times),
        "distinct": len({result.trace for result in results}),
        "outcomes": dict(Counter(result.outcome for result in results).most_common()),
        "time_to_shot": _mean(time for time in times if time is not None),
        "waiting": _mean(longer),
        "errors": sum(result.robots[_SHOOTER].errors for result in results),
        "against_first": None if results is baseline else _against(goals, _goals(baseline)),
        "against_half_speed": None if slower is None else _against(goals, _goals(slower)),
        "paper": None if paper is None else {"goals": paper[0], "shots": paper[1]},
    }


def _goals(results: Iterable[MatchResult]) -> list[bool]:
    return [result.outcome == _GOAL for result in results]


def _against(this: Sequence[bool], other: Sequence[bool]) -> Against:
    test = mcnemar(this, other)
    return {"only_this": test.only_first, "only_other": test.only_second, "p": test.p}


def _mean(values: Iterable[float]) -> float | None:
    listed = list(values)
    return fmean(listed) if listed else None
