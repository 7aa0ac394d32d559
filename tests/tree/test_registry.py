"""The registry: names of this package and of others, installed as they would be."""

from __future__ import annotations

import logging
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from robobt.plays import PLAYS
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS
from robobt.tree import Registry
from tests.registries import temporarily

Install = Callable[[str, dict[str, str], dict[str, str]], None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a distribution with modules (name to source) and entry points of the group ``test.things``."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(tmp_path))

    def make(distribution: str, modules: dict[str, str], points: dict[str, str]) -> None:
        for module, source in modules.items():
            (tmp_path / f"{module}.py").write_text(textwrap.dedent(source), encoding="utf-8")
        info = tmp_path / f"{distribution.replace('-', '_')}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n")
        lines = "".join(f"{name} = {value}\n" for name, value in points.items())
        (info / "entry_points.txt").write_text(f"[test.things]\n{lines}")

    yield make
    for name in set(sys.modules) - before:
        del sys.modules[name]


def things() -> Registry[object]:
    registry: Registry[object] = Registry("thing", group="test.things")
    registry.register("own")(object())
    return registry


def test_what_is_registered_is_found_listed_in_order_and_counted() -> None:
    registry: Registry[str] = Registry("thing")
    registry.register("b")("second")
    registry.register("a")("first")
    assert registry["a"] == "first"
    assert "b" in registry
    assert list(registry) == ["a", "b"]
    assert len(registry) == 2


def test_an_unknown_name_is_an_error_that_lists_the_names() -> None:
    registry: Registry[str] = Registry("thing")
    registry.register("a")("first")
    with pytest.raises(KeyError, match="no thing is called 'c'; there are a"):
        registry["c"]


def test_a_name_taken_twice_is_an_error_that_names_both() -> None:
    registry: Registry[object] = Registry("thing")

    @registry.register("same")
    class First:
        pass

    class Second:
        pass

    with pytest.raises(ValueError, match=r"'same' is registered twice: .*First and .*Second"):
        registry.register("same")(Second)
    assert registry["same"] is First


def test_a_function_of_no_module_is_registered_as_foreign() -> None:
    def made() -> None:
        """As in code that is executed outside any module, such as in the README's test."""

    made.__module__ = None  # type: ignore[assignment]
    registry: Registry[object] = Registry("thing")
    registry.register("of no module")(made)
    assert registry["of no module"] is made
    assert "of no module" in Registry.foreign


def test_a_thing_of_another_package_is_there_under_its_entry_points_name(install: Install) -> None:
    install("extra", {"extra_things": "class Press:\n    pass\n"}, {"Press": "extra_things:Press"})
    registry = things()
    assert list(registry) == ["Press", "own"]
    assert registry["Press"].__name__ == "Press"  # type: ignore[attr-defined]
    assert registry.source("Press") == "extra"
    assert registry.source("own") is None
    assert registry.problems == ()


def test_other_packages_are_not_imported_before_they_are_needed(install: Install) -> None:
    install("extra", {"lazy_things": "thing = object()\n"}, {"thing": "lazy_things:thing"})
    registry = things()
    assert registry["own"] is not None
    assert "own" in registry
    assert "lazy_things" not in sys.modules
    assert "thing" in registry
    assert "lazy_things" in sys.modules


@pytest.mark.parametrize(
    ("ask", "answer"), [(len, 2), (list, ["own", "thing"]), (lambda registry: "thing" in registry, True)]
)
def test_listing_counting_and_asking_load_them(
    install: Install, ask: Callable[[Registry[object]], object], answer: object
) -> None:
    install("extra", {"asked_things": "thing = object()\n"}, {"thing": "asked_things:thing"})
    assert ask(things()) == answer


