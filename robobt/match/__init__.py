"""Scenarios, matches between trees, their results and recordings."""

from robobt.match.ends import Outcome
from robobt.match.loop import Match, WorldFactory, play_match
from robobt.match.results.results import MatchResult, RobotResult, Summary, summarise
from robobt.match.runner import Run, RunError, run_trials
from robobt.match.scenario.scenario import Scenario, ScenarioError, load_scenario

__all__ = [
    "Match",
    "MatchResult",
    "Outcome",
    "RobotResult",
    "Run",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Summary",
    "WorldFactory",
    "load_scenario",
    "play_match",
    "run_trials",
    "summarise",
]
