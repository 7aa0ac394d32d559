"""Table 4 of the paper: get the ball and shoot, with hand-written and learned skills in every combination."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import fmean, stdev

from pydantic import ConfigDict

from robobt.experiments.table4_rows import (
    PAPER,
    Comparison,
    Minimum,
    PaperStart,
    Row,
    Spread,
    Table4,
    Trial,
)
from robobt.experiments.table4_starts import (
    LIMITS,
    SHOOTER,
    Starts,
    drawn_starts,
    gap,
    minimum_times,
    table4_scenario,
)
from robobt.match.loop import Match, WorldFactory
from robobt.match.results.file import TrialsFile
from robobt.match.results.results import Rate
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import settings_from
from robobt.skills.ball.go_to_ball import HANDOVER_DISTANCE
from robobt.statistics import mean_interval
from robobt.worlds import sim_world

TRIALS = ("1", "2")
"""The ball in the centre, and at (0, 1.5) m."""

COMBINATIONS: dict[str, dict[str, str | None]] = {
    "robobulls": {"style": "robobulls"},
    "geometric, kick": {"policy": "geometric", "shoot": "kick_to_target"},
    "geometric, kick, quick": {"policy": "geometric", "shoot": "kick_to_target", "pickup_speed": None},
    "geometric, shoot": {"policy": "geometric", "shoot": "geometric"},
    "geometric, d4pg+td3": {"policy": "geometric", "shoot": "ddpg"},
    "3-step ddpg, kick": {"policy": "ddpg", "shoot": "kick_to_target", "pickup_speed": None},
    "3-step ddpg, shoot": {"policy": "ddpg", "shoot": "geometric", "pickup_speed": None},
    "3-step ddpg, d4pg+td3": {"policy": "ddpg", "shoot": "ddpg", "pickup_speed": None},
}
"""Parameters of the play go_to_ball_and_shoot, by who approaches and who shoots.

Hand-written shots are KickToTarget ("kick") and the geometric Shoot ("shoot").

The learned approach hands over at full speed and the pick-up goes on as fast as the
dribbler takes the ball; "quick" is the hand-written approach with that pick-up.
"""

LEARNED = "3-step ddpg, d4pg+td3"
HAND_WRITTEN = ("robobulls", "geometric, kick", "geometric, kick, quick", "geometric, shoot")

HUMAN = "human, game controller"
"""The row of a person who drives the robot in the live page."""

Show = Callable[[Match], Callable[[], bool]]
"""Shows a match to somebody and returns what plays its next tick, False when it is over."""

_GOAL = "goal_blue"


@dataclass(frozen=True, slots=True)
class Attempt:
    """One run.

    Attributes:
        trial: its number, from 0.
        approach: start until robot and ball are 0.2 m apart, between two frames by their straight line [s].
        to_ball: start until the ball first lies in the mouth, as the paper counts [s].
        shoot: from then until the kick [s].
        goal: whether it went in.
        minimum: the shortest possible times from this start, as a :class:`Minimum`'s; None where the start
            was not seen.
        trace: hash over all that happened; equal for runs that repeat each other.

    Times are None for what never happened.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    trial: int
    approach: float | None
    to_ball: float | None
    shoot: float | None
    goal: bool
    minimum: dict[str, float] | None
    trace: str

    @property
    def pick_up(self) -> float | None:
        """From the end of the approach until the ball lies in the mouth [s]."""
        return None if self.approach is None or self.to_ball is None else self.to_ball - self.approach

    @property
    def total(self) -> float | None:
        """Start to kick [s]."""
        return None if self.to_ball is None or self.shoot is None else self.to_ball + self.shoot

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""
        return asdict(self)


