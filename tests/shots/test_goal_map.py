from pathlib import Path

import numpy as np
import pytest

from robobt.models.file import ModelError
from robobt.shots.goal_map import draw_goal_map, goal_map

PNG = b"\x89PNG"


def test_the_map_is_symmetric_and_near_places_are_better_than_far_ones(tmp_path: Path):
    found = goal_map(spacing=0.5)
    assert np.allclose(found.probability, found.probability[::-1], atol=1e-4, equal_nan=True)
    middle = found.probability[len(found.y) // 2]
    assert middle[list(found.x).index(3.0)] > 0.9 > 0.1 > middle[0]
    draw_goal_map(found, tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes()[:4] == PNG
    assert np.isnan(found.probability).any()


def test_a_predictor_that_sees_something_else_is_refused_with_the_reason():
    with pytest.raises(ModelError, match="shot_nn"):
        goal_map("shot_nn")
