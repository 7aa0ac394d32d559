"""Robots obey the official game controller: all commands, both sides, cards, goalkeepers, stages.

Runs where ``ROBOBT_GAME_CONTROLLER`` names its program: the controller, a served field and
the players step by step under one simulated clock. ``pytest -m slow -s`` prints the table.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from math import hypot
from pathlib import Path
from typing import Any

import pytest

from robobt.league.referee.lockstep import LockstepController
from robobt.league.referee.process import GameControllerProcess
from robobt.league.referee.setup import command, stage
from robobt.league.serve.served_field import served_scenario
from robobt.league.serve.server import SimServer
from robobt.league.wire.messages import Change, Config, Referee
from robobt.league.wire.sockets import Sender
from robobt.match import MatchLoop, load_scenario
from robobt.sim import settings_from
from robobt.world import Frame, RobotId, Team
from robobt.world.game import Stage
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints

BINARY = os.environ.get("ROBOBT_GAME_CONTROLLER", "")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not BINARY, reason="ROBOBT_GAME_CONTROLLER does not name the official program"),
]

HULL = 0.09


class Refereed:
    """A scenario played on a served field under the official controller."""

    def __init__(self, name: str, blue_on_positive_half: bool = False) -> None:
        scenario = load_scenario(name).without_referee().model_copy(update={"period": 1 / 60})
        endpoints = free_endpoints("127.0.0.1")
        settings = settings_from(scenario.simulator)
        self.process = GameControllerProcess(Path(BINARY))
        self.controller = LockstepController(self.process.stream)
        self.server = SimServer(served_scenario(scenario), endpoints)
        self.world = LockstepWorld(
            self.server,
            field=scenario.field,
            robots={robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots},
            settings=settings,
            period=scenario.period,
            simulator="grsim",
            endpoints=endpoints,
            follow_referee=True,
        )
        self._sender = Sender(*endpoints.referee)
        self._frames = 0
        self.message = Referee()
        self.controller.ask(0.0)
        self.controller.answer()
        sides = {Team.BLUE: blue_on_positive_half, Team.YELLOW: not blue_on_positive_half}
        changes = [team_state(team, on_positive_half=side) for team, side in sides.items()]
        # Nothing by itself: the test gives the commands.
        division = Change(update_config_change={"division": "DIV_B", "first_kickoff_team": "BLUE"})
        self.controller.change([division, *changes], Config(auto_continue=False))
        self.match = MatchLoop(scenario, 1, lambda _: self.world)

    def close(self) -> None:
        self.world.close()
        self.server.close()
        self._sender.close()
        self.process.close()

    def play(self, seconds: float, *changes: Change) -> list[Frame]:
        """Play on, after changing the match; return the true frames."""
        frames = []
        for _ in range(round(seconds * 60)):
            self._hear(changes)
            changes = ()
            if not self.match.tick():
                break
            frames.append(self.server.field.truth())
        return frames

    def stop_with_ball_at(self, x: float, y: float) -> None:
        """Put the ball down in a stop, and again once the robots have cleared the place."""
        for _ in range(2):
            self.server.field.place_ball(x, y)
            self.play(2.5, command("STOP"))

    def _hear(self, changes: Sequence[Change] = ()) -> None:
        self._frames += 1
        self.controller.change(changes)
        self.controller.ask(1.0 + self._frames / 60, self.server.field.truth())
        self.message = self.controller.answer()[-1]
        self._sender.send(self.message.SerializeToString())


def team_state(team: Team, **values: Any) -> Change:
    """The change of what the controller knows of a team."""
    wrapped = {name: {"value": value} for name, value in values.items()}
    return Change(update_team_state_change={"for_team": team.name, **wrapped})


@pytest.fixture
def refereed() -> Iterator[Callable[..., Refereed]]:
    opened: list[Refereed] = []

    def open_one(name: str, **options: bool) -> Refereed:
        opened.append(Refereed(name, **options))
        return opened[-1]

    yield open_one
    for one in opened:
        one.close()


def fastest(frame: Frame) -> float:
    return max(robot.speed for robot in frame.robots().values())


def nearest(frame: Frame, team: Team) -> float:
    """Distance of a team's nearest hull to the ball."""
    return min(
        hypot(state.x - frame.ball.x, state.y - frame.ball.y) - HULL
        for robot, state in frame.robots().items()
        if robot.team is team
    )


@pytest.mark.parametrize("name", ["striker_vs_goalkeeper", "attack_vs_goalkeeper_motion_full", "six_v_six"])
def test_halt_and_timeouts_stop_everybody_within_half_a_second(
    name: str, refereed: Callable[..., Refereed]
) -> None:
    game = refereed(name)
    for order, team in (("HALT", None), ("TIMEOUT", Team.BLUE), ("TIMEOUT", Team.YELLOW)):
        moving = game.play(1.5, command("FORCE_START"))
        assert max(map(fastest, moving)) > 0.5
        # On its way down from full speed the robot brakes; after that it stands.
        halted = game.play(2.0, command(order, team))
        still = next(i for i in range(len(halted)) if max(map(fastest, halted[i:])) < 0.05)
        print(f"{name}: {order} {team or ''}: all at rest after {still / 60:.2f} s")
        assert still / 60 <= 0.5


