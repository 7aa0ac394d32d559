from __future__ import annotations

from robobt.skills.tactics.take_place import TakePlace
from robobt.tree import Status
from robobt.world.geometry import distance
from tests.skills.fixed_world import Alone, frame, moved, robot
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


def test_a_robot_without_a_place_fails() -> None:
    alone = Alone(TakePlace())
    assert alone.tick(frame(robot(number=1), (1.0, 0.5), game=OPEN), 1) is Status.FAILURE
