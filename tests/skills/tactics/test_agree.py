from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from robobt.skills.aims import Pass
from robobt.skills.plan import Omitted, Task
from robobt.skills.tactics.agree import pass_under_way
from robobt.skills.tactics.attacker import NOBODY, AttackerCandidate, choose_attacker
from robobt.skills.tactics.chances import rate_points
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings, applied
from robobt.testing import frame, held, robot
from robobt.world import DIVISION_B, RobotLimits, Team
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.geometry import Point, distance
from robobt.world.records import MOVER
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from tests.skills.refereed import OPEN, free_kick, penalty, penalty_in_play
from tests.skills.tactics.teams import SIX, THEIRS, Agreement


def test_every_field_player_has_a_task_and_one_of_them_attacks() -> None:
    plan = Agreement().at(0.0)
    assert set(plan.tasks) == {1, 2, 3, 4, 5}
    assert [number for number, task in plan.tasks.items() if task is Task.ATTACK] == [3]
    assert all(number in plan.places for number, task in plan.tasks.items() if task is not Task.ATTACK)


def test_who_can_have_a_rolling_ball_first_attacks_not_who_is_nearest() -> None:
    agreement = Agreement()
    agreement.at(0.0, (-0.3, 0.2, 3.0, 3.0))
    assert agreement.team.attacker == 4


def test_the_attacker_changes_only_for_a_clear_gain() -> None:
    agreement = Agreement()
    agreement.at(0.0, (-0.2, 0.0))
    assert agreement.team.attacker == 3
    agreement.at(1.0, (0.05, 0.6))
    assert agreement.team.attacker == 3
    agreement.at(2.0, (0.7, 1.3))
    assert agreement.team.attacker == 4


def test_several_robots_go_for_a_ball_in_play_if_the_team_wants_it() -> None:
    agreement = Agreement()
    agreement.team.plan.at_ball = 3
    plan = agreement.at(0.0)
    assert {number: plan.tasks[number] for number in (3, 4, 5)} == {
        3: Task.ATTACK,
        4: Task.ASSIST,
        5: Task.ASSIST,
    }
    assert not {plan.tasks[1], plan.tasks[2]} & {Task.ATTACK, Task.ASSIST}
    assert Task.ASSIST not in agreement.at(0.1, game=free_kick(Team.BLUE, (0.0, 0.0))).tasks.values()


def test_a_robot_assists_until_another_is_clearly_nearer() -> None:
    agreement = Agreement()
    agreement.team.plan.at_ball = 2

    def assistant(time: float, ball: tuple[float, float]) -> int:
        tasks = agreement.at(time, ball).tasks
        return next(number for number, task in tasks.items() if task is Task.ASSIST)

    assert assistant(0.0, (-0.2, 0.0)) == 4
    assert assistant(1.0, (-0.2, -0.2)) == 4
    assert assistant(2.0, (-0.2, -1.2)) == 5
    assert assistant(3.0, (-0.2, -0.2)) == 5


def test_who_took_a_restart_does_not_go_for_the_ball_again() -> None:
    agreement = Agreement()
    agreement.team.plan.at_ball = 3
    agreement.at(0.0, game=free_kick(Team.BLUE, (0.0, 0.0)))
    plan = agreement.at(0.1)
    assert agreement.team.kicker == 3
    assert plan.tasks[3] not in (Task.ATTACK, Task.ASSIST)
    assert [plan.tasks[number] for number in (4, 5)].count(Task.ATTACK) == 1
    assert list(plan.tasks.values()).count(Task.ASSIST) == 2


def test_a_pass_under_way_belongs_to_its_receiver() -> None:
    agreement = Agreement()
    team = agreement.team
    team.receiver, team.pass_target, team.pass_time = 5, (1.0, -1.5), 0.0
    agreement.at(0.3, (0.0, 0.0, 1.2, -1.7))
    assert team.attacker == 5


@pytest.mark.parametrize(("later", "attacker"), [(0.2, 1), (0.6, 0)])
def test_the_receiver_of_a_pass_takes_it_unless_another_is_there_long_before(
    later: float, attacker: int
) -> None:
    numbers = applied(DEFAULT_TACTICS, DIVISION_B, DEFAULT_BALL)
    candidates = np.array(
        [AttackerCandidate(1.0, 0.0, False), AttackerCandidate(1.0 + later, 0.0, False)], dtype=float
    )
    assert choose_attacker(candidates, 0.0, 2.0, 1, NOBODY, 0.0, False, numbers) == attacker


def test_a_pass_that_an_opponent_has_got_is_no_longer_under_way() -> None:
    agreement = Agreement()
    team = agreement.team
    team.receiver, team.pass_target, team.pass_time = 5, (1.0, -1.5), 0.0
    thief = robot(0.4, -0.6, heading=pi, number=3, contact=True)
    ball = (*held(thief), 0.8, -0.8)
    assert pass_under_way(frame(SIX[0], ball, SIX[1:], THEIRS, 0.5, OPEN), team)
    assert not pass_under_way(frame(SIX[0], ball, SIX[1:], (*THEIRS[:3], thief), 0.5, OPEN), team)


