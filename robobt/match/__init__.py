"""Scenarios, matches between trees, their results and recordings."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "Box": "scenario.starts",
    "MatchLoop": "loop",
    "MatchResult": "results.results",
    "Outcome": "ends",
    "Rate": "results.results",
    "Recording": "recording",
    "RobotResult": "results.results",
    "RobotSetup": "scenario.robots",
    "Run": "runner",
    "RunError": "runner",
    "Scenario": "scenario.scenario",
    "ScenarioError": "scenario.scenario",
    "Summary": "results.results",
    "TrialsFile": "results.file",
    "WorldFactory": "loop",
    "check_regression_case": "regression_cases",
    "load_recording": "recording",
    "load_scenario": "scenario.scenario",
    "run_trials_in": "runner",
    "summarise": "results.results",
    "trial_seed": "runner",
}

if TYPE_CHECKING:
    from robobt.match.ends import Outcome as Outcome
    from robobt.match.loop import MatchLoop as MatchLoop
    from robobt.match.loop import WorldFactory as WorldFactory
    from robobt.match.recording import Recording as Recording
    from robobt.match.recording import load_recording as load_recording
    from robobt.match.regression_cases import check_regression_case as check_regression_case
    from robobt.match.results.file import TrialsFile as TrialsFile
    from robobt.match.results.results import MatchResult as MatchResult
    from robobt.match.results.results import Rate as Rate
    from robobt.match.results.results import RobotResult as RobotResult
    from robobt.match.results.results import Summary as Summary
    from robobt.match.results.results import summarise as summarise
    from robobt.match.runner import Run as Run
    from robobt.match.runner import RunError as RunError
    from robobt.match.runner import run_trials_in as run_trials_in
    from robobt.match.runner import trial_seed as trial_seed
    from robobt.match.scenario.robots import RobotSetup as RobotSetup
    from robobt.match.scenario.scenario import Scenario as Scenario
    from robobt.match.scenario.scenario import ScenarioError as ScenarioError
    from robobt.match.scenario.scenario import load_scenario as load_scenario
    from robobt.match.scenario.starts import Box as Box
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
