"""How well the team plays where its robots obey late, beside itself where they do not."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import partial
from statistics import fmean
from typing import Annotated, Any

import typer

from benchmarks.late_commands import LateCommands
from robobt.cli.common import MAX_SEED, Json, Progress, Workers, console, cores, print_json, table
from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.match.loop import MatchLoop
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.sim import SimWorld
from robobt.statistics import mean_interval
from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.measured_prediction import MeasuredWorld
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import World, WrappedWorld
from robobt.world.state import Frame, RobotId, RobotState
from robobt.worlds import scenario_settings

ARMS = ("+0", "measured", "known", "unknown")
"""The team without extra delay, and with it: measured, known from the start, or not reckoned with."""

_Task = tuple[str, str, float, float, int]
"""Scenario, arm, extra delay, length of a match [s] and seed."""


class LateTeamError(RobobtError, RuntimeError):
    """A match could not be played."""


class _Sides(Frame):
    """What blue reckons with, and what yellow sees, which is not late."""

    __slots__ = ("yellow",)
    yellow: Frame

    def seen_by(self, team: Team) -> Frame:
        """Return the view of a team."""
        if team is Team.BLUE:
            return Frame.seen_by(self, team)
        self.yellow.game = self.game
        return self.yellow.seen_by(team)


class _LateBlue(LateCommands):
    """A field on which blue robots obey late, and are shown to both teams as they are."""

    def __init__(self, field: SimWorld, extra: float) -> None:
        super().__init__(field, lambda robot, _: extra if robot.team is Team.BLUE else 0.0, parts=1)


def _coasting(robot: RobotState, seconds: float) -> RobotState:
    """Return where a robot whose commands are unknown will be after a time [s]."""
    x, y = robot.x + seconds * robot.vx, robot.y + seconds * robot.vy
    return replace(robot, x=x, y=y, heading=wrap_angle(robot.heading + seconds * robot.omega))


class _Known(PredictedWorld):
    """Blue reckons with a delay that it knows; of yellow's commands it knows nothing."""

    def __init__(self, world: World, extra: float) -> None:
        super().__init__(world, 0.0)
        self._extra = extra

    def _moved(self, robot: RobotId, seen: RobotState) -> RobotState:
        return super()._moved(robot, seen) if robot.team is Team.BLUE else _coasting(seen, self._extra)

    def _orders(self, robot: RobotId, limits: RobotLimits) -> list[tuple[float, RobotCommand]]:
        return super()._orders(robot, limits) if robot.team is Team.BLUE else []

    def _delay(self, robot: RobotId, limits: RobotLimits) -> float:  # noqa: ARG002
        return self._extra

    def _ball_age(self, robots: tuple[RobotState, ...]) -> float:  # noqa: ARG002
        return self._extra


class _Measured(MeasuredWorld):
    """Blue reckons with the delays that it measures; of yellow's commands it knows nothing."""

    def _moved(self, robot: RobotId, seen: RobotState) -> RobotState:
        if robot.team is Team.BLUE:
            return super()._moved(robot, seen)
        # Blue's robots have been moved before.
        return _coasting(seen, self._ball_age(()))

    def _orders(self, robot: RobotId, limits: RobotLimits) -> list[tuple[float, RobotCommand]]:
        return super()._orders(robot, limits) if robot.team is Team.BLUE else []


class _ForBlueOnly(WrappedWorld):
    """Shows blue a predicted world, and yellow the true one."""

    def observe(self) -> Frame:
        """See :meth:`robobt.world.World.observe`."""
        blue = self.world.observe()
        sides = _Sides(**{it.name: getattr(blue, it.name) for it in fields(blue)})
        sides.yellow = self.world.truth()
        return sides


def _world(scenario: Scenario, arm: str, extra: float) -> World:
    settings = scenario_settings(scenario)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    field = SimWorld(scenario.field, limits, settings, scenario.period)
    if arm == "+0":
        return field
    late = _LateBlue(field, extra)
    if arm == "measured":
        return _ForBlueOnly(_Measured(late, DelayWatch(settings.limits, limits)))
    return _ForBlueOnly(_Known(late, extra)) if arm == "known" else late


def _goals(task: _Task, _: object) -> tuple[str, int, int, int]:
    """Return arm, seed and both teams' goals."""
    name, arm, extra, seconds, seed = task
    scenario = load_scenario(name).lasting(seconds)
    result = MatchLoop(scenario, trial_seed(seed, 0), partial(_world, arm=arm, extra=extra)).play()
    return arm, seed, result.blue_score, result.yellow_score


def late_team(
    matches: Annotated[int, typer.Option("--matches", min=1, max=200, help="Of each arm.")] = 8,
    seconds: Annotated[float, typer.Option("--seconds", min=10, max=3600, help="Of a match [s].")] = 300.0,
    extra: Annotated[float, typer.Option("--extra", min=0, max=0.2, help="Extra delay [s].")] = 0.1,
    arms: Annotated[list[str] | None, typer.Option("--only", help="An arm's name.")] = None,
    scenario: Annotated[str, typer.Option("--scenario", help="Blue's robots are late in it.")] = (
        "team_v_baseline"
    ),
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    """Let the team play with and without extra delay against the team of November 2026, which has none.

    Keys of --json: scenario, seconds, extra, seed; arms: by name, goals and against (one entry a match),
    mean, low and high (of goals; 95 % interval, null for one match), and share (of the goals of the team
    without delay, from the means).
    """
    names = list(arms or ARMS[:2])
    tasks: list[_Task] = [
        (scenario, arm, extra, seconds, seed + number) for number in range(matches) for arm in names
    ]
    found: dict[str, list[tuple[int, int]]] = {name: [] for name in names}
    work: Work[_Task, None, tuple[str, int, int, int]] = Work(_goals, "match", LateTeamError)
    with Progress("playing", len(tasks)) as progress:
        played = []
        for one in run_tasks(work, tasks, workers or min(cores(), len(tasks))):
            played.append(one)
            progress.advance()
    for arm, _, own, theirs in sorted(played):
        found[arm].append((own, theirs))
    figures = {name: _summed(goals, found.get(ARMS[0])) for name, goals in found.items()}
    if as_json:
        print_json({"scenario": scenario, "seconds": seconds, "extra": extra, "seed": seed, "arms": figures})
        return
    shown = table("team", "matches", "goals a match", "against", "share")
    for name, it in figures.items():
        goals, against = found[name], fmean(theirs for _, theirs in found[name])
        share = "" if it["share"] is None else f"{it['share']:.0%}"
        interval = f"{it['mean']:.2f}"
        if it["low"] is not None:
            interval += f" ({it['low']:.2f} to {it['high']:.2f})"
        shown.add_row(name, str(len(goals)), interval, f"{against:.2f}", share)
    console.print(shown)


def _summed(goals: list[tuple[int, int]], undelayed: list[tuple[int, int]] | None) -> dict[str, Any]:
    own = [ours for ours, _ in goals]
    low, high = mean_interval(own) if len(own) > 1 else (None, None)
    best = fmean(ours for ours, _ in undelayed) if undelayed else 0.0
    return {
        "goals": own,
        "against": [theirs for _, theirs in goals],
        "mean": fmean(own),
        "low": low,
        "high": high,
        "share": fmean(own) / best if best > 0.0 else None,
    }