def test_who_took_a_restart_leaves_the_ball_to_the_others() -> None:
    agreement = Agreement()
    agreement.at(0.0)
    agreement.team.kicker = 3
    agreement.at(0.1, (0.1, 0.0))
    assert agreement.team.attacker != 3


def test_who_took_a_restart_does_not_go_after_its_own_shot() -> None:
    agreement = Agreement()
    agreement.at(0.0)
    agreement.team.kicker = 3
    agreement.at(0.1, (0.3, 0.0, 6.0, 0.0))
    assert agreement.team.attacker != 3


@pytest.mark.parametrize("ball", [(-4.0, 0.5), (4.0, -0.5)])
def test_nobody_attacks_a_ball_in_a_defence_area(ball: tuple[float, float]) -> None:
    agreement = Agreement()
    plan = agreement.at(0.0, ball)
    assert agreement.team.attacker is None
    assert Task.ATTACK not in plan.tasks.values()


def test_the_receiver_of_the_next_pass_is_sent_to_its_target() -> None:
    agreement = Agreement()
    plan = agreement.at(0.0)
    plan.next_pass, plan.next_pass_time = Pass(4, (2.0, 1.0), 4.0, 0.5), 0.0
    plan = agreement.at(1 / 60)
    assert plan.tasks[4] is Task.RECEIVE
    assert plan.places[4] == (2.0, 1.0)


def test_a_pass_that_nobody_means_any_more_is_forgotten() -> None:
    agreement = Agreement()
    plan = agreement.at(0.0)
    plan.next_pass, plan.next_pass_time = Pass(4, (2.0, 1.0), 4.0, 0.5), 0.0
    plan = agreement.at(1.2)
    assert Task.RECEIVE not in plan.tasks.values()


def test_without_the_ball_it_defends_and_with_it_it_supports() -> None:
    holder = robot(-1.0, 1.0, number=3, contact=True)
    theirs = (*THEIRS[:3], holder, THEIRS[4])
    agreement = Agreement()
    for step in range(60):
        plan = agreement.at(step / 60, held(holder), theirs=theirs)
    tasks = list(plan.tasks.values())
    assert tasks.count(Task.WALL) == 2
    assert Task.MARK in tasks
    assert plan.marks
    own = tuple(replace(it, ball_contact=it.id == 5) for it in SIX)
    for step in range(60, 120):
        plan = agreement.at(step / 60, held(own[5]), own=own, theirs=THEIRS[:3])
    tasks = list(plan.tasks.values())
    assert tasks.count(Task.SUPPORT) >= 3
    assert Task.MARK not in tasks


@pytest.mark.parametrize("ours", [True, False])
def test_a_ball_that_both_can_have_at_the_same_time_stays_with_the_team_that_had_it(ours: bool) -> None:
    holder = robot(-0.6, 0.0, number=3, contact=ours)
    opponent = robot(0.6, 0.0, heading=pi, number=3, contact=not ours)
    agreement = Agreement()
    for step in range(60):
        plan = agreement.at(step / 60, held(holder if ours else opponent), (holder,), (opponent,))
    assert plan.ours is ours
    here, there = replace(holder, ball_contact=False), replace(opponent, ball_contact=False)
    for step in range(60, 240):
        plan = agreement.at(step / 60, (0.0, 0.0), (here,), (there,))
    assert plan.own_times[3] == pytest.approx(plan.their_times[3])
    assert plan.ours is ours


@pytest.mark.parametrize(("part", "task"), [("wall", Task.WALL), ("marks", Task.MARK)])
def test_a_team_that_does_without_a_task_gives_it_to_nobody(part: Omitted, task: Task) -> None:
    given = []
    for without in ("nothing", part):
        agreement = Agreement()
        agreement.team.plan.without = without
        holder = robot(-1.0, 1.0, number=3, contact=True)
        for step in range(60):
            plan = agreement.at(step / 60, held(holder), theirs=(*THEIRS[:3], holder, THEIRS[4]))
        assert set(plan.tasks) == {1, 2, 3, 4, 5}
        given.append(task in plan.tasks.values())
    assert given == [True, False]


def test_supporters_stand_apart() -> None:
    own = tuple(replace(it, ball_contact=it.id == 5) for it in SIX)
    agreement = Agreement()
    for step in range(40):
        plan = agreement.at(step / 60, held(own[5]), own=own)
    places = [plan.places[number] for number, task in plan.tasks.items() if task is Task.SUPPORT]
    assert min(distance(a, b) for i, a in enumerate(places) for b in places[:i]) > 0.7


