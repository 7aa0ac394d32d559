from pathlib import Path

import numpy as np
import pytest

from robobt.config.errors import ConfigError
from robobt.shots.keepers.population import DIMENSIONS, REAL, Traits, read_population

POPULATION = read_population(REAL)


def test_who_is_drawn_follows_from_the_generator():
    first, second = (POPULATION.sample(np.random.default_rng(3)) for _ in range(2))
    assert first == second
    assert first != POPULATION.sample(np.random.default_rng(4))


def test_goalkeepers_are_spread_about_the_median():
    normal = np.random.default_rng(0).standard_normal((4000, DIMENSIONS))
    speeds = POPULATION.traits(normal)[:, Traits._fields.index("max_speed")]
    assert np.median(speeds) == pytest.approx(POPULATION.max_speed, rel=0.01)
    assert np.log(speeds).std() == pytest.approx(POPULATION.spread, rel=0.05)


def test_a_kick_goes_astray_towards_the_goalkeeper_as_the_recorded_ball_lay():
    rng = np.random.default_rng(0)
    errors = [POPULATION.sample(rng).kick_error for _ in range(3000)]
    assert np.mean(errors) == pytest.approx(POPULATION.kick_follows * POPULATION.bearing, abs=0.001)


def test_a_population_is_read_as_it_was_written(tmp_path: Path):
    POPULATION.write(tmp_path / "a" / "mine.yaml")
    assert read_population(tmp_path / "a" / "mine.yaml") == POPULATION


def test_a_file_with_a_wrong_field_is_told_by_file_and_field(tmp_path: Path):
    file = tmp_path / "mine.yaml"
    file.write_text(REAL.read_text().replace("max_speed: ", "max_speed: -"))
    with pytest.raises(ConfigError, match=r"mine\.yaml.*max_speed"):
        read_population(file)
