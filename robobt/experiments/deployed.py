"""The deployed raters: Attack Main, AttackNN and Attack Expected against one goalkeeper, on paired seeds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from statistics import fmean
from typing import TypedDict

from robobt.experiments.goal_map import draw_goal_line
from robobt.match.loop import Match, WorldFactory
from robobt.match.results.results import MatchResult
from robobt.match.runner import run_trials, trial_seed
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.skills.aim.raters.nn_filtered import NNFiltered
from robobt.statistics import clopper_pearson_interval, mcnemar, wilson_interval
from robobt.worlds import sim_world

PLAYED = ("attack_main", "attack_nn", "attack_expected")
"""Who attacks, the baseline first."""

PAPER: dict[str, dict[str, tuple[int, int]]] = {
    "half": {"attack_main": (28, 100), "attack_nn": (80, 100)},
    "full": {"attack_main": (19, 50), "attack_nn": (35, 50)},
}
"""The paper's goals and shots, by the goalkeeper's speed and the play."""

SEED = 2026
"""Of the shots reported; nothing was tuned on them."""

_SHOOTER, _GOAL = "blue 0", "goal_blue"


class Against(TypedDict):
    """McNemar's test against the first play: trials that only one of them scored in, and two-sided p."""

    only_this: int
    only_first_play: int
    p: float


class Published(TypedDict):
    """The paper's goals and shots."""

    goals: int
    shots: int


class Attacker(TypedDict):
    """One attacker's figures.

    The rate has its 95 % Wilson interval (``low``, ``high``) and the exact one. ``attempts`` are
    the trials in which it shot, ``time_to_shot`` the mean time from the start to the kick [s],
    ``waiting`` the mean of what that takes longer than the first play's from the same start [s].
    """

    goals: int
    rate: float
    low: float
    high: float
    exact_low: float
    exact_high: float
    attempts: int
    outcomes: dict[str, int]
    time_to_shot: float | None
    waiting: float | None
    errors: int
    mcnemar: Against | None
    paper: Published | None


class Deployed(TypedDict):
    """All attackers, by the goalkeeper's speed and then by play."""

    shots: int
    seed: int
    goalkeeper: str
    speeds: dict[str, dict[str, Attacker]]


def deployed(
    shots: int = 100,
    seed: int = SEED,
    workers: int = 1,
    *,
    speeds: Sequence[str] = ("half", "full"),
    plays: Sequence[str] = PLAYED,
    goalkeeper: str = "default",
    progress: Callable[[], object] = lambda: None,
    world: WorldFactory = sim_world,
) -> Deployed:
    """Play every attacker against the goalkeeper at every speed.

    Trial n of every play starts from the same places with the same seed.

    Args:
        shots: number of trials of each.
        seed: seed of the trials.
        workers: number of processes.
        speeds: speeds of the goalkeeper, "half" and "full" (scenarios ``deployed_half``, ``deployed_full``).
        plays: names of plays that take ``max_distance`` and ``shot_speed``.
        goalkeeper: its style: "default" moves as fast as its robot can and covers the
            angle; "robobulls" with the paper's own pilot.
        progress: called after every trial.
        world: where it is played; one of the league takes one worker.

    Raises:
        ScenarioError: a play does not take those parameters.
    """

    def played(_: MatchResult) -> None:
        progress()

    found: dict[str, dict[str, Attacker]] = {}
    for speed in speeds:
        first: list[MatchResult] | None = None
        found[speed] = {}
        for play in plays:
            scenario = deployed_scenario(speed, play, goalkeeper)
            results = run_trials(scenario, world, shots, workers, seed, on_result=played).results
            first = results if first is None else first
            found[speed][play] = _figures(results, first, PAPER.get(speed, {}).get(play))
    return {"shots": shots, "seed": seed, "goalkeeper": goalkeeper, "speeds": found}


def deployed_scenario(speed: str, play: str, goalkeeper: str = "default") -> Scenario:
    """Return the shipped scenario with another attacker and goalkeeper's style."""
    scenario = load_scenario(f"deployed_{speed}")
    return scenario.with_robot("yellow 0", style=goalkeeper).with_robot(_SHOOTER, play=play)


def _figures(
    results: list[MatchResult], baseline: list[MatchResult], paper: tuple[int, int] | None
) -> Attacker:
    goals = [result.outcome == _GOAL for result in results]
    interval = wilson_interval(sum(goals), len(goals))
    exact = clopper_pearson_interval(sum(goals), len(goals))
    times = [result.robots[_SHOOTER].total for result in results]
    longer = [
        time - before
        for time, before in zip(times, [one.robots[_SHOOTER].total for one in baseline], strict=True)
        if time is not None and before is not None
    ]
    against: Against | None = None
    if results is not baseline:
        test = mcnemar(goals, [result.outcome == _GOAL for result in baseline])
        against = {"only_this": test.only_first, "only_first_play": test.only_second, "p": test.p}
    return {
        "goals": sum(goals),
        "rate": sum(goals) / len(goals),
        "low": interval.low,
        "high": interval.high,
        "exact_low": exact.low,
        "exact_high": exact.high,
        "attempts": sum(time is not None for time in times),
        "outcomes": dict(Counter(result.outcome for result in results).most_common()),
        "time_to_shot": _mean(time for time in times if time is not None),
        "waiting": _mean(longer),
        "errors": sum(result.robots[_SHOOTER].errors for result in results),
        "mcnemar": against,
        "paper": None if paper is None else {"goals": paper[0], "shots": paper[1]},
    }


def _mean(values: Iterable[float]) -> float | None:
    listed = list(values)
    return fmean(listed) if listed else None


def judged_goal_line(
    speed: str, seed: int, path: Path, goalkeeper: str = "default", world: WorldFactory = sim_world
) -> None:
    """Play ``attack_expected`` until its first shot and draw the goal line as judged at that moment.

    Raises:
        RuntimeError: it takes no shot in the first of its trials.
    """
    scenario = deployed_scenario(speed, "attack_expected", goalkeeper)
    with Match(scenario, trial_seed(seed, 0), world) as match:
        store = match.players[0].store
        while match.tick():
            if store.command.kick_speed > 0.0:
                break
        else:
            raise RuntimeError("attack_expected takes no shot in this trial")
        frame, me = store.frame, store.me
    points = goal_candidates(frame.field)
    expected = ExpectedGoal().chances(frame, frame.ball.position, me, points)
    assert expected is not None
    network = NNFiltered().chances(frame, me, points)
    draw_goal_line(frame, me, {"expected_goal": expected, "nn_filtered": network}, path)
