"""A population of goalkeepers: the distribution of their traits."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import Field, ValidationError

from robobt.config.atomic import write_atomically
from robobt.config.errors import ConfigError
from robobt.config.validation import Settings, first_problem
from robobt.config.yaml import read_yaml, write_yaml
from robobt.world.compiled import record_dtype
from robobt.world.geometry import FloatArray

REAL = Path(__file__).with_name("real.yaml")
"""The population fitted to the paper's 542 real training shots by ``python -m paper goalkeepers``."""


class Traits(NamedTuple):
    """One goalkeeper, and the kick it has to save.

    Attributes:
        max_speed: top speed that it asks of its robot [m/s].
        acceleration: how fast the robot changes its velocity, in any direction [m/s^2].
        braking: deceleration with which it plans to stop [m/s^2].
        delay: reaction time [s].
        offset: how far beside its place it stands, to the left of the line ball -> place [m].
        kick_speed: the ball's speed after the kick [m/s].
        kick_error: direction of the kick minus that of the aim [rad].
    """

    max_speed: float
    acceleration: float
    braking: float
    delay: float
    offset: float
    kick_speed: float
    kick_error: float


FITTED_TRAITS = record_dtype(Traits)
"""The record of :class:`Traits`."""


class Population(Settings):
    """How goalkeepers, and the kicks against them, are distributed.

    Speed, acceleration, braking and delay are log-normal, independent and of one spread; the
    offset and the kick's error are normal about 0.
    """

    max_speed: float = Field(gt=0, le=10, description="median of the top speed [m/s]")
    acceleration: float = Field(gt=0, le=50, description="median of the robot's acceleration [m/s^2]")
    braking: float = Field(gt=0, le=50, description="median of the braking it drives by [m/s^2]")
    delay: float = Field(gt=0, le=0.5, description="median of the delay [s]")
    spread: float = Field(ge=0, le=1, description="standard deviation of the logarithms of these four")
    offset: float = Field(ge=0, le=0.2, description="standard deviation beside its place [m]")
    kick_speed: float = Field(gt=0, le=15, description="the ball's speed after the kick [m/s]")
    kick_error: float = Field(ge=0, le=0.3, description="standard deviation of the kick's direction [rad]")
    kick_follows: float = Field(
        0.0, ge=-1, le=1, description="share of the ball's bearing off the aim by which the kick goes astray"
    )
    bearing: float = Field(
        0.0, ge=-1, le=1, description="mean of that bearing, positive on the goalkeeper's side [rad]"
    )
    bearing_spread: float = Field(0.0, ge=0, le=1, description="standard deviation of that bearing [rad]")

    def sample(self, rng: np.random.Generator) -> Traits:
        """Sample one goalkeeper and kick from ``rng``; its error counts positive towards the goalkeeper."""
        (drawn,) = self.traits(rng.standard_normal((1, DIMENSIONS))).tolist()
        traits = Traits(*drawn)
        astray = self.kick_follows * rng.normal(self.bearing, self.bearing_spread)
        return traits._replace(kick_error=traits.kick_error + astray)

    def traits(self, normal: FloatArray) -> FloatArray:
        """Return the :class:`Traits` (n, 7) that standard normal numbers (n, 6) stand for."""
        rows = np.empty((len(normal), len(Traits._fields)))
        medians = (self.max_speed, self.acceleration, self.braking, self.delay)
        rows[:, :4] = np.array(medians) * np.exp(self.spread * normal[:, :4])
        *_, beside, astray = normal.T
        drawn = rows.view(FITTED_TRAITS)[:, 0]
        drawn["offset"], drawn["kick_speed"] = self.offset * beside, self.kick_speed
        drawn["kick_error"] = self.kick_error * astray
        return rows

    def write(self, path: Path) -> None:
        """Write it to ``path``, as YAML that :func:`read_population` reads."""
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, write_yaml(self.model_dump()))


DIMENSIONS = 6
"""Random numbers that one goalkeeper takes."""


def read_population(path: Path) -> Population:
    """Read a population from a YAML file.

    Raises:
        ConfigError: the file cannot be read, or a field does not fit; the message names both.
    """
    data = read_yaml(path)
    try:
        return Population.model_validate(data)
    except ValidationError as error:
        field, problem = first_problem(error, Population, data)
        raise ConfigError(str(path), problem, field) from error
