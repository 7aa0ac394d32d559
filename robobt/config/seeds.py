"""How large a seed may be."""

from __future__ import annotations

MAX_SEED = 2**53 - 1
"""The largest seed that every JSON reader keeps exactly."""
