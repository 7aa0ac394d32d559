"""How the team plays on fields that nobody knows, with what a minute of play says about them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from statistics import fmean
from typing import Annotated, Any, NamedTuple

import typer

from benchmarks.blind.field import PERIOD, BlindField, draw_field, play, swapped
from robobt.cli.common import MAX_SEED, Json, Progress, Workers, console, cores, print_json, table
from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.identify import identify
from robobt.identify.preset_file import preset_of
from robobt.match.loop import MatchLoop
from robobt.match.scenario.changes import with_team
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.sim import SimSettings, SimWorld
from robobt.sim.settings import settings_from
from robobt.statistics import mean_interval
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import World, WrappedWorld
from robobt.world.state import Frame, RobotState

_FIELDS_A_SEED = 1000


class BlindTeamError(RobobtError, RuntimeError):
    """A field could not be identified, or a match on it not be played."""


class _Match(NamedTuple):
    """A match to play: its scenario, field, what each colour believes of it, and seed."""

    scenario: Scenario
    field: BlindField
    believed: Mapping[Team, SimSettings]
    seed: int


class _BelievedWorld(WrappedWorld):
    """A field whose robots and ball both teams take for what they identified."""

    def __init__(self, world: World, believed: Mapping[Team, SimSettings]) -> None:
        super().__init__(world)
        self._limits = {team: settings.limits for team, settings in believed.items()}
        self._ball = believed[Team.BLUE].ball.model

    def observe(self) -> Frame:
        """See :meth:`robobt.world.World.observe`."""
        seen = self.world.observe()
        own, others = self._limits[seen.team], self._limits[seen.team.other]
        return replace(
            seen,
            own=_taken_for(seen.own, own),
            opponents=_taken_for(seen.opponents, others),
            ball_model=self._ball,
        )


def _taken_for(robots: tuple[RobotState, ...], limits: RobotLimits) -> tuple[RobotState, ...]:
    return tuple([replace(robot, limits=limits) for robot in robots])


def _world(scenario: Scenario, field: BlindField, believed: Mapping[Team, SimSettings]) -> World:
    limits = {robot: field.limits[robot] for robot, _ in scenario.robots}
    world = SimWorld(scenario.field, limits, field.settings, PERIOD)
    delay = believed[Team.BLUE].realism.vision_delay
    return PredictedWorld(_BelievedWorld(world, believed), delay, gaps=True)


def _identified(task: tuple[int, bool, float], _: object) -> tuple[int, bool, SimSettings]:
    """Return what blue identifies of a field and its own robots, from seed, colours swapped, and seconds."""
    seed, change, seconds = task
    field = swapped(draw_field(seed)) if change else draw_field(seed)
    return seed, change, settings_from(preset_of(identify(play(field, seconds, seed))))


def _played(match: _Match, _: object) -> tuple[int, int, int]:
    """Return a match's field and both teams' goals."""
    make = partial(_world, field=match.field, believed=match.believed)
    result = MatchLoop(match.scenario, match.seed, make).play()
    return match.field.seed, result.blue_score, result.yellow_score


def blind_team(
    fields: Annotated[int, typer.Option("--fields", min=1, max=100, help="How many fields.")] = 5,
    matches: Annotated[int, typer.Option("--matches", min=1, max=200, help="On each, in pairs.")] = 10,
    seconds: Annotated[float, typer.Option("--seconds", min=10, max=3600, help="Of a match [s].")] = 300.0,
    scenario: Annotated[str, typer.Option("--scenario", help="Who plays.")] = "team_v_baseline",
    without: Annotated[
        str, typer.Option("--without", help="Let blue play against itself without this part.")
    ] = "",
    seed: Annotated[
        int, typer.Option("--seed", "-s", min=0, max=MAX_SEED // _FIELDS_A_SEED, help="Of the fields.")
    ] = 43,
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    """Draw fields, let both teams identify their robots in a minute of play, and let them play matches.

    Fields are drawn as in blind_fields. Both teams believe what was identified of ball and delay, and that
    each robot has the medians of its team. In the second match of each pair the teams swap robots.

    Keys of --json: scenario, without, seconds, seed; fields: seed, goals and against (one entry a match),
    lead, low and high (goals more a match, 95 % interval); lead, low and high over all.
    """
    chosen = load_scenario(scenario).lasting(seconds)
    if without:
        chosen = with_team(chosen, Team.YELLOW, "team_player", {"without": without})
    seeds = [seed * _FIELDS_A_SEED + number for number in range(fields)]
    looks = [(number, change, 60.0) for number in seeds for change in (False, True)]
    identifying: Work[tuple[int, bool, float], None, tuple[int, bool, SimSettings]] = Work(
        _identified, "field", BlindTeamError
    )
    playing: Work[_Match, None, tuple[int, int, int]] = Work(_played, "match", BlindTeamError)
    found: dict[tuple[int, bool], SimSettings] = {}
    goals: dict[int, list[tuple[int, int]]] = {number: [] for number in seeds}
    with Progress("identifying and playing", len(looks) + fields * matches) as progress:
        for number, change, settings in run_tasks(identifying, looks, workers or min(cores(), len(looks))):
            found[number, change] = settings
            progress.advance()
        tasks = [
            _Match(
                chosen,
                swapped(draw_field(number)) if match % 2 else draw_field(number),
                {Team.BLUE: found[number, bool(match % 2)], Team.YELLOW: found[number, not match % 2]},
                1000 * number + match // 2,
            )
            for number in seeds
            for match in range(matches)
        ]
        for number, blue, yellow in run_tasks(playing, tasks, workers or min(cores(), len(tasks))):
            goals[number].append((blue, yellow))
            progress.advance()
    rows = [{"seed": number, **_summed(goals[number])} for number in seeds]
    together = _summed([both for number in seeds for both in goals[number]])
    if as_json:
        summary = {name: together[name] for name in ("lead", "low", "high")}
        print_json(
            {
                "scenario": scenario,
                "without": without,
                "seconds": seconds,
                "seed": seed,
                "fields": rows,
                **summary,
            }
        )
        return
    shown = table("field", "matches", "goals", "lead a match")
    for row in [*rows, {"seed": "all", **together}]:
        interval = "" if row["low"] is None else f" ({row['low']:.2f} to {row['high']:.2f})"
        score = f"{sum(row['goals'])} : {sum(row['against'])}"
        shown.add_row(str(row["seed"]), str(len(row["goals"])), score, f"{row['lead']:.2f}{interval}")
    console.print(shown)


def _summed(goals: list[tuple[int, int]]) -> dict[str, Any]:
    leads = [ours - theirs for ours, theirs in goals]
    low, high = mean_interval(leads) if len(leads) > 1 else (None, None)
    return {
        "goals": [ours for ours, _ in goals],
        "against": [theirs for _, theirs in goals],
        "lead": fmean(leads),
        "low": low,
        "high": high,
    }