@pytest.mark.parametrize(("stay", "stays"), [(1.25, True), (1.0, False)])
def test_supporters_stay_though_the_ball_moves_a_little(stay: float, stays: bool) -> None:
    agreement = Agreement()
    agreement.team.plan.tactics = TacticsSettings(stay=stay)
    chosen = []
    for x, y in (SIX[5].position, (SIX[5].x + 0.1, SIX[5].y + 0.1)):
        holder = robot(x, y, number=5, contact=True)
        for step in range(40):
            time = len(chosen) + step / 60
            plan = agreement.at(time, held(holder), own=(*SIX[:5], holder))
        chosen.append(plan.support)
    assert (chosen[0] == chosen[1]) is stays


def test_who_has_passed_runs_to_where_the_ball_can_come_back_to_it() -> None:
    passer, target, start = SIX[3], (1.0, -1.5), (-0.6, 0.0)
    own = tuple(replace(it, ball_contact=it is passer) for it in SIX)
    near = (*THEIRS[:3], robot(0.0, 0.1, number=3), robot(-0.2, 0.7, number=4))
    agreement = Agreement()
    for step in range(40):
        agreement.at(step / 60, held(own[3]), own=own, theirs=near)
    team = agreement.team
    team.passer, team.receiver, team.pass_target, team.pass_time = passer.id, 5, target, 40 / 60
    for step in range(40, 70):
        way = (step - 39) * 3.0 / 60
        share = way / distance(start, target)
        ball = (start[0] + share * 1.6, start[1] - share * 1.5, 2.2, -2.0)
        plan = agreement.at(step / 60, ball, theirs=near)
    assert plan.tasks[passer.id] is Task.SUPPORT
    rows = np.array([plan.places[passer.id], passer.position])
    there, stays = rate_points(rows, *target, 0.4, plan.their_movers, plan.numbers)
    # The chance that the ball comes back, times what it is worth there.
    assert there[0] > 0.5
    assert there[0] * there[1] > 1.5 * stays[0] * stays[1]


def test_opponents_are_not_taken_to_use_all_that_their_robots_could() -> None:
    quick = RobotLimits(max_speed=5.0, acceleration=4.15)
    theirs = tuple(replace(it, limits=quick) for it in THEIRS)
    plan = Agreement().at(0.0, theirs=theirs)
    theirs = plan.their_movers.view(MOVER)
    assert (theirs["max_speed"] == plan.tactics.quickest).all()
    assert (theirs["acceleration"] == plan.tactics.quickest).all()
    slow = tuple(replace(it, limits=RobotLimits(max_speed=1.5)) for it in THEIRS)
    assert (Agreement().at(0.0, theirs=slow).their_movers.view(MOVER)["max_speed"] == 1.5).all()


def test_tasks_stay_while_nothing_changes() -> None:
    agreement = Agreement()
    seen = set()
    for step in range(120):
        plan = agreement.at(step / 60, (0.4, 0.4))
        if step > 40:
            seen.add(tuple(sorted(plan.tasks.items())))
    assert len(seen) == 1


def test_a_robot_that_has_left_has_no_task() -> None:
    agreement = Agreement()
    agreement.at(0.0)
    plan = agreement.at(0.1, own=SIX[:4])
    assert set(plan.tasks) == {1, 2, 3}


def test_an_own_free_kick_counts_as_the_own_ball() -> None:
    agreement = Agreement()
    for step in range(60):
        plan = agreement.at(step / 60, (2.0, 2.0), game=free_kick(Team.BLUE, (2.0, 2.0)))
    assert plan.ours
    for step in range(60, 120):
        plan = agreement.at(step / 60, (2.0, 2.0), game=free_kick(Team.YELLOW, (2.0, 2.0)))
    assert not plan.ours


def test_a_penalty_kick_whose_taker_has_left_the_field_is_taken_by_another() -> None:
    agreement, spot = Agreement(), (0.0, 0.0)
    taker = agreement.at(0.0, spot, game=penalty(Team.BLUE, spot))
    assert taker.tasks[3] is Task.ATTACK
    left = tuple(each for each in SIX if each.id != 3)
    plan = agreement.at(0.1, spot, left, game=penalty_in_play(Team.BLUE))
    assert Task.ATTACK in [plan.tasks[each.id] for each in left[1:]]


@pytest.mark.parametrize("spot", [(4.3, 2.8), (1.0, -2.8), (-2.2, 1.4)])
def test_at_an_own_free_kick_a_mate_stands_so_near_that_nobody_can_come_between(spot: Point) -> None:
    agreement = Agreement()
    plan = agreement.at(0.0, spot, game=free_kick(Team.BLUE, spot))
    attacker = next(number for number, task in plan.tasks.items() if task is Task.ATTACK)
    near = [
        place for number, place in plan.places.items() if number != attacker and distance(place, spot) < 0.5
    ]
    assert near == [plan.short]
    without = Agreement()
    without.team.plan.without = "short_place"
    assert without.at(0.0, spot, game=free_kick(Team.BLUE, spot)).short is None
    assert DIVISION_B.contains(*near[0])
    assert not in_own_defense_area(DIVISION_B, *near[0])
    assert not in_their_defense_area(DIVISION_B, *near[0])
    theirs = agreement.at(0.1, spot, game=free_kick(Team.YELLOW, spot))
    assert theirs.short is None
