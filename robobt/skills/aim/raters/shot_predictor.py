"""The predictor that a learned rater asks."""

from __future__ import annotations

from contextlib import suppress
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

from pydantic import field_validator

from robobt.models.checks.source import checked_members
from robobt.models.file import ModelError, unpack_archive
from robobt.models.find import read_fitting_model
from robobt.skills.aim.raters.base import ShotRater
from robobt.skills.store import Shot
from robobt.world.features import ObservationSpec
from robobt.world.geometry import Point
from robobt.world.state import Frame, RobotState

if TYPE_CHECKING:
    from robobt.models.policy import Policy


_wanted: dict[tuple[str, ObservationSpec], None] = {}
"""What raters were made for; with their models loaded only when first asked, most processes need no torch."""

_sound: set[str] = set()
"""Checksums of files whose network's source has been checked."""


@lru_cache(maxsize=32)
def shot_predictor(model: str, observation: ObservationSpec) -> Policy:
    """Load a shot predictor by a shipped model's name or a file's path, once per process."""
    from robobt.models.policy import load_policy

    return load_policy(model, kind="shot_predictor", observation=observation)


def load_shot_predictors() -> None:
    """Load what the raters made so far will ask, as before a match in real time: that may take seconds."""
    for model, observation in _wanted:
        # What is wrong with one is said where it is asked.
        with suppress(ModelError):
            shot_predictor(model, observation)


def check_shot_predictor(model: str, observation: ObservationSpec) -> None:
    """Refuse a shot predictor that cannot be used, as far as can be told without importing torch.

    A tree is built several times before a match, so what was checked is not checked again.

    Raises:
        ModelError: it is missing, cut, foreign or made for something else; the message names the file.
    """
    _wanted[model, observation] = None
    file = read_fitting_model(model, kind="shot_predictor", observation=observation)
    if file.format == "torchscript" and file.sha256 not in _sound:
        try:
            checked_members(unpack_archive(file.content))
        except ModelError as error:
            raise ModelError(f"{file.path}: {error}") from error
        _sound.add(file.sha256)


class LearnedRater(ShotRater):
    """A rater that asks a shot predictor, ``model``, about what it observes of a scene."""

    observation: ClassVar[ObservationSpec]

    model: str

    @field_validator("model")
    @classmethod
    def _usable(cls, model: str) -> str:
        check_shot_predictor(model, cls.observation)
        return model

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:
        """See :meth:`ShotRater.rate_all`."""
        return self.judge(frame, origin, me, delay=delay)[0]
