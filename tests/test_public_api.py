"""``import robobt`` gives the names of a first session, and costs nothing."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import robobt
from robobt.learning.training.run_folder import RunFolderError
from robobt.match import MatchResult
from robobt.plays import PLAYS
from robobt.skills import Stop
from tests.match.scripted import PlainWorld
from tests.registries import temporarily

STUB = Path(robobt.__file__).with_suffix(".pyi")


def test_the_stub_declares_each_name_from_the_place_it_is_taken_from() -> None:
    declared = {
        alias.name: node.module
        for node in ast.parse(STUB.read_text()).body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    rooms = dict.fromkeys(robobt._ROOMS, "robobt")
    assert declared == {name: f"robobt.{home}" for name, home in robobt._HOMES.items()} | rooms


def test_every_room_is_reached_from_robobt_without_an_import_of_its_own() -> None:
    there = {path.parent.name for path in STUB.parent.glob("*/__init__.py")}
    assert set(robobt._ROOMS) == there - {"cli", "config"}
    code = "import robobt; print(robobt.plays.import_file.__name__, robobt.match.load_recording.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["import_file", "load_recording"], done.stderr
    for room in robobt._ROOMS:
        assert getattr(robobt, room) is import_module(f"robobt.{room}")
        assert room in dir(robobt)


def rooms() -> dict[str, list[str]]:
    """The rooms that import names when they are first used, each with those names."""
    found = {}
    for path in sorted(STUB.parent.glob("*/__init__.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "_HOMES":
                found[path.parent.name] = list(ast.literal_eval(node.value))
    return found


@pytest.mark.parametrize("room", rooms())
def test_a_room_declares_each_name_from_the_place_it_is_taken_from(room: str) -> None:
    package = import_module(f"robobt.{room}")
    declared = {
        alias.name: node.module
        for block in ast.parse(Path(package.__file__).read_text()).body
        if isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert declared == {name: f"robobt.{room}.{home}" for name, home in package._HOMES.items()}


@pytest.mark.parametrize(
    ("room", "name"), [(room, name) for room, names in rooms().items() for name in names]
)
def test_a_name_of_a_room_can_be_used(room: str, name: str) -> None:
    package = import_module(f"robobt.{room}")
    found = getattr(package, name)
    assert found is not None
    assert not isinstance(found, ModuleType), "a module of that name would hide it"
    assert name in dir(package)


@pytest.mark.parametrize("room", rooms())
def test_an_unknown_name_of_a_room_is_an_attribute_error(room: str) -> None:
    with pytest.raises(AttributeError, match=f"module 'robobt.{room}' has no attribute 'nothing'"):
        import_module(f"robobt.{room}").nothing  # noqa: B018


@pytest.mark.parametrize("name", ["Match", "play_match", "run_trials"])
def test_there_is_one_of_what_users_play_with(name: str) -> None:
    modules = [import_module(f"robobt.{path.parent.name}") for path in STUB.parent.glob("*/__init__.py")]
    assert [module.__name__ for module in modules if hasattr(module, name)] == []


@pytest.mark.parametrize("name", robobt.__all__)
def test_a_public_name_can_be_used(name: str) -> None:
    assert getattr(robobt, name) is not None
    assert name in dir(robobt)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'play_mach'"):
        robobt.play_mach  # type: ignore[attr-defined]  # noqa: B018


def test_importing_it_imports_nothing_heavy() -> None:
    code = "import robobt, sys; print({'numpy', 'torch', 'pydantic', 'numba', 'pymunk'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


@pytest.mark.integration
def test_a_match_without_a_learned_skill_needs_no_torch() -> None:
    code = (
        "import sys; sys.modules['torch'] = None; import robobt\n"
        "print(robobt.play_match(robobt.load_scenario('table4_trial1_own').lasting(0.1)).ticks)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(done.stdout) > 1


def test_trials_are_played_in_the_simulator_unless_another_world_is_given() -> None:
    scenario = robobt.load_scenario("table4_trial1_own").lasting(0.5)
    run = robobt.run_trials(scenario, 2, seed=3)
    assert [result.trial for result in run.results] == [0, 1]
    assert (
        run.summary().trace == robobt.run_trials(scenario, 2, seed=3, world=robobt.sim_world).summary().trace
    )
    assert run.summary().trace != robobt.run_trials(scenario, 2, seed=3, world=PlainWorld).summary().trace


def test_a_match_has_the_scenarios_seed_unless_another_is_given() -> None:
    scenario = robobt.load_scenario("table4_trial1_own").lasting(0.2)
    result = robobt.play_match(scenario)
    assert isinstance(result, MatchResult)
    assert result.seed == scenario.seed
    assert robobt.play_match(scenario, 5).seed == 5


def test_a_world_may_be_an_address() -> None:
    scenario = robobt.load_scenario("striker_vs_goalkeeper")
    with pytest.raises(ValueError, match="league://nobody"):
        robobt.run_trials(scenario, 1, world="league://nobody")


def test_a_function_that_returns_a_tree_becomes_a_play() -> None:
    with temporarily(PLAYS):

        @robobt.play
        def waits() -> Stop:
            return Stop()

        @robobt.play("waits_too")
        def other() -> Stop:
            return Stop()

        assert (PLAYS["waits"], PLAYS["waits_too"]) == (waits, other)
        with pytest.raises(ValueError, match="play 'waits' is registered twice"):
            robobt.play("waits")(other)
    assert "waits" not in PLAYS


def test_variants_are_compared_with_the_first_trial_by_trial() -> None:
    scenario = robobt.load_scenario("table4_trial1_own").lasting(4.0)
    still = scenario.with_robot("blue 0", play="stand_still")
    found = robobt.compare({"as it is": scenario, "still": still}, 3, seed=2)
    assert list(found) == ["as it is", "still"]
    assert found["as it is"].against_first is None
    assert found["as it is"].to_ball.n == 3
    assert (found["still"].trials, found["still"].to_ball.n) == (3, 0)
    assert found["still"].against_first is not None
    alone = robobt.run_trials(scenario, 3, seed=2).summary()
    assert alone.goals["blue"].trials == found["as it is"].scored


def test_a_comparison_needs_two_variants() -> None:
    with pytest.raises(ValueError, match="needs two variants, not 1"):
        robobt.compare({"alone": robobt.load_scenario("striker_vs_goalkeeper")})


def test_a_comparison_that_is_stopped_is_no_comparison(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(match: object) -> bool:
        raise KeyboardInterrupt

    monkeypatch.setattr("robobt.match.loop.MatchLoop.tick", stopped)
    scenario = robobt.load_scenario("striker_vs_goalkeeper")
    with pytest.raises(KeyboardInterrupt):
        robobt.compare({"a": scenario, "b": scenario}, 2)


@pytest.mark.integration
def test_a_task_is_trained_and_its_policy_plays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    fewer = {"evaluation.starts": 20, "evaluation.held_out": 20}
    run = robobt.train("go_to_ball", steps=2000, seed=4, changes=fewer)
    assert run.folder == Path("runs/go_to_ball-fast")
    assert (run.figures["seed"], run.figures["held_out"]["starts"]) == (4, 20)
    model = run.export("mine")
    assert model == Path("models/mine.pt")
    scenario = robobt.load_scenario("table4_trial1_own").lasting(0.1)
    assert robobt.play_match(scenario.with_robot("blue 0", policy="mine")).robots["blue 0"].errors == 0
    with pytest.raises(RunFolderError):
        robobt.train("go_to_ball", steps=2000, seed=4, changes=fewer)
