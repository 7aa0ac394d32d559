"""The shot predictor that learned raters use."""

from __future__ import annotations

from abc import abstractmethod
from contextlib import suppress
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

from pydantic import field_validator

from robobt.models.checks.source import checked_members
from robobt.models.file import ModelError, unpack_archive
from robobt.models.find import read_fitting_model
from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.aim.raters.base import Chances, ShotRater
from robobt.skills.store import Shot
from robobt.world.features import ObservationSpec
from robobt.world.geometry import Point
from robobt.world.state import Frame, RobotState

if TYPE_CHECKING:
    from robobt.models.policy import Policy


_wanted: dict[tuple[str, ObservationSpec], None] = {}
"""Models of the raters built so far. Each is loaded at its first prediction, so most processes need no
torch."""

_sound: set[str] = set()
"""Checksums of files whose network's source has been checked."""


@lru_cache(maxsize=32)
def shot_predictor(model: str, observation: ObservationSpec) -> Policy:
    """Load a shot predictor by a shipped model's name or a file's path, once per process."""
    from robobt.models.policy import load_policy

    return load_policy(model, kind="shot_predictor", observation=observation)


def load_shot_predictors() -> None:
    """Load the predictors of all raters built so far, before a match in real time; this may take seconds."""
    for model, observation in _wanted:
        # An error in a model is reported where the model is used.
        with suppress(ModelError):
            shot_predictor(model, observation)


def check_shot_predictor(model: str, observation: ObservationSpec) -> None:
    """Refuse an unusable shot predictor, as far as can be checked without importing torch.

    A tree is built several times before a match, so each file is checked only once.

    Raises:
        ModelError: the file is missing, truncated, not a robobt model, or made for another purpose; the
        message names it.
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
    """A rater that feeds its observation of a scene to a shot predictor, ``model``."""

    observation: ClassVar[ObservationSpec]

    model: str

    @field_validator("model")
    @classmethod
    def _usable(cls, model: str) -> str:
        check_shot_predictor(model, cls.observation)
        return model

    @abstractmethod
    def judge(
        self,
        frame: Frame,
        origin: Point,
        me: RobotState,
        *,
        delay: float = 0.0,
        watch: GoalkeeperWatch | None = None,
    ) -> tuple[list[Shot], Chances | None]:
        """Return the openings, and the chance at every point of the goal line.

        ``watch`` is what the match so far says about the opponents' goalkeeper; the other arguments are as
        for :meth:`ShotRater.rate_all`.
        """

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:
        """See :meth:`ShotRater.rate_all`."""
        return self.judge(frame, origin, me, delay=delay)[0]
