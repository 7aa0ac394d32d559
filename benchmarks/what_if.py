"""What-if: how fast branches are, whether they are calibrated, and whether a planted mistake is found."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from statistics import fmean
from typing import Annotated, Any

import numpy as np
import typer

from robobt.cli import MAX_SEED, Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.match.scenario.changes import changed
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.statistics import clopper_pearson_interval, wilson_interval
from robobt.what_if import Branches, LoggedMatch, load_logged, promising_moments, scan
from robobt.what_if.moments import moments_of
from robobt.what_if.standing import standing
from robobt.world.game import Team
from robobt.world.rules import owner
from robobt.world.state import RobotId
from robobt.worlds import play_match

PLANTED = Path(__file__).with_name("planted_mistake.py")

TRIALS, OUTSIDE = 39, 2
"""Branches of a moment, and the rank from either end that bounds their 90 % interval: 36 of 40 gaps."""

GOOD_CHANCE, EARLIEST = 0.3, 5.0
"""Chance of a shot from which a robot that has the ball makes its mistake, and from when on [s]."""

HELD = 0.2
"""Time for which the robot has had the ball before its mistake [s]."""

COST, COST_TRIALS = 0.3, (8, 24)
"""Expected goals that a mistake costs at least, and in how many pairs of branches, first and once more."""

OTHER_BRANCHES = 1_000_000
"""Added to the seed of a scan's branches for those from which the cost of a mistake comes."""

SEARCHED, LONG_ENOUGH = 45.0, 30.0
"""Length of the matches in which a good chance is looked for, and least length of those scanned [s]."""

FOUND_WITHIN = 1.0
"""A moment counts as that of the mistake up to this long before and after [s]."""

_ROUNDING = 1e-3
"""Places in recordings are rounded [m]."""


def what_if(
    matches: Annotated[int, typer.Option(min=1, help="How many matches to take moments from.")] = 3,
    seconds: Annotated[float, typer.Option(min=5.0, help="How long each of them lasts [s].")] = 120.0,
    moments: Annotated[int, typer.Option(min=0, help="How many moments to check the intervals at.")] = 30,
    mistakes: Annotated[
        int, typer.Option(min=0, help="How many matches with a planted mistake to scan.")
    ] = 0,
    branches: Annotated[int, typer.Option(min=1, help="How many branches to time.")] = 100,
    seed: Annotated[int, typer.Option(min=0, max=MAX_SEED, help="Seed of the first match.")] = 9800,
    as_json: Json = False,
) -> None:
    """Measure what-if on matches of six a side.

    speed: branches of three seconds a CPU minute, without and with setting their moments up, and beside them
    how fast the last match itself was played and recorded. coverage: in how many moments what really followed
    lies inside the 90 % interval of branches in which nothing changed, for the ball's place at the end and
    for expected goals. mistakes: matches in which a robot with a good chance gives the ball to an opponent;
    cost: expected goals that this costs, from branches of the match with the mistake that the scan does not
    see; place: the mistake's place in the list of the scan, 0 if it is not there; cpu_s: of the scan.
    """
    found: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        logged, taken = [], 0.0
        for number in range(matches):
            began = time.process_time()
            logged.append(recorded(Path(folder), six_a_side(seconds), seed + number))
            taken = time.process_time() - began
        found["speed"] = measure_speed(logged[0], branches)
        found["speed"]["seconds of a match a CPU second"] = seconds / taken
        if moments:
            found["coverage"] = measure_coverage(logged, moments, seed)
        if mistakes:
            found["mistakes"] = find_mistakes(Path(folder), mistakes, seed + 1000, tell)
    if as_json:
        print_json(found)
        return
    for name, value in found["speed"].items():
        say(f"{name}: {value:.0f}" if value > 10 else f"{name}: {value:.2f}")
    if moments:
        listed = table("what followed", "inside", "95 %")
        for name, one in found["coverage"].items():
            listed.add_row(
                name, f"{one['inside']} of {one['moments']}", f"{one['low']:.0%} to {one['high']:.0%}"
            )
        console.print(listed)
    if mistakes:
        places = [one["place"] for one in found["mistakes"]]
        early = sum(0 < place <= 3 for place in places)
        low, high = wilson_interval(early, len(places))
        share = f"{early} of {len(places)} ({low:.0%} to {high:.0%})"
        say(f"mistakes in the first three: {share}; places {places}")