@pytest.mark.parametrize("positive", [False, True], ids=["blue -x", "blue +x"])
def test_no_command_is_ignored(positive: bool, refereed: Callable[..., Refereed]) -> None:
    game = refereed("six_v_six", blue_on_positive_half=positive)
    side = {Team.BLUE: 1.0 if positive else -1.0, Team.YELLOW: -1.0 if positive else 1.0}

    def say(what: str) -> None:
        print(f"blue at {'+' if positive else '-'}x: {what}")

    stop = game.play(4.0, command("STOP"))[120:]
    say(f"STOP: fastest {max(map(fastest, stop)):.2f} m/s")
    assert max(map(fastest, stop)) <= 1.55
    assert all(min(nearest(frame, team) for team in Team) >= 0.49 for frame in stop[60:])
    for team in Team:
        game.stop_with_ball_at(0.0, 0.0)
        frame = game.play(6.0, command("KICKOFF", team))[-1]
        own = [it for robot, it in frame.robots().items() if robot.team is not team]
        say(f"KICKOFF {team.value}: opponents nearest {nearest(frame, team.other):.2f} m")
        assert nearest(frame, team.other) >= 0.49
        assert all(it.x * side[team.other] > -HULL for it in own)
        begun = game.play(6.0, command("NORMAL_START"))
        assert any(frame.ball.speed > 0.5 for frame in begun), "the kick-off is taken"
    for team in Team:
        spot = (1.5 * side[team], 1.0)
        game.stop_with_ball_at(*spot)
        free = game.play(9.0, command("DIRECT", team))
        taken = next(i for i, frame in enumerate(free) if frame.ball.speed > 0.5)
        say(f"DIRECT {team.value}: taken after {taken / 60:.1f} s")
        assert free[taken].last_touch is None or free[taken].last_touch.team is team
        assert min(nearest(frame, team.other) for frame in free[90:taken]) >= 0.45 if taken > 90 else True
    for team in Team:
        game.stop_with_ball_at(2.0 * side[team], -1.5)
        target = {"x": 0.5 * side[team], "y": 1.0}
        spot = Change(set_ball_placement_pos_change={"pos": target})
        placed = game.play(20.0, spot, command("BALL_PLACEMENT", team))
        ball = placed[-1].ball
        off = hypot(ball.x - target["x"], ball.y - target["y"])
        say(f"BALL_PLACEMENT {team.value}: {off * 1000:.0f} mm off after 20 s, {ball.speed:.2f} m/s")
        assert off < 0.15
        assert ball.speed < 0.2
        assert game.message.command == Referee.Command.Value(f"BALL_PLACEMENT_{team.name}")
        assert max(frame.ball.speed for frame in placed) < 2.0, "it is never kicked"
        assert nearest(placed[-1], team.other) >= 0.49
    for team in Team:
        mark = -side[team] * (4.5 - 6.0)
        game.stop_with_ball_at(mark, 0.0)
        ready = game.play(8.0, command("PENALTY", team))[-1]
        keeper = ready.robots()[RobotId(team.other, 0)]
        say(f"PENALTY {team.value}: keeper {abs(abs(keeper.x) - 4.5) * 1000:.0f} mm from its line")
        assert abs(abs(keeper.x) - 4.5) < 0.12
        assert keeper.x * side[team.other] > 0.0
        shot = game.play(10.0, command("NORMAL_START"))
        assert any(frame.ball.speed > 1.0 for frame in shot), "the penalty is taken"


def test_cards_goalkeepers_and_stages_are_obeyed(refereed: Callable[..., Refereed]) -> None:
    game = refereed("six_v_six")
    game.play(2.0, command("STOP"))
    off = game.play(10.0, Change(add_yellow_card_change={"for_team": "YELLOW"}))[-1]
    assert game.message.yellow.max_allowed_bots == 5
    # What the controller counts: not behind the own goal line.
    counted = [state for robot, state in off.robots().items() if robot.team is Team.YELLOW and state.x < 4.59]
    print(f"yellow card: {len(counted)} yellow robots on the field after 10 s")
    assert len(counted) == 5
    kept = game.play(10.0, team_state(Team.BLUE, goalkeeper=3))[-1].robots()
    assert game.message.blue.goalkeeper == 3
    print(f"keeper is blue 3: at x {kept[RobotId(Team.BLUE, 3)].x:.2f}")
    assert kept[RobotId(Team.BLUE, 3)].x < -3.9
    assert kept[RobotId(Team.BLUE, 0)].x > -3.9
    for number, name in enumerate(Referee.Stage.keys()):
        if number == 0:
            continue
        game.play(0.5, stage(Stage(number)))
        print(f"stage {name}: {game.match.game.stage.name}")
        assert game.match.game.stage.name == name
    assert game.match.outcome is not None
    assert game.match.outcome.value == "full_time"
