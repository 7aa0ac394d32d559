"""The values of a play's parameters in a sweep."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

from robobt.config.errors import ConfigError, RobobtError, short_repr
from robobt.config.yaml import parse_marked
from robobt.plays.files import find_play
from robobt.tree.parameters import Parameter, ParameterError, members_of, parameter_at

if TYPE_CHECKING:
    from optuna import Trial

_DIGITS = 4
"""Digits of a tried number: more would only make names long."""


class SweepError(RobobtError, ValueError):
    """A sweep is not possible; the message is one line."""


@dataclass(slots=True, frozen=True)
class Varied:
    """A parameter and the values that are tried.

    Attributes:
        name: of the parameter.
        text: the values as they were given.
        choices: those that are tried; none for a range.
        low, high: ends of the range, both within it.
        whole: whether only integers are tried in it.
    """

    name: str
    text: str
    choices: tuple[object, ...] = ()
    low: float = 0.0
    high: float = 0.0
    whole: bool = False

    def suggested(self, trial: Trial) -> object:
        """Return the value that Optuna proposes."""
        if self.choices:
            # By their places: values may be lists, which Optuna does not know.
            return self.choices[trial.suggest_categorical(self.name, list(range(len(self.choices))))]
        if self.whole:
            return trial.suggest_int(self.name, int(self.low), int(self.high))
        value = trial.suggest_float(self.name, self.low, self.high)
        return min(max(float(f"{value:.{_DIGITS}g}"), self.low), self.high)

    def count(self) -> int | None:
        """Return how many values there are, None for those between any two of which is another."""
        if self.choices:
            return len(self.choices)
        return int(self.high) - int(self.low) + 1 if self.whole else None

    def proposals(self) -> list[int]:
        """Return all that Optuna may propose, where it can be counted: a choice by its place."""
        first = 0 if self.choices else int(self.low)
        return list(range(first, first + (self.count() or 0)))

    def extremes(self) -> tuple[object, ...]:
        """Return values of which all are possible if these are."""
        if self.choices:
            return self.choices
        return (int(self.low), int(self.high)) if self.whole else (self.low, self.high)


def read_varied(play: str, text: str) -> Varied:
    """Read ``NAME=VALUE,VALUE,...`` or, for numbers, ``NAME=LOW:HIGH``.

    Args:
        play: a play's name, or that of one in a Python file; its parameters' types say what fits.
        text: what is varied; a field of a group of settings by its path, as ``tactics.switch_gain``.

    Raises:
        SweepError: the play has no such parameter, or the values do not fit it.
    """
    name, equals, values = text.partition("=")
    if not equals or not name:
        raise SweepError(f"{text!r}: what is varied is NAME=VALUE,VALUE,... or NAME=LOW:HIGH")
    try:
        parameter = parameter_at(play, find_play(play), name)
        numbers = members_of(parameter.hint) & {int, float}
        if numbers and ":" in values:
            return _range(parameter, values, numbers == {int})
        return _choices(parameter, values)
    except ParameterError as error:
        raise SweepError(f"{error.parameter}: {error}") from error


def _range(parameter: Parameter, text: str, whole: bool) -> Varied:
    try:
        low, high = [float(end) for end in text.split(":")]
    except ValueError:
        raise ParameterError(parameter.name, f"a range is LOW:HIGH, two numbers, not {text!r}") from None
    if not (isfinite(low) and isfinite(high) and low < high):
        raise ParameterError(parameter.name, f"a range goes from a number to a larger one, not {text!r}")
    if whole and not (low.is_integer() and high.is_integer()):
        raise ParameterError(parameter.name, f"is an integer; {text!r} has to go from one to another")
    for end in (low, high):
        parameter.convert(int(end) if whole else end)
    return Varied(parameter.name, text, low=low, high=high, whole=whole)


def _choices(parameter: Parameter, text: str) -> Varied:
    try:
        values = parse_marked(f"[{text}]", parameter.name).plain()
    except ConfigError as error:
        raise ParameterError(parameter.name, f"{error.problem}, in {short_repr(text)}") from error
    assert isinstance(values, list)
    # As the play gets them: 1 and 1.0 are one speed.
    if len({repr(parameter.convert(value)) for value in values}) < max(2, len(values)):
        ranges = " or a range, LOW:HIGH" if members_of(parameter.hint) & {int, float} else ""
        raise ParameterError(
            parameter.name, f"needs two or more different values, VALUE,VALUE,...{ranges}, not {text!r}"
        )
    return Varied(parameter.name, text, tuple(values))
