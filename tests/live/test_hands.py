"""What a page asks for is done to the match, or it is told why not."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import pytest

from robobt.live.hands import Hands
from robobt.live.messages import Act, ChangeSkill, GiveOrder, MoveBall, Play
from robobt.live.server import Server
from robobt.match import MatchLoop, load_scenario
from robobt.models.find import find_model
from robobt.tree.recording import node_ids
from robobt.world.game import RefereeCommand
from robobt.worlds import sim_world


class Asked:
    """A match and who asks for something."""

    def __init__(self, match: MatchLoop) -> None:
        self.match, self._server = match, Server()
        self.hands = Hands(match, self._server, perf_counter)

    def told(self, act: Act, now: float = 0.0) -> str:
        """Ask for it; return what the page is told."""
        self._server.tell(said=[0, ""])
        self.hands.do(act, now, now)
        said: str = self._server.audience.state["said"][1]
        return said


@pytest.fixture
def asked() -> Iterator[Asked]:
    with MatchLoop(load_scenario("three_v_three"), 3, sim_world) as match:
        yield Asked(match)


def test_a_page_lets_no_file_of_this_machine_be_played(asked: Asked, tmp_path: Path) -> None:
    (tmp_path / "theirs.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    player = asked.match.players[1]
    before = player.runner
    for name in (f"{tmp_path / 'theirs.py'}:play", "/etc/passwd", "no such play"):
        assert asked.told(Play(do="play", robot="blue 1", play=name)).startswith("no play of this match")
    assert not (tmp_path / "ran").exists()
    assert player.runner is before
    assert asked.told(Play(do="play", robot="blue 1", play="stand_still")) == ""
    assert player.runner is not before


def test_a_page_lets_no_model_file_of_this_machine_be_loaded(asked: Asked, tmp_path: Path) -> None:
    player = asked.match.players[1]
    before = player.runner
    shipped = find_model("go_to_ball_ddpg")
    (path,) = (
        path for _, path in node_ids(before.nodes) if path.endswith("pressed/kick away/shoot/SelectShot")
    )
    for name in (str(shipped), f"../{shipped.name}", "theirs.onnx", "sub\\theirs"):
        for act in (
            Play(do="play", robot="blue 1", play="go_to_ball_and_shoot", params={"policy": name}),
            Play(do="play", robot="blue 1", play="go_to_ball_and_shoot", params={"policy": {"in": [name]}}),
            ChangeSkill(do="skill", robot="blue 1", path=path, params={"rater": name}),
        ):
            assert (
                asked.told(act)
                == f"{name!r} is a file: a page names models that are installed, by their names"
            )
    assert player.runner is before
    by_name = Play(
        do="play", robot="blue 1", play="go_to_ball_and_shoot", params={"policy": "go_to_ball_ddpg"}
    )
    assert asked.told(by_name) == ""
    assert player.runner is not before


def test_a_model_file_that_the_scenario_names_may_be_kept(tmp_path: Path) -> None:
    model = str(shutil.copy(find_model("go_to_ball_ddpg"), tmp_path / "mine.pt"))
    setup = {"play": "go_to_ball_and_shoot", "params": {"policy": model}}
    with MatchLoop(load_scenario("three_v_three").with_robot("blue 1", **setup), 3, sim_world) as match:
        asked = Asked(match)
        for robot in ("blue 1", "blue 2"):
            assert asked.told(Play(do="play", robot=robot, **setup)) == ""


def test_the_referee_takes_orders_from_the_first_tick_on(asked: Asked) -> None:
    stop = GiveOrder(do="order", order="stop")
    assert "first tick" in asked.told(stop)
    asked.match.tick()
    assert asked.told(stop) == ""
    asked.match.tick()
    assert asked.match.game.command is RefereeCommand.STOP


def test_what_is_held_is_let_go_when_its_page_falls_silent(asked: Asked) -> None:
    asked.match.tick()
    world = asked.match.world
    assert asked.told(MoveBall(do="ball", x=1.0, y=1.0, held=True), now=10.0) == ""
    for now in (10.1, 10.5, 10.6):
        world.put_ball(0.0, 0.0, 0.0, 0.0)
        asked.hands.hold(now)
        assert (world.truth().ball.x == 1.0) is (now <= 10.5)
