"""How exactly each robot's delay is measured while six play six, and how soon a change is followed."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer

from benchmarks.late_commands import PARTS, LateCommands
from robobt.cli.common import MAX_SEED, Json, Progress, Workers, console, cores, print_json, say, table
from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.match.loop import MatchLoop
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.sim import SimWorld
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import SimSettings
from robobt.statistics import wilson_interval
from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.measured_prediction import MeasuredWorld
from robobt.world.protocol import World
from robobt.world.state import RobotId
from robobt.worlds import scenario_settings

_SHORTEST, _LONGEST = 0.02, 0.15
_JUMP, _JUMPS_AT = 0.04, 12.0
_JITTER, _LOST = 0.01, 0.03
_KNOWN_AFTER, _FOLLOWED_AFTER = 10.0, 3.0
_BAR, _95 = 0.005, 1.96
"""Delays and jumps of a match, when they are judged and how [s]; share of commands that are lost."""

_NOISE = RealismSettings(
    robot_noise=0.0013, heading_noise=0.01, missing_robot=0.02, ball_noise=0.0014, missing_ball=0.05
)


class DelayError(RobobtError, RuntimeError):
    """A match could not be played."""


class _Miss(NamedTuple):
    """By how much each delay is measured too long, and its standard error [s]; NaN if not seen enough."""

    error: FloatArray
    own_error: FloatArray


class _Link:
    """Each robot's delay, which jumps once; ``own`` are the robots' own dead times [s]."""

    def __init__(self, own: dict[RobotId, float], seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.own = own
        first = rng.uniform(_SHORTEST, _LONGEST, len(own))
        # After the jump, too, no delay lies outside the range.
        forced = np.where(first + _JUMP > _LONGEST, -1.0, np.where(first - _JUMP < _SHORTEST, 1.0, 0.0))
        way = np.where(forced == 0.0, rng.choice([-1.0, 1.0], len(own)), forced)
        self._first: dict[RobotId, float] = dict(zip(own, first.tolist(), strict=True))
        self._jump: dict[RobotId, float] = dict(zip(own, (_JUMP * way).tolist(), strict=True))

    def delay(self, robot: RobotId, time: float) -> float:
        return self._first[robot] + (self._jump[robot] if time >= _JUMPS_AT else 0.0)

    def missed(self, world: World, time: float) -> _Miss:
        measured = world.delays()
        known = [measured.get(robot) for robot in self.own]
        truth = [own + self.delay(robot, time) for robot, own in self.own.items()]
        seconds = np.array([np.nan if it is None else it.seconds for it in known])
        errors = np.array([np.nan if it is None else it.error for it in known])
        return _Miss(np.subtract(seconds, truth), errors)


def _world(scenario: Scenario, link: _Link, settings: SimSettings) -> World:
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    field = SimWorld(scenario.field, limits, settings, scenario.period / PARTS)
    late = LateCommands(field, link.delay, _JITTER, _LOST)
    return MeasuredWorld(late, DelayWatch(settings.limits, limits), gaps=True)


def _measured(task: tuple[int, str], _: object) -> tuple[_Miss, _Miss]:
    """Return what is missed after 10 s, and 3 s after the delays have jumped."""
    seed, preset = task
    scenario = load_scenario("six_v_six").lasting(_JUMPS_AT + _FOLLOWED_AFTER + 1.0)
    settings = scenario_settings(scenario, preset)
    late = settings.realism.command_delay
    settings = settings.model_copy(update={"realism": _NOISE.model_copy(update={"command_delay": late})})
    setups = sorted(scenario.robots, key=lambda pair: pair[0])
    link = _Link({robot: it.limits_over(settings.limits).obeys_after(late) for robot, it in setups}, seed)
    moments = [round(time / scenario.period) for time in (_KNOWN_AFTER, _JUMPS_AT + _FOLLOWED_AFTER)]
    misses = []
    with MatchLoop(scenario, seed, partial(_world, link=link, settings=settings)) as match:
        for tick in range(moments[-1] + 1):
            match.tick()
            if tick in moments:
                misses.append(link.missed(match.world, tick * scenario.period))
    known, followed = misses
    return known, followed


def _cost() -> float:
    """Return how long the delays of 16 robots take at 60 Hz [ms a tick]."""
    robots = [RobotId(team, number) for team in Team for number in range(8)]
    watch, taken = DelayWatch(), []
    for tick in range(400):
        time = tick / 60
        command = RobotCommand(
            float(np.sin(time)), float(np.cos(2.0 * time)), 2.0 * float(np.sin(3.0 * time))
        )
        start = perf_counter()
        watch.sent(time, dict.fromkeys(robots, command))
        for robot in robots:
            watch.see(robot, time + 0.001, 0.1 * float(np.sin(time)), 0.0, 0.0)
        taken.append(perf_counter() - start)
    return 1e3 * float(np.median(taken))


def delay_in_play(
    matches: Annotated[int, typer.Option("--matches", min=1, max=1000)] = 10,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    preset: Annotated[str, typer.Option("--simulator", help="A preset.")] = "default",
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    """Measure delays of 20 to 150 ms with 10 ms of jitter and 3 % of the commands lost, in six against six.

    Each robot's delay is drawn; after 12 s it jumps by 40 ms. The robots' detections have the noise and gaps
    of ER-Force's level Realistic.

    Keys of --json: matches, seed, simulator; known (after 10 s) and followed (3 s after the jump): robots,
    unseen (not seen enough), within (share within 5 ms, of all robots), within_low, within_high (95 % Wilson
    interval), rms, median and largest (s), covered, covered_low, covered_high (share of intervals that hold
    the truth, of those measured); cost_ms (of 16 robots, a tick).
    """
    tasks = [(seed + number, preset) for number in range(matches)]
    known: list[_Miss] = []
    followed: list[_Miss] = []
    work: Work[tuple[int, str], None, tuple[_Miss, _Miss]] = Work(_measured, "match", DelayError)
    with Progress("playing", matches) as progress:
        for before, after in run_tasks(work, tasks, workers or min(cores(), matches)):
            known.append(before)
            followed.append(after)
            progress.advance()
    figures: dict[str, Any] = {"matches": matches, "seed": seed, "simulator": preset}
    figures |= {"known": _summed(known), "followed": _summed(followed), "cost_ms": _cost()}
    if as_json:
        print_json(figures)
        return
    shown = table(
        "", "robots", "not seen enough", "within 5 ms", "RMS", "median", "largest", "interval holds"
    )
    for name, title in (("known", "after 10 s"), ("followed", "3 s after a jump of 40 ms")):
        it = figures[name]
        shown.add_row(
            title,
            str(it["robots"]),
            str(it["unseen"]),
            f"{it['within']:.1%} ({it['within_low']:.1%} to {it['within_high']:.1%})",
            *[f"{1e3 * it[key]:.1f} ms" for key in ("rms", "median", "largest")],
            f"{it['covered']:.1%} ({it['covered_low']:.1%} to {it['covered_high']:.1%})",
        )
    console.print(shown)
    say(f"16 robots take {figures['cost_ms']:.2f} ms a tick.")


def _summed(misses: list[_Miss]) -> dict[str, Any]:
    errors = np.concatenate([it.error for it in misses])
    seen = np.isfinite(errors)
    own = np.concatenate([it.own_error for it in misses])[seen]
    size = np.abs(errors[seen])
    within, covered = int((size < _BAR).sum()), int((size < _95 * own).sum())
    low, high = wilson_interval(within, len(errors))
    covered_low, covered_high = wilson_interval(covered, len(size))
    return {
        "robots": len(errors),
        "unseen": int((~seen).sum()),
        "within": within / len(errors),
        "within_low": low,
        "within_high": high,
        "rms": float(np.sqrt(np.mean(size**2))),
        "median": float(np.median(size)),
        "largest": float(size.max()),
        "covered": covered / len(size),
        "covered_low": covered_low,
        "covered_high": covered_high,
    }
