"""A task in a file of one's own is a task like any other; what is wrong with it is told by line and class."""

from __future__ import annotations

import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robobt.learning import TASKS
from robobt.learning.envs import (
    GoToBallTask,
    ScoreOnGoalkeeperTask,
    ShootTask,
    TaskError,
    Tick,
    find_task,
    make_task,
)
from robobt.learning.envs.make import task_file
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.training.settings import SettingsError, load_settings
from robobt.plays import python_files
from robobt.plays.sources import PythonFileError
from robobt.world.observation import OWN_OBSERVATIONS
from tests.registries import temporarily

OWN = """
import numpy as np
from robobt.learning import TASKS
from robobt.learning.envs import ArenaTask, TaskSettings, start_parts
from robobt.world.observation import entries, own_observation


@own_observation("to_middle", 1, *entries("x y", "m", "far", 2.0))
def TO_MIDDLE(seen):
    return np.column_stack(seen.in_frame_of_me(-seen.me["x"], -seen.me["y"]))


class MiddleSettings(TaskSettings):
    time_limit: int = 40


@TASKS.register("Middle")
class Middle(ArenaTask):
    Settings = MiddleSettings
    observation = TO_MIDDLE

    def sample(self, rng, count):
        rows = np.zeros((count, len(self.start_columns)))
        robots, balls, _ = start_parts(rows, self.robots)
        robots["x"], robots["y"] = rng.uniform(-1.0, 1.0, (2, count, 1))
        balls["x"] = 3.0
        return rows

    def ends(self, tick):
        return np.hypot(tick.now.me["x"], tick.now.me["y"]) < 0.3, tick.goal != 0

    def reward(self, tick):
        far = [np.hypot(each.me["x"], each.me["y"]) for each in (tick.before, tick.now)]
        return {"closer": far[0] - far[1], "there": 1.0 * tick.success}
"""


