from __future__ import annotations

import pytest

from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.choose_safe_pass import ChooseSafePass
from robobt.skills.tactics.keeping import SHORTEST
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotState
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand
from tests.skills.fixed_world import Alone

ME = robot(-2.0, 0.0, number=1, contact=True)


class Keeper:
    """Robot 1 with the ball; its team-mates take part in the plan."""

    def __init__(self, skill: ChooseSafePass, *mates: RobotState) -> None:
        self.alone, self.mates = Alone(skill), mates
        self.alone.store.team.plan.players.update((1, *(mate.id for mate in mates)))

    def at(self, time: float, *theirs: RobotState, game: GameState = OPEN_PLAY) -> Status:
        view = frame(ME, held(ME), self.mates, theirs, time, game)
        agree(view, self.alone.store.team)
        return self.alone.tick(view, 1)


def test_it_passes_to_the_mate_that_nobody_marks() -> None:
    marked, free = robot(-0.5, 0.0, number=2), robot(-2.0, 1.6, number=3)
    keeper = Keeper(ChooseSafePass(enough=0.05), marked, free)
    assert keeper.at(0.0, robot(-0.8, 0.1, number=5)) is Status.SUCCESS
    store = keeper.alone.store
    assert store.pass_ is not None
    assert (store.pass_.receiver, store.shot) == (3, None)
    assert store.team.plan.next_pass == store.pass_


def test_a_mate_that_is_too_near_gets_no_pass() -> None:
    near = robot(held(ME)[0] + SHORTEST - 0.3, 0.0, number=2)
    keeper = Keeper(ChooseSafePass(), near)
    keeper.at(0.0)
    chosen = keeper.alone.store.pass_
    assert chosen is None or abs(chosen.target[0] - held(ME)[0]) >= SHORTEST - 1e-9


def test_a_pass_leads_a_mate_that_moves() -> None:
    keeper = Keeper(ChooseSafePass(enough=0.0), robot(-2.0, 1.6, number=2, velocity=(1.0, 0.0, 0.0)))
    keeper.at(0.0)
    chosen = keeper.alone.store.pass_
    assert chosen is not None
    assert chosen.target == pytest.approx((-1.8, 1.6))


def test_a_pass_is_chosen_before_the_whistle_too() -> None:
    keeper = Keeper(ChooseSafePass(enough=0.0, least=0.0), robot(-2.0, 1.6, number=2))
    game = GameState(RefereeCommand.STOP, may_touch=False)
    assert [keeper.at(step / 60, game=game) for step in range(3)] == [Status.SUCCESS] * 3


def test_a_poor_pass_is_played_only_after_a_while() -> None:
    mate, opponent = robot(0.0, 0.0, number=2), robot(-0.1, 1.0, number=5)
    keeper = Keeper(ChooseSafePass(enough=1.0, least=0.01, patience=1.0), mate)
    assert keeper.at(0.0, opponent) is Status.FAILURE
    assert [keeper.at(0.2 * step, opponent) for step in range(1, 6)][-1] is Status.SUCCESS


def test_an_opponent_close_by_ends_the_waiting() -> None:
    mate, opponent = robot(0.0, 0.0, number=2), robot(-0.1, 1.0, number=5)
    keeper = Keeper(ChooseSafePass(enough=1.0, least=0.01), mate)
    assert keeper.at(0.0, opponent, robot(-2.3, 0.2, number=6)) is Status.SUCCESS


def test_a_pressed_robot_passes_where_it_looks() -> None:
    mates = robot(0.2, 0.0, number=2), robot(-3.7, 0.0, number=3)
    marker, presser = robot(0.2, 0.8, number=5), robot(-2.0, 0.45, number=6)
    for theirs, receiver in (((marker,), 3), ((marker, presser), 2)):
        keeper = Keeper(ChooseSafePass(enough=0.01, least=0.01), *mates)
        assert keeper.at(0.0, *theirs) is Status.SUCCESS
        chosen = keeper.alone.store.pass_
        assert chosen is not None
        assert chosen.receiver == receiver


@pytest.mark.parametrize(("speed", "status"), [(0.0, Status.FAILURE), (-2.0, Status.SUCCESS)])
def test_an_opponent_that_comes_before_the_kick_ends_the_waiting(speed: float, status: Status) -> None:
    comes = robot(-0.9, -0.2, number=6, velocity=(speed, 0.0, 0.0))
    keeper = Keeper(ChooseSafePass(enough=1.0, least=0.0), robot(-2.0, 1.6, number=3))
    assert keeper.at(0.0, comes) is status


def test_without_a_mate_there_is_no_pass() -> None:
    assert Keeper(ChooseSafePass()).at(0.0) is Status.FAILURE


@pytest.mark.parametrize("setting", ["patience", "turn_speed"])
def test_times_and_speeds_are_positive(setting: str) -> None:
    with pytest.raises(ValueError, match=f"{setting} must be positive"):
        ChooseSafePass(**{setting: 0.0})