def table4(
    runs: int = 25,
    seed: int | None = None,
    *,
    preset: str = "robobulls",
    realism: str | None = None,
    combinations: Sequence[str] = tuple(COMBINATIONS),
    limits: Sequence[str] = tuple(LIMITS),
    starts: Starts = "drawn",
    trials: Sequence[str] = TRIALS,
    progress: Callable[[], object] = lambda: None,
    world: WorldFactory = sim_world,
    out: Path | None = None,
    human: Show | None = None,
) -> Table4:
    """Play both trials with every combination.

    Run n of every combination has the same seed and start, so that differences are paired.
    Each combination has one run more, from the paper's start.

    Args:
        runs: number of runs of each.
        seed: seed of all runs; the scenarios' own by default.
        preset: preset of the simulator.
        realism: level of noise, losses and delays; by default the scenarios' own little noise.
        combinations: some of :data:`COMBINATIONS`.
        limits: some of :data:`LIMITS`.
        starts: where runs start.
        trials: some of :data:`TRIALS`.
        progress: called after every run.
        world: where it is played.
        out: folder that keeps the runs as they finish; those that it holds are not played again.
        human: lets a person drive, for one more row, which has no run from the paper's start.

    Raises:
        KeyError: no such preset, realism level, combination or limits.
        ResultsFileError: the folder holds runs of other settings.
        ScenarioError: a play cannot be made, as where a model is missing.
    """
    found: dict[str, dict[str, Trial]] = {}
    for name in limits:
        found[name] = {}
        for trial in trials:
            attempts: dict[str, list[Attempt]] = {}
            rows: dict[str, Row] = {}
            for combination in (*combinations, *([] if human is None else [HUMAN])):
                # A person needs no play, but the rest of the scenario.
                params = COMBINATIONS.get(combination, COMBINATIONS["robobulls"])
                show = human if combination == HUMAN else None
                scenario = table4_scenario(trial, params, preset, realism, LIMITS[name])
                first = scenario.seed if seed is None else seed
                drawn = drawn_starts(scenario) if starts == "drawn" else scenario
                kept = None if out is None else out / _file_name(name, trial, combination)
                attempts[combination] = _attempts(drawn, first, runs, world, kept, progress, show)
                beside = None if show else play_attempt(scenario, trial_seed(first, 0), world)
                progress()
                rows[combination] = _row_of(attempts[combination], beside)
            found[name][trial] = _trial_of(attempts, rows)
    return Table4(runs=runs, preset=preset, realism=realism, starts=starts, paper=PAPER, limits=found)


def _file_name(limits: str, trial: str, combination: str) -> str:
    return re.sub(r"[^\w.]+", "-", f"{limits} {trial} {combination}") + ".jsonl"


def _attempts(
    scenario: Scenario,
    seed: int,
    runs: int,
    world: WorldFactory,
    kept: Path | None,
    progress: Callable[[], object],
    show: Show | None = None,
) -> list[Attempt]:
    """Play a combination's runs, except for those that the file ``kept`` holds already."""
    where = getattr(world, "address", None)
    attempts = []
    with TrialsFile(Attempt, kept, scenario, seed, where) if kept is not None else nullcontext() as file:
        for run in range(runs):
            attempt = None if file is None else file.done.get(run)
            if attempt is None:
                attempt = play_attempt(scenario, trial_seed(seed, run), world, run, show)
                if file is not None:
                    file.add(attempt)
            attempts.append(attempt)
            progress()
    return attempts


def play_attempt(
    scenario: Scenario,
    seed: int,
    world: WorldFactory = sim_world,
    trial: int = 0,
    show: Show | None = None,
) -> Attempt:
    """Play one run to its end, as fast as can be or as it is shown."""
    approach: float | None = None
    with Match(scenario, seed, world) as match:
        before = match.world.truth()
        minimum: dict[str, float] | None = None
        if before.own:
            least = minimum_times(before, settings_from(scenario.simulator))
            minimum = {"to_ball": least["to_ball"], "to_kick": least["to_kick"]}
        tick = match.tick if show is None else show(match)
        while tick():
            now = match.world.truth()
            if not (now.own and before.own):
                # Over a network robots may be out of sight.
                before = now
                continue
            if approach is None and gap(now) <= HANDOVER_DISTANCE:
                way, left = gap(before) - gap(now), gap(before) - HANDOVER_DISTANCE
                share = min(1.0, max(0.0, left / way)) if way > 0.0 else 1.0
                approach = before.time + share * (now.time - before.time)
            before = now
        result = match.result()
    figures = result.robots[SHOOTER]
    goal = result.outcome == _GOAL
    return Attempt(trial, approach, figures.go_to_ball, figures.shoot, goal, minimum, result.trace)


