from __future__ import annotations

import pytest

from robobt.skills import Stop
from robobt.skills.plan import Task
from robobt.skills.tactics.task_switch import Part, TaskSwitch
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import GameState, Restart, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import (
    HALT,
    OPEN,
    STOP,
    free_kick,
    kickoff,
    penalty,
    penalty_in_play,
    placement,
    stop_before,
)

SPOT = (1.0, 1.0)


def part(game: GameState, *, first: bool) -> str:
    """The part of robot 1, which is nearest to the ball or far from it, of a team of two."""
    switch = TaskSwitch("player", {}, otherwise=Stop())
    alone = Alone(switch)
    other = robot(-2.0 if first else 1.3, 1.0, number=2)
    me = robot(0.7 if first else -2.0, 1.0, number=1)
    alone.store.team.plan.players.update((1, 2))
    alone.tick(frame(me, SPOT, (other,), game=game), 1)
    return switch.feedback_message


@pytest.mark.parametrize(
    ("game", "first", "other"),
    [
        (HALT, "halt", "halt"),
        (STOP, "dead_ball", "dead_ball"),
        (free_kick(Team.BLUE, SPOT), "take_restart", "dead_ball"),
        (free_kick(Team.YELLOW, SPOT), "dead_ball", "dead_ball"),
        (stop_before(Restart.FREE_KICK, Team.BLUE, SPOT), "take_restart", "dead_ball"),
        (kickoff(Team.BLUE, may_touch=False), "take_restart", "kickoff"),
        (kickoff(Team.YELLOW, may_touch=True), "kickoff", "kickoff"),
        (placement(SPOT, Team.BLUE), "place_ball", "dead_ball"),
        (placement(SPOT, Team.YELLOW), "dead_ball", "dead_ball"),
        (penalty(Team.BLUE, SPOT), "take_penalty", "penalty"),
        (penalty(Team.YELLOW, SPOT), "penalty", "penalty"),
        (penalty_in_play(Team.BLUE), "take_penalty", "penalty"),
    ],
)
def test_what_the_referee_wants_comes_first(game: GameState, first: str, other: str) -> None:
    assert part(game, first=True) == first
    assert part(game, first=False) == other


def test_in_play_it_is_the_task_of_the_plan() -> None:
    assert part(OPEN, first=True) == "attack"
    assert part(OPEN, first=False) in {"wall", "support", "mark"}


def test_every_task_is_a_part() -> None:
    assert {task.value for task in Task} <= {each.value for each in Part}


def test_a_robot_takes_part_from_its_first_tick() -> None:
    alone = Alone(TaskSwitch("player", {"attack": Stop()}))
    assert alone.tick(frame(robot(number=4), (0.3, 0.0), game=OPEN), 4) is Status.SUCCESS
    assert alone.store.team.plan.players == {4}


def test_what_the_team_does_without_is_told_to_its_plan() -> None:
    alone = Alone(TaskSwitch("player", {"attack": Stop()}, without="wall"))
    alone.tick(frame(robot(number=4), (0.3, 0.0), game=OPEN), 4)
    assert alone.store.team.plan.without == "wall"


def test_a_misspelt_part_is_an_error_that_lists_the_parts() -> None:
    with pytest.raises(ValueError, match="'atack' is no part; there are halt, take_penalty"):
        TaskSwitch("player", {"atack": Stop()})
