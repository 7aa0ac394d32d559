"""The goal line as both raters judge it at a first shot."""

from __future__ import annotations

from pathlib import Path

from robobt.experiments.deployed import Situation, deployed_scenario
from robobt.experiments.goal_map import draw_goal_line
from robobt.match.loop import Match, WorldFactory
from robobt.match.runner import trial_seed
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.skills.aim.raters.nn_filtered import NNFiltered
from robobt.worlds import sim_world


def judged_goal_line(situation: Situation, seed: int, path: Path, world: WorldFactory = sim_world) -> None:
    """Play ``attack_expected`` until its first shot and draw the goal line as judged at that moment.

    Raises:
        RuntimeError: it takes no shot in the first of its trials.
    """
    scenario = deployed_scenario(situation, "attack_expected")
    with Match(scenario, trial_seed(seed, 0), world) as match:
        store = match.players[0].store
        while match.tick():
            if store.command.kick_speed > 0.0:
                break
        else:
            raise RuntimeError("attack_expected takes no shot in this trial")
        frame, me = store.frame, store.me
    points = goal_candidates(frame.field)
    expected = ExpectedGoal().chances(frame, frame.ball.position, me, points)
    assert expected is not None
    network = NNFiltered().chances(frame, me, points)
    draw_goal_line(frame, me, {"expected_goal": expected, "nn_filtered": network}, path)