def _row_of(attempts: Sequence[Attempt], beside: Attempt | None) -> Row:
    traces = [attempt.trace for attempt in attempts]
    return Row(
        approach=_spread(attempt.approach for attempt in attempts),
        pick_up=_spread(attempt.pick_up for attempt in attempts),
        to_ball=_spread(attempt.to_ball for attempt in attempts),
        shoot=_spread(attempt.shoot for attempt in attempts),
        total=_spread(attempt.total for attempt in attempts),
        goals=Rate.of([attempt.goal for attempt in attempts], traces),
        reached=Rate.of([attempt.to_ball is not None for attempt in attempts], traces),
        shots=Rate.of([attempt.shoot is not None for attempt in attempts], traces),
        ball_ratio=_ratio((one.to_ball, one.minimum["to_ball"]) for one in attempts if one.minimum),
        kick_ratio=_ratio((one.total, one.minimum["to_kick"]) for one in attempts if one.minimum),
        paper_start=PaperStart(to_ball=None, total=None, goal=False)
        if beside is None
        else PaperStart(to_ball=beside.to_ball, total=beside.total, goal=beside.goal),
    )


def _ratio(pairs: Iterable[tuple[float | None, float]]) -> float | None:
    known = [(time, least) for time, least in pairs if time is not None]
    return sum(time for time, _ in known) / sum(least for _, least in known) if known else None


def _spread(given: Iterable[float | None]) -> Spread:
    values = [value for value in given if value is not None]
    mean = fmean(values) if values else None
    # Runs that are all the same tell nothing of others.
    low, high = mean_interval(values) if len(set(values)) > 1 else (None, None)
    variance = stdev(values) ** 2 if len(values) > 1 else None
    return {"n": len(values), "mean": mean, "variance": variance, "low": low, "high": high}


def _trial_of(attempts: Mapping[str, Sequence[Attempt]], rows: dict[str, Row]) -> Trial:
    """Compare the learned combination with the best hand-written one: most goals, then the first kick."""
    minima = [one.minimum for played in attempts.values() for one in played if one.minimum is not None]
    minimum = None
    if minima:
        to_ball, to_kick = (fmean(one[key] for one in minima) for key in ("to_ball", "to_kick"))
        minimum = Minimum(to_ball=to_ball, to_kick=to_kick)
    times = {name: rows[name]["total"]["mean"] for name in HAND_WRITTEN if name in rows}
    kicked = {name: (-rows[name]["goals"].count, time) for name, time in times.items() if time is not None}
    best = min(kicked, key=kicked.__getitem__) if kicked else None
    found = Trial(minimum=minimum, rows=rows, best_hand_written=best, to_ball=None, to_kick=None)
    if best is not None and LEARNED in rows:
        pairs = list(zip(attempts[LEARNED], attempts[best], strict=True))
        found["to_ball"] = _compared((ours.to_ball, theirs.to_ball) for ours, theirs in pairs)
        found["to_kick"] = _compared((ours.total, theirs.total) for ours, theirs in pairs)
    return found


def _compared(pairs: Iterable[tuple[float | None, float | None]]) -> Comparison | None:
    differences = [ours - theirs for ours, theirs in pairs if ours is not None and theirs is not None]
    if not differences:
        return None
    # Times are multiples of the control period; what differs by less differs by rounding.
    mean, vary = fmean(differences), max(differences) - min(differences) > 1e-9
    low, high = mean_interval(differences) if vary else (None, None)
    effect = mean / stdev(differences) if vary else None
    return Comparison(n=len(differences), mean=mean, low=low, high=high, effect=effect)
