"""The fixtures that pytest finds wherever robobt is installed, and the functions behind them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest

from robobt.skills import FaceBall, HasBall, Skill, Store
from robobt.testing import Ticker, frame, held, robot
from robobt.testing.plugin import pytest_assertrepr_compare
from robobt.testing.ticking import Statuses
from robobt.tree import Selector, Status, TreeError, Wait

ROOT = Path(__file__).parents[2]
S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING

MakeStore = Callable[..., Store]


class Raises(Skill):
    """Divides by where the ball is."""

    def on_running(self) -> Status:
        return self.succeed(str(1 / self.ball.x))


def test_a_store_has_a_robot_and_a_ball_before_it(make_store: MakeStore) -> None:
    store = make_store()
    assert (store.me.id, store.me.position, store.frame.ball.position) == (0, (0.0, 0.0), (1.0, 0.0))


def test_a_store_has_the_frame_robot_and_entries_it_is_made_with(make_store: MakeStore) -> None:
    seen = frame(robot(number=2), mates=(robot(1.0, number=4),), time=3.0)
    assert make_store(seen).me.id == 2
    store = make_store(seen, 4, target=(2.0, 1.0))
    assert (store.me.x, store.time, store.target) == (1.0, 3.0, (2.0, 1.0))


def test_a_store_needs_a_robot_on_the_field(make_store: MakeStore) -> None:
    with pytest.raises(ValueError, match="robot 5 is not on the field"):
        make_store(number=5)
    with pytest.raises(ValueError, match="there is no robot"):
        make_store(replace(frame(robot()), own=()))


def test_a_skill_is_ticked_once_on_each_frame(tick_on: Ticker) -> None:
    me = robot(1.0)
    assert tick_on(HasBall(), [frame(me, held(me)), frame(me, (3.0, 0.0))]) == [S, F]


def test_a_second_call_goes_on_where_the_first_ended(tick_on: Ticker) -> None:
    wait = Wait(seconds=1.0)
    frames = [frame(robot(), time=time) for time in (5.0, 5.5, 6.0)]
    assert [tick_on(wait, [one]) for one in frames] == [[R], [R], [S]]


def test_another_store_begins_anew(tick_on: Ticker, make_store: MakeStore) -> None:
    wait, late = Wait(seconds=1.0), [frame(robot(), time=time) for time in (5.0, 6.0)]
    assert tick_on(wait, late[:1]) == [R]
    assert tick_on(wait, late[1:], make_store()) == [R]


def test_the_command_is_in_the_store_and_stands_still_before_each_tick(
    tick_on: Ticker, make_store: MakeStore
) -> None:
    store = make_store()
    assert tick_on(FaceBall(), [frame(robot(), (0.0, 2.0))], store) == [R]
    assert store.command.omega > 0.0
    me = robot()
    tick_on(HasBall(), [frame(me, held(me))], store)
    assert store.command.omega == 0.0


def test_the_robot_is_the_stores(tick_on: Ticker, make_store: MakeStore) -> None:
    me, mate = robot(number=1), robot(2.0, number=3)
    seen = frame(me, held(mate), mates=(mate,))
    assert tick_on(HasBall(), [seen]) == [F]
    assert tick_on(HasBall(), [seen], make_store(seen, 3)) == [S]


def test_a_skill_that_raises_fails_the_test(tick_on: Ticker) -> None:
    with pytest.raises(TreeError, match="Raises: ZeroDivisionError"):
        tick_on(Raises(), [frame(robot())])


def test_a_status_comes_with_what_the_node_said_that_decided(tick_on: Ticker) -> None:
    me = robot()
    found = tick_on(Selector("try", memory=False, children=[HasBall(), FaceBall()]), [frame(me, (0.0, 2.0))])
    assert found == [R]
    assert found.said == ["try/FaceBall: turning"]
    found = tick_on(HasBall(), [frame(me, held(me)), frame(me, (3.0, 0.0))])
    assert found.said == ["HasBall", "HasBall: it does not have the ball"]


IN_FOLDERS = """
import os, pytest, sys
for folder in sys.argv[1:]:
    os.chdir(folder)
    # The plugin by the name that the entry point has.
    pytest.main(["-q", "-p", "robobt.testing.plugin"])
    print(end=chr(0))
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(folder):
            del sys.modules[name]
    sys.path.remove(folder)
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What pytest says of tests of three skills, of which two have one name, in two processes."""
    page = (ROOT / "docs" / "testing.md").read_text()
    skill, test = [block.partition("```")[0] for block in page.split("```python\n")[1:3]]
    files = {
        "reason": {"test_it.py": CARRIES},
        "right": {"circle_ball.py": skill, "test_circle_ball.py": test},
        "wrong": {
            "circle_ball.py": skill.replace("radius: float = 0.6", "radius: float = 0.05"),
            "test_circle_ball.py": test,
        },
    }
    folders = [tmp_path_factory.mktemp(name) for name in files]
    for folder, texts in zip(folders, files.values(), strict=True):
        for file, text in texts.items():
            (folder / file).write_text(text)
    # Without the plugins of all other packages, which take half a second to import.
    environment = dict(os.environ, PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")
    reports: list[str] = []
    for part in (folders[:2], folders[2:]):
        command = [sys.executable, "-c", IN_FOLDERS, *map(str, part)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        *told, rest = done.stdout.split("\0")
        assert rest == "", done.stderr
        reports += told
    return dict(zip(files, reports, strict=True))


def test_the_entry_point_has_the_name_that_keeps_it_from_being_loaded_twice() -> None:
    import tomllib

    project: Mapping[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    ((name, value),) = project["entry-points"]["pytest11"].items()
    assert name == value
    assert EntryPoint(name, value, "pytest11").load().__name__ == "robobt.testing.plugin"


def test_the_plugin_imports_nothing_heavy() -> None:
    code = (
        "import robobt.testing.plugin, sys\n"
        "print({'numpy', 'py_trees', 'pydantic', 'numba', 'torch', 'robobt.skills'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


CARRIES = """
from robobt import Skill, Status
from robobt.testing import frame, held, robot
class Carry(Skill):
    def on_running(self):
        return self.run('carries it') if self.me.ball_contact else self.fail('lost the ball')
def test_it(tick_on):
    near, held_by = robot(), robot(contact=True)
    frames = [frame(held_by, held(held_by)), frame(near, held(near))]
    assert tick_on(Carry(), frames) == [Status.RUNNING, Status.RUNNING]
"""


@pytest.mark.integration
def test_a_wrong_status_is_reported_with_the_reason_of_the_skill(said: dict[str, str]) -> None:
    assert "E       assert [RUNNING, FAILURE] == [RUNNING, RUNNING]" in said["reason"]
    assert "E         tick 1: FAILURE (Carry: lost the ball), not RUNNING" in said["reason"]
    assert "tick 0" not in said["reason"]


def test_statuses_beside_something_else_are_left_to_pytest() -> None:
    assert pytest_assertrepr_compare("==", Statuses(), Status.SUCCESS) is None


@pytest.mark.integration
def test_the_example_of_the_page_is_a_test_that_passes(said: dict[str, str]) -> None:
    assert "5 passed" in said["right"]


@pytest.mark.integration
def test_the_example_of_the_page_fails_when_the_skill_is_wrong(said: dict[str, str]) -> None:
    assert "not always: not: it touches the ball" in said["wrong"]
    assert "trial.py" not in said["wrong"], "the failure is shown in the test, not inside of robobt"
