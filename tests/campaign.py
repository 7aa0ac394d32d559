"""How long the slow tests of hostile files go on."""

from __future__ import annotations

import os


def count(whole: int) -> int:
    """So many files, or the share of them that the environment variable ROBOBT_CAMPAIGN says, such as 0.1."""
    return max(1, round(whole * float(os.environ.get("ROBOBT_CAMPAIGN", "1"))))
