"""What a person does to a match while it is played."""

from collections.abc import Iterator
from math import hypot, pi
from pathlib import Path

import numpy as np
import pytest

from robobt.match import MatchLoop
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import Scenario, load_scenario, scenario_from
from robobt.match.steering import Steering, SteeringError
from robobt.world import Frame, RobotCommand, RobotId, RobotState, Team
from robobt.world.game import RefereeCommand
from robobt.world.protocol import WrappedWorld
from robobt.worlds import sim_world

STRIKER, KEEPER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("striker_vs_goalkeeper")


@pytest.fixture
def match(scenario: Scenario, tmp_path: Path) -> Iterator[MatchLoop]:
    with MatchLoop(scenario, 5, sim_world, tmp_path / "m.robobt.arrows") as match:
        match.tick()
        yield match


def events(tmp_path: Path) -> list[str]:
    return [event.kind for event in load_recording(tmp_path / "m.robobt.arrows").events]


def test_what_is_moved_is_there_and_in_the_recording(match: MatchLoop, tmp_path: Path) -> None:
    steering = Steering(match)
    steering.move_ball(1.0, -0.5, 2.0, 0.0)
    steering.move_robot(KEEPER, 3.0, 1.0, 3 * pi / 2)
    truth = match.world.truth()
    assert (truth.ball.x, truth.ball.y, truth.ball.vx) == (1.0, -0.5, 2.0)
    keeper = truth.opponents[0]
    assert (keeper.x, keeper.y, keeper.heading) == pytest.approx((3.0, 1.0, -pi / 2))
    match.tick()
    match.tick()
    assert match.world.truth().ball.x > 1.03
    match.close()
    assert events(tmp_path)[:2] == ["ball moved", "robot moved"]
    assert load_recording(tmp_path / "m.robobt.arrows").frame(1).ball.x == pytest.approx(1.0, abs=1e-4)


def test_a_robot_that_was_taken_off_is_not_there_until_it_is_put_back(match: MatchLoop) -> None:
    steering = Steering(match)
    steering.take_off(KEEPER)
    for _ in range(3):
        assert match.tick()
    assert match.world.observe().opponents == match.world.truth().opponents == ()
    steering.move_robot(KEEPER, 4.0, 0.0, pi)
    match.tick()
    (keeper,) = match.world.truth().opponents
    assert keeper.x == pytest.approx(4.0, abs=0.05)


def test_what_a_driver_changes_in_the_frame_is_restored(
    match: MatchLoop, caplog: pytest.LogCaptureFixture
) -> None:
    seen: list[Frame] = []

    def drive(view: Frame, me: RobotState) -> RobotCommand:
        seen.append(view)
        view.ball.x += 1.0
        return RobotCommand()

    steering = Steering(match)
    steering.drive(STRIKER, drive)
    for _ in range(3):
        match.tick()
    assert [view.ball.x for view in seen] == pytest.approx([match.world.truth().ball.x] * 3, abs=0.1)
    assert caplog.text.count("changed the frame") == 1
    steering.drive(STRIKER, None)
    match.tick()


@pytest.mark.parametrize("place", [(20.0, 0.0), (0.0, -9.0), (float("nan"), 0.0)])
def test_nothing_is_put_outside_the_walls(match: MatchLoop, place: tuple[float, float]) -> None:
    with pytest.raises(SteeringError, match=r"outside the walls|not finite"):
        Steering(match).move_ball(*place)


def test_what_is_no_simulator_of_ours_moves_nothing(scenario: Scenario) -> None:
    class Field(WrappedWorld):
        @property
        def movable(self) -> bool:
            return False

    with MatchLoop(scenario, 5, lambda scenario: Field(sim_world(scenario))) as match:
        steering = Steering(match)
        assert not steering.movable
        for move in (
            lambda: steering.move_ball(0.0, 0.0),
            lambda: steering.move_robot(STRIKER, 0.0, 0.0, 0.0),
            lambda: steering.take_off(STRIKER),
        ):
            with pytest.raises(SteeringError, match="nothing can be moved"):
                move()


