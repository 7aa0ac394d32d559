"""The settings of a team's tactics: how they are given, and that decisions get their numbers from there."""

from __future__ import annotations

import pytest

from robobt.match import ScenarioError, load_scenario
from robobt.match.scenario.changes import changed, with_team
from robobt.skills import Stop
from robobt.skills.tactics.task_switch import TaskSwitch
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TACTICS, TacticsSettings, applied
from robobt.testing import frame, robot
from robobt.tournament.sweeps.vary import SweepError, read_varied
from robobt.world import DIVISION_B, RobotState, Team
from robobt.world.ball_model import DEFAULT_BALL
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN
from tests.skills.tactics.teams import SIX, Agreement


def attacker(ball: tuple[float, ...], own: tuple[RobotState, ...] = SIX, **settings: float) -> int | None:
    agreement = Agreement()
    agreement.team.plan.tactics = TacticsSettings.model_validate(settings)
    agreement.at(0.0, ball, own)
    return agreement.team.attacker


def test_compiled_code_sees_every_setting_by_its_name() -> None:
    given = TacticsSettings(switch_gain=0.7, chip_touch_downs=3)
    seen = applied(given, DIVISION_B, DEFAULT_BALL).view(TACTICS)[0]
    assert {name: seen[name] for name in TacticsSettings.model_fields} == given.model_dump()
    assert seen["half_length"] == DIVISION_B.half_length


def test_nobody_attacks_a_ball_within_reach_of_the_own_area() -> None:
    ball = (-3.5 + 0.2, 0.0)
    assert attacker(ball) is not None
    assert attacker(ball, own_reach=0.3) is None
    assert attacker((-3.5 + 0.1, 0.0)) is None
    assert attacker((-3.5 + 0.1, 0.0), own_reach=0.0) is not None


def test_a_robot_beyond_a_resting_ball_counts_as_later_than_one_behind_it() -> None:
    beyond, behind = robot(0.5, 0.0, number=1), robot(-0.55, 0.0, number=2)
    own = (SIX[0], beyond, behind)
    assert attacker((0.0, 0.0), own) == 2
    assert attacker((0.0, 0.0), own, behind_ball=0.0) == 1


def test_what_one_robot_is_given_holds_for_its_team_and_the_rest_stays() -> None:
    first = Alone(TaskSwitch("player", {}, otherwise=Stop(), tactics=TacticsSettings(switch_gain=0.7)))
    second = TaskSwitch("player", {}, otherwise=Stop(), tactics=TacticsSettings(apart=2.0))
    view = frame(robot(number=1), (0.3, 0.0), (robot(-1.0, number=2),), game=OPEN)
    first.tick(view, 1)
    other = Alone(second)
    other.store.team = first.store.team
    other.tick(view, 2)
    assert first.store.team.plan.tactics == TacticsSettings(switch_gain=0.7, apart=2.0)


def test_a_tree_that_replaces_another_while_playing_changes_the_tactics() -> None:
    alone = Alone(TaskSwitch("player", {}, otherwise=Stop()))
    view = frame(robot(number=1), (0.3, 0.0), game=OPEN)
    alone.tick(view, 1)
    assert alone.store.team.plan.tactics == DEFAULT_TACTICS
    next_ = Alone(TaskSwitch("player", {}, otherwise=Stop(), tactics=TacticsSettings(switch_gain=0.7)))
    next_.store.team = alone.store.team
    next_.tick(view, 1)
    assert alone.store.team.plan.tactics.switch_gain == 0.7


def test_a_scenario_changes_them_one_by_one() -> None:
    scenario = load_scenario("six_v_six")
    other = changed(scenario, {"blue 1.tactics.switch_gain": 0.7, "blue 1.tactics.apart": 2})
    assert other.robots.blue[1].params["tactics"] == {"switch_gain": 0.7, "apart": 2}
    team = with_team(scenario, Team.BLUE, None, {"tactics.switch_gain": 0.7})
    switch = next(node for node in team.robots.blue[2].build_tree().iterate() if isinstance(node, TaskSwitch))
    assert switch.tactics == TacticsSettings(switch_gain=0.7)


@pytest.mark.parametrize(
    ("name", "value", "problem"),
    [
        ("swich_gain", 0.7, r"tactics\.swich_gain: blue 1: there is no such field; did you mean switch_gain"),
        (
            "switch_gain",
            -1,
            r"tactics\.switch_gain: blue 1: input should be greater than or equal to 0, not -1",
        ),
        ("switch_gain", "much", r"tactics\.switch_gain: blue 1: input should be a valid number, not 'much'"),
    ],
)
def test_a_wrong_one_is_an_error_that_names_it(name: str, value: object, problem: str) -> None:
    with pytest.raises(ScenarioError, match=problem):
        changed(load_scenario("six_v_six"), {f"blue 1.tactics.{name}": value})


def test_a_sweep_varies_one_of_them() -> None:
    varied = read_varied("team_player", "tactics.switch_gain=0.1:0.9")
    assert (varied.name, varied.low, varied.high) == ("tactics.switch_gain", 0.1, 0.9)
    assert read_varied("team_player", "tactics.chip_touch_downs=2:5").whole
    with pytest.raises(SweepError, match="tactics has no such field; did you mean switch_gain"):
        read_varied("team_player", "tactics.swich_gain=0.1:0.9")
    with pytest.raises(SweepError, match="greater than or equal to 0"):
        read_varied("team_player", "tactics.switch_gain=-0.1:0.9")
    with pytest.raises(SweepError, match="patience has no such field; it is no group of settings"):
        read_varied("team_player", "patience.more=0.1:0.9")
