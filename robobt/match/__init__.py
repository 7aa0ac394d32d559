"""Scenarios, matches between trees, their results and recordings."""

from robobt.match.ends import Outcome as Outcome
from robobt.match.loop import MatchLoop as MatchLoop
from robobt.match.results.results import MatchResult as MatchResult
from robobt.match.results.results import RobotResult as RobotResult
from robobt.match.results.results import Summary as Summary
from robobt.match.results.results import summarise as summarise
from robobt.match.runner import Run as Run
from robobt.match.runner import RunError as RunError
from robobt.match.runner import run_trials_in as run_trials_in
from robobt.match.scenario.scenario import Scenario as Scenario
from robobt.match.scenario.scenario import ScenarioError as ScenarioError
from robobt.match.scenario.scenario import load_scenario as load_scenario
