"""How a team's program is started, and how it loses by rule."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Self

from pydantic import Field, field_validator, model_validator

from robobt.config.errors import FieldError, RobobtError
from robobt.config.validation import Settings
from robobt.world.game import Team

STREAMS = ("vision", "tracker", "referee")
"""What a program sees; each comes to a multicast group."""

PLACEHOLDERS = (
    *("team", "host"),
    *[f"{name}{part}" for name in STREAMS for part in ("", "_group", "_port")],
    *("grsim", "protocol", "control", "steps"),
)
"""What is filled in, in braces."""

_PLACE = re.compile(r"\{\{(?P<plain>[A-Za-z_]\w*)\}\}|(?<![$])\{(?P<place>[A-Za-z_]\w*)\}")
"""A place in a word; in two braces it is a word in one, and behind a dollar it is a shell's."""


class Program(Settings):
    """How a team's program is started, and what it may do."""

    command: tuple[str, ...] = Field(
        strict=False,
        min_length=1,
        description="program and arguments; {team}, {host}, {vision}, {tracker}, {referee} and the ports "
        "{grsim}, {protocol} and, in lock step, {steps} are filled in",
    )
    lockstep: bool = Field(
        False, description="whether it asks for time to pass, by SimulationSyncRequest at {steps}"
    )
    ready_within: float = Field(
        60.0, gt=0, le=600, description="how long it may take until it first commands its robots [s]"
    )
    silent_for: float = Field(
        10.0, gt=0, le=600, description="how long it may then be silent until it has lost [s]"
    )
    stays: bool = Field(
        False,
        description="whether it keeps running and plays the next match, if the other side's program does",
    )
    ends_within: float = Field(30.0, gt=0, le=600, description="time for it to end after SIGTERM [s]")

    @field_validator("command")
    @classmethod
    def _known(cls, command: tuple[str, ...]) -> tuple[str, ...]:
        for name in _named(command):
            if name not in PLACEHOLDERS:
                there = ", ".join([f"{{{place}}}" for place in PLACEHOLDERS])
                raise ValueError(
                    f"nothing is filled in for {{{name}}}; there are {there}; {{{{{name}}}}} is {{{name}}} "
                    "as it is"
                )
        return command

    @model_validator(mode="after")
    def _steps_in_lock_step(self) -> Self:
        asks = "steps" in _named(self.command)
        if asks and not self.lockstep:
            raise FieldError("command", "{steps} is there with 'lockstep: true' only")
        if self.lockstep and not asks:
            raise FieldError("lockstep", "needs {steps} in the command, the port at which time is asked for")
        return self

    @property
    def league_groups(self) -> set[str]:
        """Return what it sees in the league's multicast groups: it takes the port alone."""
        names = _named(self.command)
        return {name for name in STREAMS if f"{name}_port" in names and not {name, f"{name}_group"} & names}

    def words(self, addresses: Mapping[str, str]) -> list[str]:
        """Return the command with these in their places."""

        def filled(found: re.Match[str]) -> str:
            return f"{{{found['plain']}}}" if found["plain"] else addresses[found["place"]]

        return [_PLACE.sub(filled, word) for word in self.command]


class ForfeitError(RobobtError, RuntimeError):
    """A team's program crashed, is silent, was never ready, or disturbs the match.

    Attributes:
        team: whose it is.
    """

    def __init__(self, team: Team, problem: str) -> None:
        super().__init__(problem)
        self.team = team


def _named(command: tuple[str, ...]) -> set[str]:
    return {found["place"] for word in command for found in _PLACE.finditer(word) if found["place"]}
