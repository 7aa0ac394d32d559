"""Whatever happens on the field and is reported, the referee goes on and its state makes sense."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest

from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.world import DIVISION_A, DIVISION_B, BallState, FieldGeometry, Frame, GameState, RobotState, Team
from robobt.world.game import RefereeCommand, Restart
from robobt.world.geometry import Point

EVENTS = 10_000
"""In all."""
FIELDS = ("kick_location", "num_robots_by_team", "max_ball_height", "crash_speed", "reason")
ODD: tuple[Detail, ...] = (None, "", nan, inf, -1, 10**9, (nan, 0.0), (1e9, -1e9), Team.BLUE, True)


def sound(game: GameState) -> None:
    """Check what holds of every state of a game."""
    assert game.may_touch or not game.in_play
    assert (game.restart is None) or (game.restart_team is not None)
    if game.command is RefereeCommand.STOP:
        assert game.upcoming is not None
        assert not game.may_touch
    if game.restart is Restart.BALL_PLACEMENT:
        assert game.placement is not None
    for team in Team:
        status = game.status(team)
        assert status.max_robots is not None
        assert 0 <= status.max_robots <= 11
        assert status.red_cards >= 0
    if game.placement is not None:
        assert abs(game.placement[0]) < 6.0
        assert abs(game.placement[1]) < 4.5


def robots(lot: np.random.Generator, count: int) -> tuple[RobotState, ...]:
    numbers = lot.uniform(-1.1, 1.1, (count, 4))
    return tuple(
        RobotState(i, 6.0 * x, 4.5 * y, vx=3.0 * vx, vy=3.0 * vy) for i, (x, y, vx, vy) in enumerate(numbers)
    )


def frame(lot: np.random.Generator, field: FieldGeometry, time: float, spot: Point | None = None) -> Frame:
    """Make a frame; the ball is anywhere, or at rest where the referee wants it."""
    x, y, vx, vy = lot.uniform(-1.1, 1.1, 4)
    ball = BallState(6.0 * x, 4.5 * y, 8.0 * vx, 8.0 * vy)
    if spot is not None and lot.random() < 0.8:
        ball = BallState(*spot)
    return Frame(
        time, field, ball, robots(lot, int(lot.integers(0, 9))), robots(lot, int(lot.integers(0, 9)))
    )


def happening(lot: np.random.Generator, time: float) -> RefereeEvent:
    kinds, teams = list(EventKind), [None, *Team]
    details: dict[str, Detail] = {}
    if lot.random() < 0.3:
        details = {name: ODD[int(lot.integers(len(ODD)))] for name in FIELDS if lot.random() < 0.5}
    x, y = lot.uniform(-5.0, 5.0, 2)
    kind, team = kinds[int(lot.integers(len(kinds)))], teams[int(lot.integers(len(teams)))]
    return RefereeEvent(time, kind, team, None, float(x), float(y), details)


@pytest.mark.integration
@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
def test_ten_thousand_events_of_any_kind_leave_a_sound_state(field: FieldGeometry) -> None:
    lot = np.random.default_rng(1)
    settings = RefereeSettings(half_length=300.0, extra_length=60.0, shoot_out=True, kickoff_wait=1.0)
    controller = Controller(field, settings, lot)
    controller.update(frame(lot, field, 0.0), ())
    time, told, commands = 0.1, 0, set()
    while told < EVENTS // 2:
        events = [happening(lot, time) for _ in range(max(0, int(lot.integers(-3, 3))))]
        told += len(events)
        decision = controller.update(frame(lot, field, time, controller.game.placement), events)
        sound(decision.game)
        assert {event.kind for event in events} <= {event.kind for event in decision.events} | {
            EventKind.TOO_MANY_ROBOTS
        }
        commands.add(decision.game.command)
        time += (0.02, 0.5, 2.0)[int(lot.integers(3))]
        if lot.random() < 0.01:
            team = list(Team)[int(lot.integers(2))]
            controller.requests.time_out(team)
            controller.requests.substitution(team)
            controller.requests.advantage(team, bool(lot.integers(2)))
            controller.requests.keeper(team, int(lot.integers(12)))
        if decision.game.stage.name == "POST_GAME":
            controller = Controller(field, settings, lot)
            controller.update(frame(lot, field, time), ())
    assert commands == set(RefereeCommand)


@pytest.mark.integration
def test_any_frames_leave_a_sound_state() -> None:
    lot = np.random.default_rng(2)
    referee, time = Referee(DIVISION_B), 0.0
    for _ in range(3000):
        sound(referee.update(frame(lot, DIVISION_B, time)).game)
        time += 0.1
