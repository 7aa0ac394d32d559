"""World factories: from a scenario to the world it is played in, and matches played there.

Above ``match``, which knows no world, and ``sim``, which knows no scenario.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from pydantic import ValidationError

from robobt.config.errors import message_of
from robobt.config.validation import first_problem
from robobt.match.loop import MatchLoop, WorldFactory
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.results.compare import Compared, compare_results
from robobt.match.results.results import MatchResult
from robobt.match.runner import Run, run_trials_in
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.sim import SimSettings, SimWorld, settings_from
from robobt.world.delay import DelayWatch
from robobt.world.limits import RobotLimits
from robobt.world.measured_prediction import MeasuredWorld
from robobt.world.prediction import predicted
from robobt.world.protocol import World
from robobt.world.state import RobotId


def sim_world(scenario: Scenario) -> World:
    """Make the built-in simulator with the scenario's field and robots.

    Where its vision or commands are late and the scenario does not say otherwise, the
    frames are predicted to the present (:class:`~robobt.world.prediction.PredictedWorld`). With
    ``predict: measured`` they always are, by delays that are measured
    (:class:`~robobt.world.measured_prediction.MeasuredWorld`).

    Raises:
        ScenarioError: the simulator's settings in the scenario are wrong.
    """
    settings = scenario_settings(scenario)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    world = SimWorld(scenario.field, limits, settings, scenario.period)
    realism = settings.realism
    if not scenario.predict:
        return world
    gaps = realism.missing_robot > 0.0
    if scenario.predict == "measured":
        return MeasuredWorld(world, _watch_of(settings, limits), gaps)
    return predicted(world, limits.values(), realism.vision_delay, realism.command_delay, gaps)


def _watch_of(settings: SimSettings, own: Mapping[RobotId, RobotLimits]) -> DelayWatch:
    """Return what measures the robots' delays; until it has, it expects those of the settings."""
    realism = settings.realism
    shown = realism.vision_delay if realism.processing_time is None else realism.processing_time
    return DelayWatch(settings.limits, own, realism.vision_delay - shown + realism.command_delay)


