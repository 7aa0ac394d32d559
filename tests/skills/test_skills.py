"""What all skills have in common."""

from __future__ import annotations

import inspect
import pkgutil
from dataclasses import fields
from importlib import import_module
from math import inf, nan
from typing import Any

import pytest

import robobt.plays.baselines
import robobt.skills
from robobt.skills import SKILLS, Skill, Store
from robobt.tree.parameters import members_of, parameters_of

BASELINES = "robobt.plays.baselines"


@pytest.mark.parametrize("name", list(SKILLS))
class TestEverySkill:
    def test_is_imported_by_name_in_the_package_and_lives_in_a_file_of_its_own_name(self, name: str) -> None:
        cls = SKILLS[name]
        if not cls.__module__.startswith(BASELINES):
            assert getattr(robobt.skills, name) is cls
        assert cls.__module__.rpartition(".")[2] == snake_case(name)

    def test_is_made_without_arguments_and_by_keywords_only(self, name: str) -> None:
        cls = SKILLS[name]
        assert cls().name == name
        assert cls(name="mine").name == "mine"
        first, *parameters = inspect.signature(cls).parameters.values()
        assert first.name == "name"
        assert all(parameter.kind is parameter.KEYWORD_ONLY for parameter in parameters)
        assert all(parameter.hint is not Any for parameter in parameters_of(cls))

    @pytest.mark.parametrize("value", [nan, inf, -inf])
    def test_refuses_numbers_that_are_not_finite(self, name: str, value: float) -> None:
        cls = SKILLS[name]
        for parameter in parameters_of(cls):
            kinds = members_of(parameter.hint)
            if float in kinds:
                with pytest.raises(ValueError, match=f"^{parameter.name} must be"):
                    cls(**{parameter.name: value})
            if tuple[float, float] in kinds:
                with pytest.raises(ValueError, match=f"^{parameter.name} must be finite"):
                    cls(**{parameter.name: (0.0, value)})

    def test_says_what_it_does_and_what_its_parameters_mean(self, name: str) -> None:
        cls = SKILLS[name]
        assert cls.__doc__ is not None
        for parameter in list(inspect.signature(cls).parameters)[1:]:
            assert parameter in cls.__doc__, f"{name} does not document {parameter}"

    def test_declares_entries_that_the_store_has(self, name: str) -> None:
        entries = {field.name for field in fields(Store)}
        assert entries.issuperset(SKILLS[name].reads)
        assert entries.issuperset(SKILLS[name].writes)


def test_every_skill_below_the_package_is_entered() -> None:
    found: set[type[Skill]] = set()
    for module in (
        *pkgutil.walk_packages(robobt.skills.__path__, "robobt.skills."),
        *pkgutil.walk_packages(robobt.plays.baselines.__path__, f"{BASELINES}."),
    ):
        contents = vars(import_module(module.name)).values()
        found |= {value for value in contents if isinstance(value, type) and issubclass(value, Skill)}
    bases = {base for cls in found for base in cls.__mro__[1:]}
    assert {cls.__name__ for cls in found - bases} == set(SKILLS)


def snake_case(name: str) -> str:
    return "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name).lstrip("_")