def test_another_play_is_played_and_begins_another_recording(match: MatchLoop, tmp_path: Path) -> None:
    steering = Steering(match)
    steering.play(STRIKER, "stand_still", {})
    for _ in range(5):
        match.tick()
    assert match.world.truth().own[0].speed < 0.2
    match.close()
    first, second = (load_recording(tmp_path / f"m{part}.robobt.arrows") for part in ("", "-2"))
    assert len(first) == 1
    assert len(second) == 5
    assert second.header.robots[0].play == "stand_still"
    assert second.events[0].kind == "plays"


def test_parameters_of_a_play_are_changed_and_checked(match: MatchLoop) -> None:
    steering = Steering(match)
    before = {parameter.name: value for parameter, value in steering.parameters(STRIKER)}
    assert before["max_distance"] == 1.5
    steering.play(STRIKER, "attack_main", {"max_distance": 0.7})
    after = {parameter.name: value for parameter, value in steering.parameters(STRIKER)}
    assert after["max_distance"] == 0.7
    match.tick()
    for wrong in ({"max_distance": "far"}, {"no_such": 1}):
        with pytest.raises(SteeringError):
            steering.play(STRIKER, "attack_main", wrong)
    with pytest.raises(SteeringError, match="no play is called"):
        steering.play(STRIKER, "no_such_play", {})
    assert {parameter.name: value for parameter, value in steering.parameters(STRIKER)} == after


def test_a_play_with_other_parameters_is_captured_with_them(match: MatchLoop, tmp_path: Path) -> None:
    def shown() -> list[str]:
        return [node.detail for node in match.capture().header.robots[0].tree]

    steering = Steering(match)
    before = match.capture()
    assert not any("max_distance=0.7" in detail for detail in shown())
    steering.play(STRIKER, "attack_main", {"max_distance": 0.7})
    assert any("max_distance=0.7" in detail for detail in shown())
    after = match.capture()
    assert after is not before
    steering.play(STRIKER, "attack_main", {"max_distance": 0.7})
    assert match.capture() is after
    match.tick()
    match.close()
    recording = load_recording(tmp_path / "m-2.robobt.arrows")
    assert any("max_distance=0.7" in node.detail for node in recording.header.robots[0].tree)


def test_a_skill_with_other_parameters_begins_another_recording(match: MatchLoop, tmp_path: Path) -> None:
    steering = Steering(match)
    robot = match.capture().header.robots[0]
    path = next(node.path for node in robot.tree if node.type == "GoToBall")
    number = next(it for it, value in steering.parameters(STRIKER, path) if isinstance(value, float))
    steering.change_skill(STRIKER, path, {number.name: 0.123})
    assert {it.name: value for it, value in steering.parameters(STRIKER, path)}[number.name] == 0.123
    for _ in range(4):
        match.tick()
    with pytest.raises(SteeringError, match="no such parameter"):
        steering.change_skill(STRIKER, path, {"no_such": 1})
    with pytest.raises(SteeringError, match="no node"):
        steering.change_skill(STRIKER, "no/such/node", {})
    match.close()
    recording = load_recording(tmp_path / "m-2.robobt.arrows")
    assert len(recording) == 4
    assert "R" in recording.letters_at(STRIKER, 3)
    node = next(node for node in recording.header.robots[0].tree if node.path == path)
    assert f"{number.name}=0.123" in node.detail


