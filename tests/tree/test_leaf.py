"""Leaves: their lifecycle, their store, and what happens when one raises."""

from __future__ import annotations

from functools import partialmethod

import pytest
from py_trees.common import ParallelPolicy

from robobt.tree import Leaf, Parallel, Registry, Selector, Sequence, Status, TreeRunner, node_path, preorder


class Scripted(Leaf[list[str]]):
    """Returns the given statuses in turn and writes its lifecycle into the store."""

    def __init__(self, name: str, *script: Status) -> None:
        super().__init__(name)
        self.script = list(script)

    def on_start(self) -> None:
        self.store.append(f"{self.name} start")

    def on_running(self) -> Status:
        self.store.append(f"{self.name} tick")
        return self.script.pop(0) if len(self.script) > 1 else self.script[0]

    def on_done(self, status: Status) -> None:
        self.store.append(f"{self.name} {status.value.lower()}")

    def on_interrupt(self) -> None:
        self.store.append(f"{self.name} interrupted")


class Broken(Leaf[list[str]]):
    def on_running(self) -> Status:
        raise ZeroDivisionError("no")


class Partial(Scripted):
    """Its start is a method with an argument given."""

    def note(self, word: str) -> None:
        self.store.append(word)

    on_start = partialmethod(note, "noted")


S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING


def test_a_leaf_starts_runs_and_ends() -> None:
    log: list[str] = []
    runner = TreeRunner(Scripted("a", R, R, S), log)
    assert [runner.tick() for _ in range(3)] == [R, R, S]
    assert log == ["a start", "a tick", "a tick", "a tick", "a success"]


def test_a_method_may_be_another_with_an_argument_given() -> None:
    log: list[str] = []
    assert TreeRunner(Partial("a", S), log).tick() is S
    assert log == ["noted", "a tick", "a success"]


def test_a_running_leaf_is_interrupted_after_the_new_branch_has_ticked() -> None:
    log: list[str] = []
    guard = Scripted("guard", F, S)
    root = Selector("root", memory=False, children=[guard, Scripted("work", R)])
    runner = TreeRunner(root, log)
    runner.tick()
    log.clear()
    runner.tick()
    assert log == ["guard start", "guard tick", "guard success", "work interrupted"]


def test_a_finished_leaf_is_not_interrupted_when_its_parent_starts_anew() -> None:
    log: list[str] = []
    root = Sequence("root", memory=False, children=[Scripted("a", S), Scripted("b", R)])
    runner = TreeRunner(root, log)
    runner.tick()
    runner.tick()
    assert "a interrupted" not in log
    assert log.count("a success") == 2
    assert log.count("b start") == 1


def test_two_robots_of_one_function_share_nothing() -> None:
    def build() -> Sequence:
        return Sequence("root", memory=False, children=[Scripted("a", S)])

    first: list[str] = []
    second: list[str] = []
    TreeRunner(build(), first).tick()
    runner = TreeRunner(build(), second)
    assert second == []
    runner.tick()
    assert first == second


def test_an_exception_stops_the_tree_names_the_node_and_leaves_nothing_running() -> None:
    log: list[str] = []
    inner = Sequence("inner", memory=False, children=[Scripted("a", S), Broken("bad")])
    runner = TreeRunner(Selector("root", memory=False, children=[inner]), log)
    assert runner.tick() is Status.INVALID
    assert str(runner.error).startswith("root/inner/bad: ZeroDivisionError: no (test_leaf.py:")
    assert runner.statuses() == "---F"
    assert runner.tick() is Status.INVALID


def test_a_leaf_that_raises_as_it_is_interrupted_does_not_keep_the_tree_from_being_stopped() -> None:
    class Stubborn(Scripted):
        def on_interrupt(self) -> None:
            raise ZeroDivisionError("no")

    log: list[str] = []
    policy = ParallelPolicy.SuccessOnAll()
    root = Parallel("root", policy=policy, children=[Stubborn("stubborn", R), Scripted("other", R)])
    runner = TreeRunner(root, log)
    runner.tick()
    runner.stop()
    assert {node.status for node in runner.nodes} == {Status.INVALID}
    assert log[-1] == "other interrupted"


def test_statuses_are_one_letter_a_node_in_preorder() -> None:
    log: list[str] = []
    root = Selector("root", memory=False, children=[Scripted("a", F), Scripted("b", R), Scripted("c", S)])
    runner = TreeRunner(root, log)
    assert runner.statuses() == "----"
    runner.tick()
    assert runner.statuses() == "RFR-"
    assert [node.name for node in preorder(root)] == ["root", "a", "b", "c"]
    assert node_path(root.children[1]) == "root/b"


def test_a_failure_carries_its_reason() -> None:
    class Refuses(Leaf[None]):
        def on_running(self) -> Status:
            return self.fail("no ball")

    leaf = Refuses()
    assert TreeRunner(leaf, None).tick() is F
    assert leaf.feedback_message == "no ball"
    assert leaf.name == "Refuses"


def test_a_name_is_taken_once() -> None:
    registry: Registry[object] = Registry("thing")
    registry.register("one")(test_a_failure_carries_its_reason)
    with pytest.raises(ValueError, match=r"'one' is registered twice: .*carries_its_reason and .*statuses"):
        registry.register("one")(test_statuses_are_one_letter_a_node_in_preorder)
    with pytest.raises(KeyError, match="no thing is called 'two'; there are one"):
        registry["two"]
    assert list(registry) == ["one"]
    assert "one" in registry
    assert len(registry) == 1


@pytest.mark.parametrize("answer", [None, True, "SUCCESS"])
@pytest.mark.parametrize("hooked", [False, True])
def test_a_leaf_that_returns_no_status_is_an_error_with_its_path(answer: object, hooked: bool) -> None:
    class Forgetful(Leaf[None]):
        def on_running(self) -> Status:
            return answer  # type: ignore[return-value]

    if hooked:
        Forgetful.on_start = lambda self: None  # type: ignore[method-assign]
    for root in (Forgetful("f"), Sequence("f", memory=False, children=[Forgetful("inner")])):
        runner = TreeRunner(root, None)
        assert runner.tick() is Status.INVALID
        assert runner.error is not None
        assert f"TypeError: on_running returned {type(answer).__name__}, not a Status" in runner.error
        assert runner.error.startswith("f/inner: " if root.children else "f: ")
        with pytest.raises(TypeError, match="not a Status"):
            root.tick_once()