def test_a_module_as_an_entry_point_enters_things_itself(
    install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    registry = things()
    monkeypatch.setattr(sys.modules[__name__], "shared", registry, raising=False)
    source = f"""
        from {__name__} import shared

        @shared.register("Mark")
        class Mark:
            pass
    """
    install("extra", {"decorated": source}, {"all": "decorated", "Mark": "decorated:Mark"})
    assert list(registry) == ["Mark", "own"]
    assert registry.problems == ()
    assert registry.source("Mark") == "extra"


def test_a_broken_distribution_is_named_and_harms_nobody_else(
    install: Install, caplog: pytest.LogCaptureFixture
) -> None:
    install("bad-one", {"bad_things": "raise RuntimeError('no\\nlicence')\n"}, {"bad": "bad_things:thing"})
    install("good-one", {"good_things": "thing = object()\n"}, {"good": "good_things:thing"})
    registry = things()
    with caplog.at_level(logging.WARNING):
        assert list(registry) == ["good", "own"]
    (problem,) = registry.problems
    assert problem == (
        "thing 'bad' (bad_things:thing) of the distribution bad-one cannot be used: RuntimeError: no licence"
    )
    assert [record.message for record in caplog.records] == [problem]
    with pytest.raises(KeyError, match="bad-one"):
        registry["bad"]
    assert registry.problem_with("bad") == problem
    assert registry.problem_with("good") is None


@pytest.mark.parametrize("value", ["no_such_module:thing", "here_things:missing", "here_things:thing.deeper"])
def test_an_entry_point_to_nothing_is_a_problem(install: Install, value: str) -> None:
    install("extra", {"here_things": "thing = object()\n"}, {"thing": value})
    registry = things()
    assert list(registry) == ["own"]
    assert "extra" in registry.problems[0]


def test_a_module_that_ends_the_process_is_a_problem(install: Install) -> None:
    install("extra", {"quitting": "raise SystemExit(3)\n"}, {"thing": "quitting"})
    registry = things()
    assert list(registry) == ["own"]
    assert "SystemExit" in registry.problems[0]


def test_a_module_that_raises_half_way_leaves_nothing_behind(
    install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    registry = things()
    monkeypatch.setattr(sys.modules[__name__], "shared", registry, raising=False)
    source = f"""
        from {__name__} import shared

        shared.register("half")(object())
        raise ValueError("and no more")
    """
    install("extra", {"halves": source}, {"halves": "halves"})
    assert list(registry) == ["own"]
    assert "and no more" in registry.problems[0]


def test_what_is_of_another_kind_is_a_problem(install: Install) -> None:
    install("extra", {"odd_things": "thing = 3\n"}, {"odd": "odd_things:thing"})
    registry: Registry[object] = Registry("thing", group="test.things", fits=callable)
    assert list(registry) == []
    assert "is not a thing" in registry.problems[0]


def test_another_packages_duplicate_is_refused_and_both_are_named(install: Install) -> None:
    install("extra", {"double": "class Thing:\n    pass\n"}, {"own": "double:Thing"})
    registry = things()
    own = registry["own"]
    assert list(registry) == ["own"]
    assert registry["own"] is own
    assert "registered twice" in registry.problems[0]
    assert "double.Thing of the distribution extra" in registry.problems[0]


def test_of_two_packages_with_one_name_the_first_keeps_it_whatever_their_order_on_disk(
    install: Install,
) -> None:
    install("zulu", {"zulu_things": "class Thing:\n    pass\n"}, {"same": "zulu_things:Thing"})
    install("alpha", {"alpha_things": "class Thing:\n    pass\n"}, {"same": "alpha_things:Thing"})
    registry = things()
    assert registry.source("same") is None
    assert len(registry) == 2
    assert registry.source("same") == "alpha"
    (problem,) = registry.problems
    assert "alpha_things.Thing of the distribution alpha" in problem
    assert "zulu_things.Thing of the distribution zulu" in problem


def test_a_registry_without_a_group_has_only_its_own(install: Install) -> None:
    install("extra", {"unseen": "thing = object()\n"}, {"thing": "unseen:thing"})
    registry: Registry[object] = Registry("thing")
    assert list(registry) == []


@pytest.mark.parametrize(
    ("registry", "group"),
    [(SKILLS, "robobt.skills"), (PLAYS, "robobt.plays"), (RATERS, "robobt.raters")],
)
def test_skills_plays_and_raters_take_in_other_packages(registry: Registry[object], group: str) -> None:
    assert registry.group == group
    assert registry.problems == ()
    assert len(registry) > 0


def test_what_is_registered_temporarily_is_gone_afterwards() -> None:
    registry = things()
    own = registry["own"]
    with temporarily(registry) as same:
        assert same is registry
        registry.register("guest")("guest")
        assert registry["guest"] == "guest"
    assert list(registry) == ["own"]
    assert registry["own"] is own
    registry.register("guest")("another")


def _fail_with_a_guest(registry: Registry[object]) -> None:
    with temporarily(registry):
        registry.register("guest")("guest")
        raise RuntimeError


def test_an_exception_takes_it_back_too() -> None:
    registry = things()
    with pytest.raises(RuntimeError):
        _fail_with_a_guest(registry)
    assert list(registry) == ["own"]


def test_what_other_packages_bring_while_something_is_temporary_stays(install: Install) -> None:
    install("extra", {"staying": "thing = object()\n"}, {"thing": "staying:thing"})
    registry = things()
    with temporarily(registry):
        assert "thing" in registry
    assert list(registry) == ["own", "thing"]