def tell(text: str) -> None:
    """Print a line on stderr."""
    errors.print(text, highlight=False)


def six_a_side(seconds: float) -> Scenario:
    """Return the scenario of the matches."""
    return changed(load_scenario("six_v_six"), {"ends.time_limit": seconds})


def recorded(folder: Path, scenario: Scenario, seed: int) -> LoggedMatch:
    """Play and record a match, and load it."""
    path = folder / f"{seed}.robobt.arrows"
    play_match(scenario, seed, record=path)
    return load_logged(path)


def measure_speed(logged: LoggedMatch, branches: int) -> dict[str, float]:
    """Return how many branches of three seconds a CPU minute plays, from ten moments all over a match."""
    played = Branches(logged)
    there = moments_of(logged, Team.BLUE, 1.0)
    ticks = [there[place][0] for place in np.linspace(0, len(there) - 1, 10).astype(int)]
    played.begin(ticks[0])
    played.play(0, 0, follow=[Team.YELLOW])
    lasted = setting_up = 0.0
    each = max(1, branches // len(ticks))
    began = time.process_time()
    for tick in ticks:
        before = time.process_time()
        played.begin(tick)
        setting_up += time.process_time() - before
        for trial in range(each):
            lasted += played.play(1, trial, follow=[Team.YELLOW]).lasted
    taken, count = time.process_time() - began, each * len(ticks)
    played.close()
    return {
        "branches": count,
        "seconds of a branch": lasted / count,
        "branches of 3 s a CPU minute": 20.0 * lasted / (taken - setting_up),
        "and with setting up": 20.0 * lasted / taken,
    }


def measure_coverage(matches: Iterable[LoggedMatch], moments: int, seed: int) -> dict[str, dict[str, float]]:
    """Return how often what followed lies in the 90 % interval of branches in which nothing changed."""
    there = [(match, tick) for match in matches for tick, _ in moments_of(match, Team.BLUE, 0.5)]
    chosen = np.random.default_rng(seed).permutation(len(there))[:moments]
    inside = {"ball x": 0, "ball y": 0, "expected goals": 0}
    players: dict[int, Branches] = {}
    for place in sorted(chosen.tolist()):
        match, tick = there[place]
        played = players.setdefault(id(match), Branches(match))
        played.begin(tick)
        branches = [played.play(seed, trial, follow=[Team.YELLOW]) for trial in range(TRIALS)]
        really = played.really()
        pairs = {
            "ball x": ([one.ball[0] for one in branches], really.ball[0]),
            "ball y": ([one.ball[1] for one in branches], really.ball[1]),
            "expected goals": ([one.value(Team.BLUE) for one in branches], really.value(Team.BLUE)),
        }
        told = []
        for name, (sample, value) in pairs.items():
            ranked = sorted(sample)
            low, high = ranked[OUTSIDE - 1] - _ROUNDING, ranked[-OUTSIDE] + _ROUNDING
            inside[name] += low <= value <= high
            told.append(f"{name} {value:.2f} ({low:.2f} to {high:.2f})")
        tell(f"{match.recording.times[tick]:.2f} s: {', '.join(told)}")
    for played in players.values():
        played.close()
    counted = len(chosen)
    return {
        name: {"inside": count, "moments": counted, **clopper_pearson_interval(count, counted)._asdict()}
        for name, count in inside.items()
    }


def good_chances(logged: LoggedMatch) -> list[tuple[float, RobotId]]:
    """Return when blue field players come to a good chance, once each time one has the ball, and who."""
    rater = ExpectedGoal(goalkeeper="fitted")
    since: tuple[float, RobotId] | None = None
    found: list[tuple[float, RobotId]] = []
    for tick in range(len(logged.recording)):
        frame = logged.recording.frame(tick)
        holder = owner(frame) if frame.game.in_play else None
        if holder is None or holder.team is not Team.BLUE or holder.number == 0:
            since = None
        elif since is None or since[1] != holder:
            since = frame.time, holder
        elif (
            frame.time >= EARLIEST
            and frame.time - since[0] >= HELD
            and standing(frame, rater, Team.BLUE) >= GOOD_CHANCE
        ):
            found.append((frame.time, holder))
            # Once only, until somebody else has the ball or nobody.
            since = float("inf"), holder
    return found


def mistaken(scenario: Scenario, robot: RobotId, at: float) -> Scenario:
    """Return the scenario in which a robot makes its mistake at a time [s]."""
    return changed(scenario, {f"{robot}.play": f"{PLANTED}:mistaken_player", f"{robot}.at": at})


def costly_mistake(folder: Path, seed: int) -> tuple[LoggedMatch, float, RobotId, float] | None:
    """Return a match with a mistake that costs something, when, whose it is, and what it costs.

    What a mistake costs is the mean difference of pairs of branches of the match with the mistake, in which
    the robot plays on or makes it [expected goals]. It has to reach :data:`COST` in two sets of branches,
    neither of which a search sees; the second one's mean is returned.
    """
    without = recorded(folder, six_a_side(SEARCHED), seed)
    for at, robot in good_chances(without):
        logged = recorded(folder, mistaken(six_a_side(max(LONG_ENOUGH, at + 6.0)), robot, at), seed)
        right, wrong = Branches(logged, without.scenario), Branches(logged)
        for played in (right, wrong):
            played.begin(logged.tick(at))
        cost, first = 0.0, 0
        for trials in COST_TRIALS:
            values = [
                [
                    played.play(OTHER_BRANCHES + seed, trial, follow=[Team.YELLOW]).value(Team.BLUE)
                    for played in (right, wrong)
                ]
                for trial in range(first, first + trials)
            ]
            cost, first = fmean(good - bad for good, bad in values), first + trials
            if cost < COST:
                break
        right.close()
        wrong.close()
        if cost >= COST:
            return logged, at, robot, cost
    return None


def find_mistakes(
    folder: Path, count: int, seed: int, tell: Callable[[str], object]
) -> list[dict[str, object]]:
    """Scan matches with a planted mistake, and return at which place of the list each mistake is.

    Args:
        folder: for recordings.
        count: how many matches.
        seed: seed of the first match that is tried; those without a mistake that costs something in
            :data:`SEARCHED` are left out.
        tell: takes a line about each match.
    """
    found: list[dict[str, object]] = []
    while len(found) < count:
        seed += 1
        mistake = costly_mistake(folder, seed)
        if mistake is None:
            continue
        logged, at, robot, cost = mistake
        began = time.process_time()
        played = Branches(logged)
        there = promising_moments(logged, Team.BLUE, 1.0)
        moments = scan(logged, Team.BLUE, played, there, count=5, trials=16, first=2, seed=seed)
        played.close()
        taken = time.process_time() - began
        near = [abs(one.time - at) <= FOUND_WITHIN for one in moments]
        place = near.index(True) + 1 if any(near) else 0
        tell(
            f"seed {seed}: {robot} at {at:.2f} s costs {cost:.2f}, place {place} of {len(moments)}, "
            f"{taken:.0f} CPU s: "
            + "; ".join(f"{one.time:.2f} s {one.decision.name} {one.gain:+.2f}" for one in moments)
        )
        found.append(
            {"seed": seed, "at": at, "robot": str(robot), "cost": cost, "place": place, "cpu_s": taken}
        )
    return found
