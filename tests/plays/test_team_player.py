"""A team that shares out its tasks, in the simulator."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.plays import team_player
from robobt.skills import Score
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.ball.kick_loose import KickLoose
from robobt.skills.defence.avoid_crash import AvoidCrash
from robobt.skills.plan import Omitted, Task
from robobt.skills.tactics.take_place import TakePlace
from robobt.tree import Behaviour
from robobt.world import RobotId, Team
from robobt.worlds import sim_world
from tests.models.made_models import Onward, Passing, among_robots_card, score_card, team_card, write_model

SECONDS = 40.0
MINE = RobotId(Team.BLUE, 1), RobotId(Team.BLUE, 2)


class Watched:
    """What was seen in the beginning of a match against the baseline."""

    def __init__(self) -> None:
        self.failures: set[str] = set()
        self.tasks: Counter[Task] = Counter()
        self.attackers: list[int] = []
        self.kicks = 0
        scenario = load_scenario("team_v_baseline").lasting(SECONDS)
        with MatchLoop(scenario, 4, sim_world) as match:
            mine = [player for player in match.players if player.robot.team is Team.BLUE]
            team = mine[0].store.team
            while match.tick():
                self.failures |= {player.problem for player in mine if player.problem}
                self.kicks += sum(robot.team is Team.BLUE for robot in match.world.kicks)
                if mine[0].store.frame.game.in_play:
                    self.tasks.update(team.plan.tasks.values())
                    self.attackers.append(list(team.plan.tasks.values()).count(Task.ATTACK))


@pytest.mark.parametrize(
    ("without", "node"),
    [
        ("kick_loose", KickLoose),
        ("score", Score),
        ("draw", DrawGoalkeeper),
        ("avoid_crash", AvoidCrash),
    ],
)
def test_it_can_do_without_a_part(without: Omitted, node: type[Behaviour]) -> None:
    def count(tree: Behaviour) -> int:
        return sum(isinstance(each, node) for each in tree.iterate())

    assert count(team_player(without=without)) == count(team_player()) - 1


def test_its_learned_skills_are_the_attack_and_those_of_which_a_model_is_named(tmp_path: Path) -> None:
    score = str(write_model(tmp_path, Passing(), score_card()))
    go = str(write_model(tmp_path, Onward(), among_robots_card()))
    learned = [
        [node.policy for node in tree.iterate() if isinstance(node, Score | TakePlace) and node.policy]
        for tree in (team_player(without="score"), team_player(), team_player(score=score, go=go))
    ]
    assert learned == [[], ["score_on_defender_ppo"], [score, go]]


@pytest.mark.integration
def test_with_them_it_plays_on_and_they_are_used(tmp_path: Path) -> None:
    score = str(write_model(tmp_path, Passing(), score_card()))
    go = str(write_model(tmp_path, Onward(), among_robots_card()))
    scenario = load_scenario("team_v_baseline").lasting(8.0)
    for number in range(1, 6):
        scenario = scenario.with_robot(f"blue {number}", score=score, go=go)
    used: Counter[str] = Counter()
    with MatchLoop(scenario, 4, sim_world) as match:
        mine = [player for player in match.players if player.robot.team is Team.BLUE]
        while match.tick():
            assert not any(player.problem for player in mine)
            used.update(tip.feedback_message for player in mine if (tip := player.runner.root.tip()))
    assert used["to its place as learned"] > 0


@pytest.mark.integration
def test_a_policy_plays_while_the_ball_is_in_play_and_only_then(tmp_path: Path) -> None:
    model = str(write_model(tmp_path, Passing(), team_card("LearnedSkill", 1, 3)))
    scenario = load_scenario("three_v_three").lasting(8.0)
    for number in (1, 2):
        scenario = scenario.with_robot(f"blue {number}", play="team_player", open_play=model)
    seen: Counter[tuple[bool, bool]] = Counter()
    with MatchLoop(scenario, 4, sim_world) as match:
        mine = [player for player in match.players if player.robot in MINE]
        while match.tick():
            for player in mine:
                assert not player.problem
                tip = player.runner.root.tip()
                learned = tip is not None and tip.feedback_message == f"driven by {model}"
                seen[player.store.frame.game.in_play, learned] += 1
    assert seen[True, True] > 50
    assert seen[False, False] > 50
    assert not seen[False, True]


@pytest.mark.integration
def test_a_policy_may_play_the_attack_alone(tmp_path: Path) -> None:
    model = str(write_model(tmp_path, Passing(), team_card("LearnedSkill", 5, 6)))
    scenario = load_scenario("six_v_six").lasting(8.0)
    for number in range(1, 6):
        scenario = scenario.with_robot(f"blue {number}", open_play=model, open_play_tasks="attack")
    learned: Counter[str] = Counter()
    others: Counter[str] = Counter()
    with MatchLoop(scenario, 4, sim_world) as match:
        mine = [player for player in match.players if player.robot.team is Team.BLUE and player.robot.number]
        while match.tick():
            for player in mine:
                assert not player.problem
                store = player.store
                if store.frame.game.in_play:
                    tip = player.runner.root.tip()
                    driven = tip is not None and tip.feedback_message == f"driven by {model}"
                    (learned if driven else others)[store.team.plan.tasks[store.me.id]] += 1
    assert learned["attack"] > 50
    assert others["wall"] + others["mark"] > 50
    assert not set(learned) & {"wall", "mark"}


@pytest.mark.integration
@pytest.mark.parametrize(("scenario_name", "robots"), [("three_v_three", 3), ("six_v_six", 6)])
def test_a_policy_moves_the_three_near_the_ball(tmp_path: Path, scenario_name: str, robots: int) -> None:
    model = str(write_model(tmp_path, Passing(), team_card("LearnedSkill", 5, 6)))
    scenario = load_scenario(scenario_name).lasting(8.0)
    for number in range(1, robots):
        scenario = scenario.with_robot(
            f"blue {number}", play="team_player", open_play=model, open_play_tasks="near_ball"
        )
    tasks: Counter[str] = Counter()
    with MatchLoop(scenario, 4, sim_world) as match:
        mine = [player for player in match.players if player.robot.team is Team.BLUE and player.robot.number]
        while match.tick():
            driven = set()
            for player in mine:
                assert not player.problem
                tip = player.runner.root.tip()
                if tip is not None and tip.feedback_message == f"driven by {model}":
                    driven.add(player.store.me.id)
            if not mine[0].store.frame.game.in_play:
                assert not driven
                continue
            team = mine[0].store.team
            planned = {number: task for number, task in team.plan.tasks.items() if number != team.kicker}
            near = {number for number, task in planned.items() if task in ("attack", "assist")}
            assert len(near) == min(3, len(planned))
            assert driven <= near
            tasks.update("driven" if number in driven else planned[number] for number in planned)
    assert tasks["driven"] > 50
    assert (tasks["wall"] + tasks["mark"] + tasks["support"] > 50) == (robots == 6)


@pytest.fixture(scope="module")
def watched() -> Watched:
    return Watched()


@pytest.mark.integration
def test_no_tree_fails(watched: Watched) -> None:
    assert not watched.failures


@pytest.mark.integration
def test_never_do_two_go_for_the_ball(watched: Watched) -> None:
    assert max(watched.attackers) == 1


@pytest.mark.integration
def test_there_is_always_somebody_back_and_somebody_to_pass_to(watched: Watched) -> None:
    assert watched.tasks[Task.WALL] > 0
    assert watched.tasks[Task.SUPPORT] > 0


@pytest.mark.integration
def test_it_plays_the_ball(watched: Watched) -> None:
    assert watched.kicks >= 3
