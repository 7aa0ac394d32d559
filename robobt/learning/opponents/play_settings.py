"""The play that moves a robot of an arena, and its parameters."""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, model_validator

from robobt.config.errors import FieldError
from robobt.config.validation import Settings
from robobt.plays import PLAYS
from robobt.plays.files import build_play
from robobt.tree import Behaviour
from robobt.tree.parameters import ParameterError


class PlaySettings(Settings):
    """A play of :data:`~robobt.plays.PLAYS` with parameters; its name alone will do for none."""

    play: str = Field(description="its name")
    params: dict[str, Any] = Field(default_factory=dict, description="its parameters, as in a scenario")

    def build_tree(self) -> Behaviour:
        """Build a new tree of the play."""
        return build_play(self.play, self.params)

    @model_validator(mode="after")
    def _buildable(self) -> Self:
        if self.play not in PLAYS:
            raise FieldError("play", f"no play is called {self.play!r}; {PLAYS.meant(self.play)}")
        try:
            # A play without parameters always builds, and building may take time to load a model.
            if self.params:
                self.build_tree()
        except ParameterError as error:
            raise FieldError(f"params.{error.parameter}", str(error)) from error
        return self


def _named(given: object) -> object:
    return {"play": given} if isinstance(given, str) else given


GivenPlay = Annotated[PlaySettings, BeforeValidator(_named)]
"""A play's name, or the play with parameters."""