@pytest.fixture(autouse=True)
def _registered_for_a_test(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    # Else the workers of later tests would import the files of all of these tests.
    monkeypatch.setattr(python_files, "_imported", {})
    with temporarily(TASKS):
        yield
    OWN_OBSERVATIONS.clear()


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("own.py").write_text(OWN)
    return "own.py:Middle"


def test_a_task_has_one_docstring_whether_it_is_read_or_imported() -> None:
    assert all(TASKS.documentation(name) == inspect.getdoc(TASKS[name]) for name in TASKS)
    # The first line is what a terminal shows.
    assert all("`" not in TASKS.documentation(name).partition("\n")[0] for name in TASKS)


def test_its_parts_decide_what_is_seen_earned_and_ended(own: str) -> None:
    task = make_task(find_task(own).Settings(), 8)
    seen = task.reset(0)
    places = task.arenas.robots[:, 0, :2].copy()
    assert seen.shape == (8, 2)
    np.testing.assert_allclose(np.hypot(*seen.T), np.hypot(*places.T))
    towards = np.full((8, 4), -1.0)
    ended = 0
    for _ in range(40):
        towards[:, :2] = seen / np.hypot(*seen.T)[:, None]
        result = task.step(towards)
        seen = result.observation
        if task.ended is not None:
            ended += len(task.ended)
            assert task.ended.success.all()
            np.testing.assert_array_equal(task.ended.terms["there"], 1.0)
            total = task.ended.terms["closer"] + task.ended.terms["there"]
            np.testing.assert_allclose(total, task.ended.total_reward)
    assert ended >= 8


def test_time_ends_what_its_parts_do_not(own: str) -> None:
    task = make_task(find_task(own).Settings(), 4)
    task.reset_to([1.0, 1.0, *[0.0] * 4, 3.0, *[0.0] * 3])
    for _ in range(40):
        result = task.advance(np.zeros((4, 4)) - [0.0, 0.0, 0.0, 1.0])
    assert result.truncated.any()
    assert not result.terminated[result.truncated].any()
    assert task.ended is not None
    assert (task.ended.ticks == 40).all()


@pytest.mark.usefixtures("own")
def test_gymnasium_makes_it_from_its_module() -> None:
    code = "import gymnasium; print(gymnasium.make('own:Middle-v0').reset(seed=0)[0].shape)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "(2,)\n"


def test_a_reward_of_a_shipped_task_is_changed_by_one_method() -> None:
    class Gently(GoToBallTask):
        def reward(self, tick: Tick) -> dict[str, np.ndarray]:
            return {**tick.terms, "jerk": -0.1 * np.abs(tick.actions).sum(axis=1)}

    class Same(GoToBallTask):
        def reward(self, tick: Tick) -> dict[str, np.ndarray]:
            return dict(tick.terms)

    tasks = [make_task(kind.Settings(time_limit=30), 8) for kind in (GoToBallTask, Same, Gently)]
    for task in tasks:
        task.reset(3)
    actions = np.full((8, 3), 0.5)
    for _ in range(60):
        results = [task.step(actions) for task in tasks]
        np.testing.assert_allclose(results[1].reward, results[0].reward)
        np.testing.assert_allclose(results[2].reward, results[0].reward - 0.15)
        for other in results[1:]:
            np.testing.assert_array_equal(other.observation, results[0].observation)
            np.testing.assert_array_equal(other.terminated, results[0].terminated)
            np.testing.assert_array_equal(other.truncated, results[0].truncated)


def test_ends_of_a_shipped_task_are_changed_by_one_method() -> None:
    class Early(GoToBallTask):
        def ends(self, tick: Tick) -> tuple[np.ndarray, np.ndarray]:
            return tick.success, tick.ticks >= 5

    task = make_task(Early.Settings(), 4)
    task.reset(0)
    for _ in range(5):
        result = task.advance(np.zeros((4, 3)))
    assert result.terminated.all()
    assert not result.success.any()


@pytest.mark.parametrize("kind", [GoToBallTask, ShootTask, ScoreOnGoalkeeperTask, SoccerTask])
def test_settings_of_a_shipped_task_may_have_more_numbers(kind: Any) -> None:
    class MoreSettings(kind.Settings):  # type: ignore[misc]
        bonus: float = 2.0

    class More(kind):  # type: ignore[misc]
        Settings = MoreSettings

    tasks = [one(None, 2, seed=1) for one in (kind, More)]
    for task in tasks:
        task.reset()
    for _ in range(30):
        shipped, more = (task.step(np.full((2, task.action_size), 0.5)) for task in tasks)
        np.testing.assert_array_equal(more.reward, shipped.reward)


@pytest.mark.parametrize(
    ("line", "wrong", "said"),
    [
        ("return {", "return {'far': 1.0 / 0, ", r"own\.py:\d+: Middle\.reward: ZeroDivisionError: "),
        (
            "1.0 * tick.success",
            "np.zeros(3)",
            r"Middle\.reward: the term 'there' has the shape",
        ),
        ("1.0 * tick.success", "np.nan", r"Middle\.reward: the term 'there' is not finite"),
        ("< 0.3, tick.goal != 0", "< 0.3", r"Middle\.ends: returns no pair"),
        ("return np.column_stack(", "return np.array(", r"Middle\.observe: makes \(2, 4\) of \(4, 2\)"),
        ("1.0 * tick.success", "'x'", r"Middle\.reward: the term 'there' is no array of numbers"),
        ('"there":', "3:", r"Middle\.reward: 3 is not a name of a term"),
        ("return np.hypot", "raise SystemExit(4); np.hypot", r"own\.py:\d+: Middle\.ends: SystemExit: 4"),
        ('-seen.me["x"], -', 'seen.me["x"] * np.nan, -', r"Middle\.observe: the entry 'x' is not finite"),
        ("def ends", "def oppose(self, c): c[:] = np.nan\n\n    def ends", r"Middle\.oppose: a command"),
        ('balls["x"] = 3.0', "rows[:, 99] = 3.0", r"own\.py:\d+: Middle\.sample: IndexError"),
        ('balls["x"] = 3.0', 'balls["x"] = np.nan', r"Middle\.sample: a start is not finite"),
        (
            "def ends",
            "def begin(self, s, w): self.nothing\n\n    def ends",
            r"own\.py:\d+: Middle\.begin: Attr",
        ),
        (
            "tick.goal != 0",
            'tick.now.me["x"]',
            r"Middle\.ends: returns float64 for other ends, not truth values",
        ),
        (
            "def ends(self, tick):",
            "def ends(self, tick):\n        tick.now.me['x'] += 1.0",
            r"Middle\.ends: .*read-only",
        ),
        ("return rows", "return rows[:1]", r"Middle\.sample: returns starts of the shape \(1, 10\), not"),
        ("return rows", "pass", r"Middle\.sample: returns starts of the shape \(\), not"),
    ],
)
def test_what_is_wrong_in_a_part_is_told_by_line_class_and_part(
    own: str, line: str, wrong: str, said: str
) -> None:
    Path("own.py").write_text(OWN.replace(line, wrong))
    task = make_task(find_task(own).Settings(), 4)

    def play() -> None:
        task.reset(0)
        task.step(np.zeros((4, 4)))

    with pytest.raises(TaskError, match=said):
        play()


def test_a_file_without_the_task_is_told(own: str) -> None:
    with pytest.raises(SettingsError, match=r"own\.py: has no task 'Nobody'; there is own\.py:Middle"):
        load_settings("own.py:Nobody")
    with pytest.raises(PythonFileError, match=r"nowhere\.py: cannot be read"):
        load_settings("nowhere.py:Middle")
    Path("broken.py").write_text("from robobt.learning.envs import ArenaTask\nclass Broken(Nothing): pass\n")
    with pytest.raises(PythonFileError, match=r"broken\.py:2: NameError: name 'Nothing'"):
        load_settings("broken.py:Middle")
    Path("bare.py").write_text("from robobt.learning.envs import ArenaTask\nclass Bare(ArenaTask): pass\n")
    with pytest.raises(SettingsError, match=r"bare\.py:Bare: TypeError: Bare: has no observation"):
        load_settings("bare.py:Bare")
    with pytest.raises(SettingsError, match=r"own\.py: does not say which task; there is own\.py:Middle"):
        load_settings("own.py")
    with pytest.raises(SettingsError, match=r"no task is called 'own:Middle'; write own\.py:Middle"):
        load_settings("own:Middle")


@pytest.mark.parametrize(
    ("line", "wrong", "said"),
    [
        ('"far", 2.0', '"fra", 2.0', "the entry 'x' has no known range, 'fra'; .* did you mean far"),
        (
            '"far", 2.0',
            '"far", "max_sped"',
            r"own\.py:\d+: .* of the entry 'x' must be a number, max_speed or",
        ),
        ("observation = TO", "robots = 0\n    observation = TO", "Middle: robots must be at least 1, not 0"),
        (
            "observation = TO",
            "learners = (5,)\n    observation = TO",
            r"learners must be of the robots 0, not \(5",
        ),
        ("(TaskSettings)", "", "own.py:.* Middle: Settings must be a subclass of TaskSettings"),
        (
            "observation = TO",
            "robots, learners = 2, (1,)\n    observation = TO",
            r"learners must be \(0,\), not \(1",
        ),
        ("time_limit: int = 40", "time_limit: int = 0", "decide_every and time_limit must be at least 1"),
        ('"far", 2.0', '"far", 0.0', "the scale of the entry 'x' must be above 0, not 0.0"),
    ],
)
def test_what_is_wrong_in_a_declaration_is_told_before_anything_is_trained(
    own: str, line: str, wrong: str, said: str
) -> None:
    Path("own.py").write_text(OWN.replace(line, wrong))
    with pytest.raises((SettingsError, PythonFileError), match=said):
        load_settings(own)


def test_a_name_that_is_taken_is_told() -> None:
    with pytest.raises(ValueError, match="'duel' is one of robobt's"):
        TASKS.register("duel")(type("Duel", (GoToBallTask,), {}))


def test_a_preset_of_another_task_is_told(own: str) -> None:
    Path("other.yaml").write_text("extends: fast\ntask: shoot\n")
    with pytest.raises(SettingsError, match=r"other\.yaml: task: is shoot, where own\.py:Middle is trained"):
        load_settings(own, "other.yaml")


def test_the_code_of_a_task_is_what_this_process_runs_though_its_file_is_edited(own: str) -> None:
    environment = load_settings(own).environment
    before = task_file(environment)[1]
    Path("own.py").write_text(OWN.replace("< 0.3", "< 0.4"))
    assert task_file(environment)[1] == before != ""