def scenario_settings(scenario: Scenario, preset: str | None = None) -> SimSettings:
    """Return the settings of a scenario's simulator, with ``preset`` in place of its own if one is named.

    Raises:
        ScenarioError: they are wrong.
    """
    simulator = scenario.simulator
    if preset is not None:
        simulator = {**simulator, "preset": preset}
    try:
        return settings_from(simulator)
    except ValidationError as error:
        field, problem = first_problem(error, SimSettings, simulator)
        raise scenario.error(problem, f"simulator.{field}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise scenario.error(message_of(error), "simulator") from error


SIM = "sim"
"""The name of the built-in simulator as a world."""


def world_from(address: str) -> WorldFactory:
    """Return the factory for the worlds of an address.

    Args:
        address: "sim", a field of the league like ``league://grsim`` (options as for
            :func:`robobt.league.factory.parse_address`), or a league log (``*.log``,
            ``*.log.gz``), which is only observed.

    Raises:
        robobt.league.factory.AddressError: the address is none of them.
    """
    if address == SIM:
        return sim_world
    if address.lower().endswith((".log", ".log.gz")) and "://" not in address:
        from robobt.league.log.world import log_factory

        return log_factory(address)
    # Protobuf and sockets are only needed to play over a network.
    from robobt.league.factory import LeagueFactory

    return LeagueFactory(address, scenario_settings)


class Match(MatchLoop):
    """A match that is played tick by tick, in the built-in simulator unless another world is given.

    Args:
        scenario: the scenario to play, or a bundled one's name, or a file.
        seed: fixes placement, world and trees; the scenario's by default.
        world: an address as for :func:`world_from`, or a factory.
        record: file to record the match to; its name ends in ``.robobt.arrows``.
        referee: makes the referee; by default the scenario's own. It is closed with the match.

    Attributes and errors are those of :class:`robobt.match.loop.MatchLoop`.
    """

    def __init__(
        self,
        scenario: Scenario | str | Path,
        seed: int | None = None,
        world: str | WorldFactory = SIM,
        record: str | Path | None = None,
        referee: RefereeFactory = own_referee,
    ) -> None:
        scenario = _scenario(scenario)
        seed = scenario.seed if seed is None else seed
        super().__init__(scenario, seed, _factory(world), record, referee=referee)


def play_match(
    scenario: Scenario | str | Path,
    seed: int | None = None,
    *,
    world: str | WorldFactory = SIM,
    record: str | Path | None = None,
    referee: RefereeFactory = own_referee,
) -> MatchResult:
    """Play one match to its end.

    Args:
        scenario: the scenario to play, or a bundled one's name, or a file.
        seed: fixes placement, world and trees; the scenario's by default.
        world: an address as for :func:`world_from`, or a factory.
        record: file to record the match to.
        referee: makes the referee; by default the scenario's own.

    Returns:
        How it ended, the goals and what was counted.

    Raises:
        ScenarioError: the scenario does not fit the world, or its objects find no place.
        OSError: the recording cannot be written.
    """
    return Match(scenario, seed, world, record, referee).play()


def run_trials(
    scenario: Scenario | str | Path,
    trials: int | None = None,
    *,
    world: str | WorldFactory = SIM,
    seed: int | None = None,
    workers: int = 1,
    out: str | Path | None = None,
    record: Mapping[int, str | Path] | None = None,
    on_result: Callable[[MatchResult], None] | None = None,
    referee: RefereeFactory = own_referee,
) -> Run:
    """Play a scenario many times.

    Errors are those of :func:`robobt.match.runner.run_trials_in`.

    Args:
        scenario: the scenario to play, or a bundled one's name, or a file.
        trials: number of trials; the scenario's by default.
        world: an address as for :func:`world_from`, or a factory.
        seed: seed from which the trials' seeds follow; the scenario's by default.
        workers: number of processes; one is this process itself. With more, a script calls this under
            ``if __name__ == "__main__":``, because the processes import it.
        out: file to append each result to; trials it holds already are not played again.
        record: files to record trials to, by trial number.
        on_result: called with each result as it finishes.
        referee: makes the referee of each trial; by default the scenario's own.

    Returns:
        The results, and their summary.
    """
    factory = _factory(world)
    return run_trials_in(_scenario(scenario), factory, trials, workers, seed, out, record, on_result, referee)


def compare(
    variants: Mapping[str, Scenario | str | Path],
    trials: int | None = None,
    *,
    world: str | WorldFactory = SIM,
    seed: int | None = None,
    workers: int = 1,
    referee: RefereeFactory = own_referee,
) -> dict[str, Compared]:
    """Play variants of a scenario from the same starts with the same seeds, and compare them trial by trial.

    Errors are those of :func:`run_trials`.

    Args:
        variants: the scenarios by what they are called; the others are compared with the first.
        trials: number of trials of each; the first scenario's by default.
        world: an address as for :func:`world_from`, or a factory.
        seed: seed from which the trials' seeds follow; the first scenario's by default.
        workers: number of processes; one is this process itself.
        referee: makes the referee of each trial; by default the scenario's own.

    Returns:
        Each variant's figures by its name, with the paired difference to the first.

    Raises:
        ValueError: there are fewer than two variants.
        KeyboardInterrupt: it was stopped (Ctrl-C) before the last trial.
    """
    if len(variants) < 2:
        raise ValueError(f"a comparison needs two variants, not {len(variants)}")
    scenarios = {label: _scenario(given) for label, given in variants.items()}
    first = next(iter(scenarios.values()))
    trials = first.trials if trials is None else trials
    seed = first.seed if seed is None else seed
    results = {}
    for label, scenario in scenarios.items():
        run = run_trials(scenario, trials, world=world, seed=seed, workers=workers, referee=referee)
        if run.interrupted:
            raise KeyboardInterrupt
        results[label] = run.results
    return compare_results(results)


def _scenario(given: Scenario | str | Path) -> Scenario:
    return given if isinstance(given, Scenario) else load_scenario(given)


def _factory(world: str | WorldFactory) -> WorldFactory:
    return world_from(world) if isinstance(world, str) else world
