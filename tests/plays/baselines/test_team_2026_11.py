"""The team of November 2026 decides as it always did."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import pytest

from robobt.plays import PLAYS, defender_2026_11, field_player_2026_11, goalkeeper_2026_11
from robobt.skills.store import Store, TeamStore
from robobt.tree import Behaviour, TreeRunner
from robobt.world import DIVISION_B, BallState, Frame, RobotCommand, RobotState, Team
from robobt.world.game import GameState, RefereeCommand, Restart

FILE = Path(__file__).parent / "frames_2026_11.json.gz"
EVERY = 6
"""Frames between two of the file; a robot decides on each as if they came one after the other."""


def six() -> dict[int, Behaviour]:
    return {
        0: goalkeeper_2026_11(),
        1: defender_2026_11(place=0, size=2),
        2: defender_2026_11(place=1, size=2),
        3: field_player_2026_11(),
        4: field_player_2026_11(),
        5: field_player_2026_11(),
    }


def frames() -> list[Frame]:
    """The frames of the file, as blue sees them."""
    read = []
    for time, ball, own, theirs, game in json.loads(gzip.decompress(FILE.read_bytes()))["frames"]:
        command, restart, team, may_touch, placement, penalty = game
        state = GameState(
            RefereeCommand(command),
            restart=None if restart is None else Restart(restart),
            restart_team=None if team is None else Team(team),
            may_touch=may_touch,
            placement=None if placement is None else tuple(placement),
            penalty=None if penalty is None else Team(penalty),
        )
        robots = [
            tuple(RobotState(int(number), *numbers, contact) for number, *numbers, contact in side)
            for side in (own, theirs)
        ]
        read.append(Frame(time, DIVISION_B, BallState(*ball), *robots, Team.BLUE, 1 / 60, state))
    return read


def decisions() -> list[list[float]]:
    """The commands of all robots on every frame."""
    seen, team, trees = frames(), TeamStore(), six()
    first = seen[0]
    stores = {robot.id: Store(first, robot, team=team) for robot in first.own}
    runners = {number: TreeRunner(trees[number], store) for number, store in stores.items()}
    decided = []
    for frame in seen:
        row: list[float] = []
        for me in frame.own:
            store = stores[me.id]
            store.frame, store.me, store.command = frame, me, RobotCommand()
            runners[me.id].tick()
            assert runners[me.id].error is None
            order = store.command
            row += [order.vx, order.vy, order.omega, order.kick_speed, float(order.dribbler)]
        decided.append(row)
    return decided


def test_it_decides_as_in_november_2026() -> None:
    expected = json.loads(gzip.decompress(FILE.read_bytes()))["decisions"]
    for tick, (now, then) in enumerate(zip(decisions(), expected, strict=True)):
        assert now == pytest.approx(then, abs=1e-3), f"frame {tick}"


def test_it_is_played_by_name() -> None:
    assert {"goalkeeper_2026_11", "defender_2026_11", "field_player_2026_11"} <= set(PLAYS)
