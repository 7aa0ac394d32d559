"""Records name the numbers of the simulator's arrays, and share their memory."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Annotated

import numpy as np
import pytest
from pydantic import BaseModel

from robobt.sim import Arenas, preset
from robobt.sim.records import Records, filled, size
from robobt.world import DIVISION_B
from robobt.world.compiled import Index, numbers_of, record_dtype

COPIES: dict[str, Callable[[Arenas], Arenas]] = {
    "pickled": lambda arenas: pickle.loads(pickle.dumps(arenas)),
    "copied": copy.deepcopy,
}


class Spring(BaseModel):
    stiffness: float = 2.0
    kind: str = "steel"
    longest: float | None = None


class Hand:
    angle: float
    turns: Index


class Clock:
    spring: Spring
    hands: Annotated[Records[Hand], 2]
    weight: float


class Made:
    spring = tuple(numbers_of(Spring()))
    weight = 3.0


def test_a_record_has_the_numbers_of_settings_and_of_other_records() -> None:
    numbers = filled(record_dtype(Clock), Made(), hands=[(0.5, 1), (1.5, 2)])
    assert numbers["spring"]["stiffness"] == 2.0
    assert numbers["spring"]["longest"] == np.inf
    assert numbers["hands"]["angle"].tolist() == [0.5, 1.5]
    assert numbers["hands"]["turns"].tolist() == [1, 2]
    assert numbers["weight"] == 3.0


def test_an_array_viewed_as_records_is_the_same_array() -> None:
    numbers = np.zeros((3, size(record_dtype(Clock))))
    numbers.view(record_dtype(Clock))["weight"][1] = 7.0
    assert numbers[:, -1].tolist() == [0.0, 7.0, 0.0]


def test_a_field_that_nothing_fills_is_an_error() -> None:
    with pytest.raises(AttributeError, match="hands"):
        filled(record_dtype(Clock), Made())


@pytest.mark.parametrize("how", COPIES)
def test_a_copy_of_arenas_has_parameters_of_its_own(how: str) -> None:
    arenas = Arenas(DIVISION_B, [None], preset("default"), 0.025, 2)
    arenas.place(np.zeros((2, 1, 3)), np.tile([1.0, 1.0, 2.0, 0.0], (2, 1)))
    other = COPIES[how](arenas)
    other.arena_parameters["ball"]["roll_deceleration"][1] *= 3
    other.robot_parameters["max_speed"][0] = 0.1
    ahead = np.zeros((2, 1, 6))
    ahead[..., 0] = 1.0
    for _ in range(20):
        arenas.step(ahead)
        other.step(ahead)
    assert other.balls[0, 2] == arenas.balls[0, 2] > other.balls[1, 2]
    assert other.robots[0, 0, 3] < 0.11 < arenas.robots[0, 0, 3] == other.robots[1, 0, 3]
