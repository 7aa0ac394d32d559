from __future__ import annotations

from pathlib import Path

import pytest

from robobt.skills.tactics.take_place import TakePlace
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world.geometry import distance
from tests.models.made_models import Onward, among_robots_card, write_model
from tests.skills.fixed_world import Alone, moved
from tests.skills.refereed import OPEN


def test_it_drives_to_the_place_of_the_plan() -> None:
    alone = Alone(TakePlace())
    me, mate = robot(-2.0, 0.0, number=1), robot(0.5, 0.5, number=2)
    plan = alone.store.team.plan
    plan.players.update((1, 2))
    view = frame(me, (1.0, 0.5), (mate,), game=OPEN)
    alone.tick(view, 1)
    place = plan.places[1]
    before = distance(me.position, place)
    for step in range(1, 12):
        view = frame(me, (1.0, 0.5), (mate,), time=step / 60, game=OPEN)
        assert alone.tick(view, 1) is Status.RUNNING
        me = moved(me, alone.command, 1 / 60)
    assert distance(me.position, place) < before - 0.03


@pytest.mark.parametrize(("heading", "turns"), [(0.45, False), (0.7, True)])
def test_it_looks_only_roughly_at_the_ball(heading: float, turns: bool) -> None:
    alone, me = Alone(TakePlace()), robot(-2.0, 0.0, heading=heading, number=1)
    alone.store.team.plan.players.update((1, 2))
    alone.tick(frame(me, (1.0, 0.0), (robot(0.9, 0.0, number=2),), game=OPEN), 1)
    assert (abs(alone.command.omega) > 0.1) is turns


def test_its_way_is_the_same_where_its_path_is_drawn() -> None:
    view = frame(
        robot(-2.0, 0.0, number=1),
        (1.0, 0.5),
        (robot(0.5, 0.5, number=2), robot(-2.0, 0.4, number=3)),
        game=OPEN,
    )
    commands = []
    for layers in ((), ("paths",)):
        alone = Alone(TakePlace())
        alone.store.team.plan.players.update((1, 2, 3))
        alone.store.draw.want(layers, set())
        view.made.clear()
        alone.tick(view, 1)
        commands.append(alone.command)
    assert commands[0] == commands[1]
    assert commands[0].vx != 0.0


def test_a_robot_without_a_place_fails() -> None:
    alone = Alone(TakePlace())
    assert alone.tick(frame(robot(number=1), (1.0, 0.5), game=OPEN), 1) is Status.FAILURE


def test_a_policy_drives_it_there_among_robots(tmp_path: Path) -> None:
    policy = write_model(tmp_path, Onward(), among_robots_card())
    alone, by_hand = Alone(TakePlace(policy=str(policy))), Alone(TakePlace())
    me, mate = robot(-2.0, 0.0, number=1), robot(0.5, 0.5, number=2)
    for each in (alone, by_hand):
        each.store.team.plan.players.update((1, 2))
        each.tick(frame(me, (1.0, 0.5), (mate,), game=OPEN), 1)
    assert alone.tree.feedback_message == "to its place as learned"
    place = alone.store.team.plan.places[1]
    # The way is free: straight on at the speed of a full action, where the planner is as fast as it can.
    way = distance(me.position, place)
    told = alone.command.vx / 1.5, alone.command.vy / 1.5
    assert told == pytest.approx(((place[0] - me.x) / way, (place[1] - me.y) / way), abs=1e-4)
    assert abs(by_hand.command.vx) > 1.9 * abs(alone.command.vx)
