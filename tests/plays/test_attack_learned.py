from pathlib import Path

import pytest
import torch

from paper.deployed import Situation, deployed_scenario
from robobt.match import load_scenario, run_trials_in, summarise
from robobt.match.scenario.scenario import Scenario
from robobt.models.file import ModelError
from robobt.plays import attack_learned
from robobt.skills import Duel, LearnedSkill, Score, Skill
from robobt.testing import Trial, alone, eventually, frame, goal_for, never, robot
from robobt.tree import Status
from robobt.world import Frame, Team
from robobt.worlds import sim_world
from tests.models.made_models import network, team_card, write_model
from tests.skills.fixed_world import Alone


def goals(scenario: Scenario, trials: int, seed: int = 91) -> int:
    summary = summarise(run_trials_in(scenario, sim_world, trials, seed=seed).results)
    assert summary.robots["blue 0"].errors == 0
    return summary.goals["blue"].trials.count


@pytest.mark.integration
@pytest.mark.parametrize("play", ["attack_nn", "attack_expected"])
@pytest.mark.parametrize("speed", ["half", "full"])
def test_it_scores_nearly_always_where_attack_main_seldom_does(play: str, speed: str):
    assert goals(deployed_scenario(Situation(speed=speed), play), 8) >= 7
    assert goals(deployed_scenario(Situation(speed=speed), "attack_main"), 8) <= 5


@pytest.mark.integration
def test_attack_expected_scores_near_the_goal_too():
    assert goals(load_scenario("score_on_goalkeeper"), 12, seed=977) >= 11


@pytest.mark.parametrize("play", ["attack_nn", "attack_expected"])
def test_it_gets_a_ball_that_lies_on_the_field_and_scores(play: str):
    from robobt.plays import PLAYS

    trial = alone(PLAYS[play](max_distance=3.5), (0.0, 0.0, 0.0), ball=(1.0, 0.8))
    trial.run(12.0, eventually("the ball is in the goal", goal_for(Team.BLUE)))


def test_without_patience_it_takes_what_there_is():
    impatient = deployed_scenario(Situation(speed="half"), "attack_expected").with_robot(
        "blue 0", min_score=1.0, patience=0.5, last_resort=0.2
    )
    results = run_trials_in(impatient, sim_world, 3, seed=4).results
    assert all(result.robots["blue 0"].kicks for result in results)


@pytest.mark.parametrize("leaf", [Score, Duel, LearnedSkill])
def test_any_policy_attacks_as_the_leaf_that_it_is_for(leaf: type[Skill], tmp_path: Path):
    model = write_model(tmp_path, network(27, 4), team_card(leaf.__name__, 0, 2))
    leaves = [type(node) for node in attack_learned(policy=str(model)).iterate()]
    assert [kind for kind in leaves if kind in (Score, Duel, LearnedSkill)] == [leaf]
    assert Alone(attack_learned()).tick(frame(robot())) is Status.FAILURE


def test_a_policy_for_something_else_does_not_attack():
    said = "is a model for Goalkeeper, not for Score, Duel or LearnedSkill; it was trained in the task save$"
    with pytest.raises(ModelError, match=said):
        attack_learned(policy="save_ppo")
    with pytest.raises(ModelError, match="is a model for Shoot, not for Score"):
        attack_learned(policy="shoot_ddpg")


def test_a_policy_that_stops_at_the_ball_gets_it_from_the_written_skills(tmp_path: Path):
    lazy = torch.nn.Linear(27, 4)
    torch.nn.init.zeros_(lazy.weight)
    torch.nn.init.zeros_(lazy.bias)
    model = str(write_model(tmp_path, lazy, team_card("Score", 0, 2)))

    def has_it(frame: Frame) -> bool:
        return frame.own[0].ball_contact

    def beside(patience: float) -> Trial:
        tree = attack_learned(policy=model, patience=patience)
        return alone(tree, (0.0, 0.0, 0.0), ball=(0.093, -0.07))

    beside(0.6).run(3.0, eventually("the ball is in the mouth", has_it))
    beside(60.0).run(3.0, never("the ball is in the mouth", has_it))
