from __future__ import annotations

from dataclasses import replace
from math import nan

import pytest

from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.choose_kick import ChooseKick
from robobt.skills.tactics_settings import TacticsSettings
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import GameState, RobotLimits, RobotState, Team
from robobt.world.geometry import segment_distance
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN, free_kick

KEEPER = robot(4.2, 0.0, number=0)


class Chooser:
    """Robot 1 with the ball; its team-mates take part in the plan."""

    def __init__(self, skill: ChooseKick, mates: tuple[RobotState, ...] = ()) -> None:
        self.alone, self.mates = Alone(skill), mates
        self.alone.store.team.plan.players.update((1, *(mate.id for mate in mates)))

    def at(
        self,
        time: float,
        me: RobotState,
        theirs: tuple[RobotState, ...] = (KEEPER,),
        game: GameState = OPEN,
        ball: tuple[float, ...] | None = None,
    ) -> Status:
        view = frame(me, ball or held(me), self.mates, theirs, time, game)
        agree(view, self.alone.store.team)
        return self.alone.tick(view, 1)


ME = robot(3.2, 0.9, -0.5, number=1, contact=True)


@pytest.mark.integration
def test_a_good_shot_is_taken_at_once() -> None:
    chooser = Chooser(ChooseKick())
    assert chooser.at(0.0, ME, ()) is Status.SUCCESS
    shot = chooser.alone.store.shot
    assert shot is not None
    assert shot.target[0] == 4.5
    assert abs(shot.target[1]) < 0.5
    assert chooser.alone.store.pass_ is None


def test_far_from_the_goal_it_passes_forward_and_tells_the_team() -> None:
    mate = robot(1.5, 1.5, number=4)
    chooser = Chooser(ChooseKick(), (mate,))
    assert chooser.at(0.0, robot(-1.5, 0.0, 0.5, number=1, contact=True)) is Status.SUCCESS
    store = chooser.alone.store
    assert store.pass_ is not None
    assert store.pass_.receiver == 4
    assert store.team.plan.next_pass == store.pass_
    assert store.shot is None


@pytest.mark.parametrize(("gap", "status"), [(0.3, Status.SUCCESS), (0.4, Status.FAILURE)])
def test_a_weak_pass_is_played_once_an_opponent_presses(gap: float, status: Status) -> None:
    chooser = Chooser(ChooseKick(), (robot(1.5, 1.5, number=4),))
    # However little the ball is worth where it is.
    chooser.alone.store.team.plan.tactics = TacticsSettings(better=10.0)
    me = robot(-1.5, 0.0, 0.5, number=1, contact=True)
    x, y = held(me)
    assert chooser.at(0.0, me, (KEEPER, robot(x, y - gap, number=3))) is status
    weak = chooser.alone.store.candidates[0]
    assert 0.1 < weak.score < 0.3
    assert chooser.alone.store.pass_ == (weak if status is Status.SUCCESS else None)


@pytest.mark.parametrize(("hold", "status"), [(0.35, Status.SUCCESS), (3.0, Status.FAILURE)])
def test_a_pass_worth_little_is_better_than_a_ball_that_a_weak_dribbler_keeps(
    hold: float, status: Status
) -> None:
    chooser = Chooser(ChooseKick(patience=1.5), (robot(-3.0, 1.0, number=4),))
    chooser.alone.store.team.plan.tactics = TacticsSettings(better=10.0)
    limits = RobotLimits(hold_acceleration=hold)
    me = robot(-2.0, -1.0, 2.0, number=1, contact=True, limits=limits)
    for step in range(40):
        seen = chooser.at(step / 10, me, (KEEPER, robot(-2.2, 1.4, number=3)))
    assert 0.01 < chooser.alone.store.candidates[0].score < 0.035
    assert seen is status


def test_nobody_is_passed_to_through_an_opponent() -> None:
    mate = robot(1.5, 0.0, number=4)
    me = robot(-1.5, 0.0, number=1, contact=True)
    opponent = robot(-0.5, 0.0, number=3)
    for chips in (False, True):
        chooser = Chooser(ChooseKick(chips=chips), (mate,))
        chooser.at(0.0, me, (KEEPER, opponent))
        chosen = chooser.alone.store.pass_
        if chosen is None or segment_distance(opponent.position, held(me), chosen.target) > 0.13:
            continue
        # But over it.
        assert chips
        assert chosen.chip


def test_without_the_ball_there_is_nothing_to_choose() -> None:
    chooser = Chooser(ChooseKick(), (robot(1.5, 1.5, number=4),))
    me = robot(-1.5, 0.0, number=1)
    near = robot(-0.8, 0.0, number=3)
    assert chooser.at(0.0, me, (KEEPER, near), ball=(-1.0, 0.0)) is Status.FAILURE


@pytest.mark.parametrize("mates", [(robot(-3.0, -2.0, number=4),), ()])
def test_a_restart_is_taken_in_the_end_whatever_there_is(mates: tuple[RobotState, ...]) -> None:
    spot = (-1.0, 2.0)
    walls = tuple(robot(-1.2 - 0.1 * i, 1.4 - 0.2 * i, number=i) for i in range(4))
    chooser = Chooser(ChooseKick(restart=True, patience=1.0, floor=0.04), mates)
    me = robot(-1.2, 2.2, number=1)
    game = free_kick(Team.BLUE, spot)
    waiting = replace(game, may_touch=False)
    chooser.at(0.0, me, walls, waiting, spot)
    status = Status.FAILURE
    for step in range(300):
        status = chooser.at(1.0 + step / 60, me, walls, game, spot)
        if status is Status.SUCCESS:
            break
    assert status is Status.SUCCESS


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("shoot_at", 2.0),
        ("pass_at", -0.1),
        ("floor", 1.5),
        ("shoot_at", nan),
        ("patience", 0.0),
        ("patience", -1.0),
        ("keep", -1.0),
        ("max_distance", nan),
    ],
)
def test_a_setting_that_makes_no_sense_is_refused(setting: str, value: float) -> None:
    with pytest.raises(ValueError, match=setting):
        ChooseKick(**{setting: value})  # type: ignore[arg-type]
