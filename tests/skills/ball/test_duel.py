"""Duel plays as its policy was trained to."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.skills import Duel
from robobt.testing import frame, robot
from tests.models.made_models import network, team_card, write_model
from tests.skills.fixed_world import Alone
from tests.skills.side_by_side import the_leaf_does_what_it_does_in_training


@pytest.mark.parametrize("own", [0, 1], ids=["blue", "yellow"])
def test_it_plays_as_in_training_for_either_team(tmp_path: Path, own: int) -> None:
    the_leaf_does_what_it_does_in_training("Duel", "Duel", tmp_path, own)


def test_it_sees_the_nearest_opponent_and_nobody_behind_where_there_is_none(tmp_path: Path) -> None:
    duel = Alone(Duel(policy=str(write_model(tmp_path, network(23, 4), team_card("Duel", 0, 1)))))
    me, near, far = robot(), robot(1.0, 0.5, number=1), robot(3.0, 2.0, number=2)

    def told(*others: tuple[float, float]) -> object:
        opponents = tuple(robot(x, y, number=number) for number, (x, y) in enumerate(others))
        duel.stop()
        duel.tick(frame(me, (0.5, 0.0), opponents=opponents))
        return duel.command

    alone, both = told(), told(near.position, far.position)
    assert told(near.position) == both
    # Neither is on the way of a shot, so that the lane is free either way.
    assert alone != both
    assert told((-5.0, 0.0)) == alone
