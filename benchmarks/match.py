"""Speed of a whole match, beside the same match ticked by py_trees and without recording."""

from __future__ import annotations

import tempfile
from pathlib import Path
from statistics import median
from time import process_time
from typing import Annotated, TypedDict

import typer
from rich.markup import escape

from robobt.cli import Json, Seed, print_json, say
from robobt.cli.common import Bundled, Imports, errors, import_files
from robobt.match import MatchLoop, Scenario, WorldFactory, load_scenario
from robobt.match.referee.events import Decision
from robobt.match.refereeing import MatchReferee, own_referee
from robobt.world import FieldGeometry, Frame
from robobt.worlds import sim_world

_BLOCK = 1.0
"""Simulated time that each of the matches plays in turn, so that all see the same machine [s]."""


class MatchFigures(TypedDict):
    """What ``python -m benchmarks match`` measures; its help explains the figures."""

    scenario: str
    seed: int
    robots: int
    period: float
    simulated_s: float
    cpu_s: float
    real_time_factor: float
    real_time_factor_unrecorded: float
    real_time_factor_py_trees: float
    speedup_vs_py_trees: float
    recording_share: float
    referee_share: float
    in_play: float
    ticks: int
    turns: int
    errors: int


class _TimedReferee:
    """Makes the scenario's own referee, and is it: passes frames on and measures how long it takes.

    ``busy`` is its processor time so far [s].
    """

    def __init__(self) -> None:
        self.busy = 0.0
        self._referee: MatchReferee | None = None

    def __call__(self, scenario: Scenario, field: FieldGeometry) -> MatchReferee | None:
        self._referee = own_referee(scenario, field)
        return None if self._referee is None else self

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame."""
        assert self._referee is not None
        begin = process_time()
        decision = self._referee.update(frame)
        self.busy += process_time() - begin
        return decision

    def close(self) -> None:
        """Close the referee."""
        if self._referee is not None:
            self._referee.close()


def bench_match(
    scenario: Scenario, world_factory: WorldFactory, seconds: float = 60.0, seed: int | None = None
) -> MatchFigures:
    """Play one match three times over in turns, in this process, after once that does not count.

    Once as people play it, recorded; once without recording; once with every
    tree ticked by py_trees' own generators. All three are the same match, and play the same
    simulated second in each turn.

    ``seconds`` are simulated [s]; the seed is the scenario's by default.
    """
    seed = scenario.seed if seed is None else seed
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.robobt.arrows"
        played = scenario.lasting(seconds)
        # Compiled code and policies are loaded when they are first needed, as by the first shot.
        MatchLoop(played, seed, world_factory, path).play()
        recorded = MatchLoop(played, seed, world_factory, path)
        timed = _TimedReferee()
        bare = MatchLoop(played, seed, world_factory, referee=timed)
        stock = MatchLoop(played, seed, world_factory)
        for player in stock.players:
            player.runner.tick_by_py_trees()
        matches = (recorded, bare, stock)
        # Processor time, for other programs on the machine cost a match nothing.
        turns: list[list[float]] = []
        block = max(1, round(_BLOCK / scenario.period))
        turn, going = 0, True
        with recorded:
            while going:
                # Each goes first in its turn: what comes first after a change finds the caches cold.
                taken = [0.0, 0.0, 0.0]
                for i in [(turn + i) % 3 for i in range(3)]:
                    begin = process_time()
                    for _ in range(block):
                        going = matches[i].tick()
                        if not going:
                            break
                    taken[i] = process_time() - begin
                turns.append(taken)
                turn += 1
    result = recorded.result()
    if len({match.result().trace for match in matches}) != 1:
        raise RuntimeError("the three matches differ: recording or ticking changed what was played")
    spent = [sum(times) for times in zip(*turns, strict=True)]
    return {
        "scenario": scenario.name,
        "seed": seed,
        "robots": len(result.robots),
        "period": scenario.period,
        "simulated_s": result.time,
        "cpu_s": spent[0],
        "real_time_factor": result.time / spent[0],
        "real_time_factor_unrecorded": result.time / spent[1],
        "real_time_factor_py_trees": result.time / spent[2],
        "speedup_vs_py_trees": median([stock_s / bare_s for _, bare_s, stock_s in turns]),
        "recording_share": 1.0 - spent[1] / spent[0],
        "referee_share": timed.busy / spent[1],
        "in_play": result.in_play,
        "ticks": result.ticks,
        "turns": len(turns),
        "errors": sum(robot.errors for robot in result.robots.values()),
    }


def match(
    scenario: Bundled = "team_v_baseline",
    seconds: Annotated[
        float, typer.Option("--seconds", min=1, max=3600, help="Simulated time to play.")
    ] = 60.0,
    seed: Seed = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Measure a whole match on one core: every robot's tree, the physics and the recording.

    The match is played three times over in turns: recorded, unrecorded, and
    with the trees ticked by py_trees itself. Before that it is played once that
    does not count, in which code is compiled and models are loaded.

    Keys of --json: scenario, seed, robots (how many), period, simulated_s,
    cpu_s (processor time of the recorded match), real_time_factor (simulated
    time over it), real_time_factor_unrecorded, real_time_factor_py_trees
    (unrecorded), speedup_vs_py_trees (of the whole match, median over the turns),
    recording_share (of the recorded match's time; of the sums, because recordings are
    written in bursts), referee_share (of
    the unrecorded match's time), in_play (share of the time with the ball in
    play), ticks, turns (of a simulated second), errors (ticks a tree failed).
    """

    import_files(imports)
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)}"):
        figures = bench_match(loaded, sim_world, seconds, seed)
    if as_json:
        print_json(figures)
        return
    say(
        f"{loaded.name}: {figures['simulated_s']:.1f} s of {figures['robots']} robots at "
        f"{1 / loaded.period:.0f} Hz in {figures['cpu_s']:.2f} s of processor time: "
        f"{figures['real_time_factor']:.1f} times real time. Recording takes "
        f"{figures['recording_share']:.1%} and the referee {figures['referee_share']:.1%}; "
        f"ball in play {figures['in_play']:.0%} of the time. "
        f"With py_trees' own ticking {figures['real_time_factor_py_trees']:.1f} times real time, "
        f"{figures['speedup_vs_py_trees']:.2f} times the processor time."
    )
    say(
        f"Compared: processor time of the same match recorded, unrecorded and ticked by py_trees, "
        f"{figures['turns']} seconds in turn, after a whole match as warm-up."
    )
