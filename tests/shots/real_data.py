"""The real shots, which lie beside the repository where they may be read."""

from pathlib import Path

import pytest

REAL_SHOTS = Path(__file__).resolve().parents[3] / "shared" / "data" / "shots"

needs_real_shots = pytest.mark.skipif(
    not (REAL_SHOTS / "train.csv").is_file(), reason="the real shots are not at ../shared/data/shots"
)
