"""Every node is set up once before its first tick, and shut down at the end, as py_trees promises."""

from __future__ import annotations

from typing import Any

import py_trees
import pytest
from py_trees.behaviour import Behaviour

from robobt.tree import Inverter, Leaf, Selector, Sequence, Status, TreeError, TreeRunner
from tests.tree.scripted import Notes


class Plain(Behaviour):
    """A user's own node of py_trees, which writes down what is done to it."""

    def __init__(self, name: str, diary: list[str], breaks: str = "") -> None:
        super().__init__(name)
        self.diary, self.breaks = diary, breaks

    def setup(self, **kwargs: Any) -> None:
        self.diary.append(f"{self.name} set up{kwargs or ''}")
        if self.breaks == "setup":
            raise ConnectionError("no camera")

    def shutdown(self) -> None:
        self.diary.append(f"{self.name} shut down")
        if self.breaks == "shutdown":
            raise ConnectionError("no camera any more")

    def update(self) -> Status:
        self.diary.append(f"{self.name} ticked")
        return Status.RUNNING


class Above(Plain, py_trees.composites.Sequence):
    """A composite of a user's own."""

    def __init__(self, name: str, diary: list[str], children: list[Behaviour]) -> None:
        py_trees.composites.Sequence.__init__(self, name, memory=False, children=children)
        self.diary, self.breaks = diary, ""


class OfOurs(Leaf[Notes]):
    def setup(self, **_: Any) -> None:
        self.store.diary.append(f"{self.name} set up")

    def on_running(self) -> Status:
        return self.run()


class NeedsNode(OfOurs):
    def setup(self, node: object) -> None:  # type: ignore[override]
        raise AssertionError("not to be reached")


def tree(diary: list[str], breaks: str = "") -> Behaviour:
    deep = Above("above", diary, [Plain("left", diary), Plain("right", diary, breaks)])
    return Selector("root", memory=False, children=[Inverter("not", deep), Plain("last", diary)])


def test_every_node_is_set_up_once_before_the_first_tick_in_the_order_of_py_trees() -> None:
    stock: list[str] = []
    py_trees.trees.BehaviourTree(tree(stock)).setup()
    diary: list[str] = []
    runner = TreeRunner(tree(diary), None)
    assert diary == stock == ["left set up", "right set up", "above set up", "last set up"]
    runner.tick()
    runner.tick()
    assert [entry for entry in diary if "set up" in entry] == stock


@pytest.mark.parametrize("stock", [False, True])
def test_another_way_of_ticking_or_watching_sets_nothing_up_again(stock: bool) -> None:
    diary: list[str] = []
    runner = TreeRunner(tree(diary), None)
    if stock:
        runner.tick_by_py_trees()
    runner.show_to(py_trees.visitors.SnapshotVisitor())
    runner.mark([], [])
    runner.tick()
    assert diary.count("left set up") == diary.count("last set up") == 1


def test_a_leaf_has_its_store_when_it_is_set_up() -> None:
    store = Notes()
    TreeRunner(OfOurs("mine"), store)
    assert store.diary == ["mine set up"]


def test_a_tree_that_could_not_be_set_up_fails_at_every_tick_for_that_reason() -> None:
    diary: list[str] = []
    runner = TreeRunner(tree(diary, "setup"), None)
    runner.mark([], [])
    for _ in range(3):
        assert runner.tick() is Status.INVALID
        assert runner.error is not None
        assert runner.error.startswith(
            "root/not/above/right: setup() failed: ConnectionError: no camera (test_setup.py:"
        )
        assert runner.statuses() == "----F-"
    # Nothing is set up after it, nothing is ticked, and only what was set up is shut down.
    runner.shutdown()
    assert diary == ["left set up", "right set up", "left shut down"]


def test_what_a_node_wants_and_nobody_gives_is_told_with_its_path() -> None:
    runner = TreeRunner(Sequence("root", memory=False, children=[NeedsNode("camera")]), Notes())
    runner.tick()
    assert runner.error is not None
    assert runner.error.startswith(
        "root/camera: setup() failed: TypeError: NeedsNode.setup() missing 1 required"
    )


def test_in_development_a_tree_that_cannot_be_set_up_raises_at_its_first_tick() -> None:
    diary: list[str] = []
    runner = TreeRunner(tree(diary, "setup"), None, on_error="raise")
    for _ in range(2):
        with pytest.raises(
            TreeError, match=r"root/not/above/right: setup\(\) failed: ConnectionError: no camera"
        ) as raised:
            runner.tick()
        assert isinstance(raised.value.__cause__, ConnectionError)
    assert diary == ["left set up", "right set up"]


@pytest.mark.parametrize("leaving", [SystemExit, KeyboardInterrupt])
def test_what_ends_the_program_goes_on_and_shuts_down_what_was_set_up(
    leaving: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    diary: list[str] = []
    root = tree(diary)

    def leave(**_: object) -> None:
        raise leaving

    monkeypatch.setattr(root.children[1], "setup", leave)
    with pytest.raises(leaving):
        TreeRunner(root, None)
    assert diary[-3:] == ["left shut down", "right shut down", "above shut down"]


def test_every_node_is_shut_down_once_whatever_one_of_them_raises(caplog: pytest.LogCaptureFixture) -> None:
    diary: list[str] = []
    runner = TreeRunner(tree(diary, "shutdown"), None)
    diary.clear()
    runner.shutdown()
    runner.shutdown()
    assert diary == ["left shut down", "right shut down", "above shut down", "last shut down"]
    assert "root/not/above/right: ConnectionError: no camera any more" in caplog.text


def test_a_node_that_has_left_the_tree_is_shut_down_too() -> None:
    diary: list[str] = []
    root = tree(diary)
    runner = TreeRunner(root, None)
    assert isinstance(root, Selector)
    root.remove_child(root.children[1])
    runner.shutdown()
    assert diary[-1] == "last shut down"