def test_a_play_that_cannot_be_built_leaves_the_match_as_it_is(
    match: MatchLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    def breaks(self: object) -> None:
        raise ZeroDivisionError("no tree")

    steering = Steering(match)
    before = steering.player(STRIKER).runner
    monkeypatch.setattr("robobt.match.scenario.robots.RobotSetup.build_tree", breaks)
    with pytest.raises(SteeringError, match="no tree"):
        steering.change_skill(STRIKER, "any", {})
    assert steering.player(STRIKER).runner is before
    assert match.tick()


def test_the_referee_takes_orders(tmp_path: Path) -> None:
    with MatchLoop(load_scenario("three_v_three"), 5, sim_world, tmp_path / "m.robobt.arrows") as match:
        steering = Steering(match)
        match.tick()
        for order, team, command in (
            ("halt", None, RefereeCommand.HALT),
            ("continue", None, RefereeCommand.STOP),
            ("force start", None, RefereeCommand.FORCE_START),
            ("stop", None, RefereeCommand.STOP),
            ("penalty", Team.YELLOW, RefereeCommand.STOP),
        ):
            steering.order(order, team)  # type: ignore[arg-type]
            match.tick()
            assert match.game.command is command
        assert match.game.restart_team is Team.YELLOW
        with pytest.raises(SteeringError, match="needs a team"):
            steering.order("kick-off", None)
    assert events(tmp_path).count("referee's order") == 5


def test_free_play_takes_no_orders(match: MatchLoop) -> None:
    with pytest.raises(SteeringError, match="nobody referees"):
        Steering(match).order("halt", None)


def test_a_situation_is_a_scenario_that_begins_there(match: MatchLoop) -> None:
    for _ in range(20):
        match.tick()
    steering = Steering(match)
    steering.play(KEEPER, "stand_still", {})
    situation = scenario_from(steering.situation(), "situation")
    truth = match.world.truth()
    with MatchLoop(situation, 0, sim_world) as again:
        frame = again.world.truth()
    assert frame.ball.position == pytest.approx(truth.ball.position, abs=1e-3)
    for before, after in zip(truth.own + truth.opponents, frame.own + frame.opponents, strict=True):
        assert after.position == pytest.approx(before.position, abs=1e-3)
        assert after.heading == pytest.approx(before.heading, abs=1e-3)
    assert situation.robots.yellow[0].play == "stand_still"


def test_a_field_without_robots_is_no_situation_to_begin_from(match: MatchLoop) -> None:
    steering = Steering(match)
    for robot in (STRIKER, KEEPER):
        steering.take_off(robot)
    with pytest.raises(SteeringError, match="no robot is on the field"):
        steering.situation()


def test_any_moment_of_a_match_can_be_begun_from() -> None:
    held = 0
    with MatchLoop(load_scenario("three_v_three"), 5, sim_world) as match:
        steering = Steering(match)
        for tick in range(700):
            assert match.tick()
            if tick % 20:
                continue
            truth = match.world.truth()
            situation = scenario_from(steering.situation(), "situation", build=False)
            began = situation.place(np.random.default_rng(0))
            held += situation.ball.held_by is not None
            begun = {robot: pose[:2] for robot, pose in began.robots.items()}
            moved = [(truth.ball.position, began.ball[:2])]
            moved += [(state.position, begun[robot]) for robot, state in truth.robots().items()]
            outside = max(max(abs(x) - 4.5, abs(y) - 3.0, 0.0) for (x, y), _ in moved)
            for (x, y), after in moved:
                assert hypot(after[0] - x, after[1] - y) < 0.03 + (0.1 + 2.0 * outside if outside else 0.0)
    assert held > 2


def test_what_lies_in_one_place_or_beyond_the_lines_is_moved_a_little(match: MatchLoop) -> None:
    steering = Steering(match)
    x, y = match.world.truth().own[0].position
    match.world.put_robot(KEEPER, x, y, 0.0)
    match.world.put_ball(4.7, 0.2, 0.0, 0.0)
    situation = scenario_from(steering.situation(), "situation", build=False)
    assert situation.ball.position == pytest.approx((4.5, 0.2))
    begun = situation.place(np.random.default_rng(0)).robots
    gap = hypot(begun[STRIKER][0] - begun[KEEPER][0], begun[STRIKER][1] - begun[KEEPER][1])
    assert 0.18 <= gap < 0.19
