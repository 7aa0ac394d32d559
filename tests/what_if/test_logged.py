"""Moments of league logs: their robots are played on by robobt's team."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.league.log.files import LogKind, LogWriter
from robobt.league.serve.served_field import served_line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.what_if import Branches, load_logged
from robobt.world import DIVISION_B, RobotId, Team
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, RefereeCommand
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three seconds of a served field in open play, on which one robot drives."""
    path = tmp_path_factory.mktemp("logs") / "game.log.gz"
    field, publisher = served_line_up(DIVISION_B, 2, "default"), RefereePublisher()
    with LogWriter(path) as log, SimServer(field, free_endpoints(), epoch=1.7e9, log=log) as server:
        for _ in range(180):
            field.command(RobotId(Team.YELLOW, 0), RobotCommand(0.5))
            server.step()
            server.send_due(field.time)
            time = 1.7e9 + field.time
            game = GameState(RefereeCommand.FORCE_START)
            log.write(round(time * 1e9), LogKind.REFEREE, publisher.write(game, time))
    return path


def test_a_league_log_is_played_on_with_its_robots_and_its_speeds(log: Path) -> None:
    logged = load_logged(log)
    assert not logged.known
    assert logged.recording.path == log
    plays = {str(robot): setup.play for robot, setup in logged.scenario.robots}
    assert sorted(plays.values()).count("team_goalkeeper") == 2
    branches = Branches(logged, seconds=0.5)
    tick = logged.tick(1.5)
    branches.begin(tick)
    followed = branches.play(0, 0, follow=list(Team))
    assert followed.followed == pytest.approx(0.5, abs=0.04)
    assert branches.play(0, 0).followed == 0.0
    branches.close()


def test_another_simulator_can_be_named(log: Path) -> None:
    assert load_logged(log, "grsim").scenario.simulator == {"preset": "grsim"}
