"""The real shots, which are not part of the repository: ``ROBOBT_REAL_SHOTS`` names their folder."""

import os
from pathlib import Path

import pytest

_BESIDE = Path(__file__).resolve().parents[3] / "shared" / "data" / "shots"

REAL_SHOTS = Path(os.environ.get("ROBOBT_REAL_SHOTS", _BESIDE))

needs_real_shots = pytest.mark.skipif(
    not (REAL_SHOTS / "train.csv").is_file(),
    reason="the real shots are not there; ROBOBT_REAL_SHOTS names the folder with the author's train.csv",
)
