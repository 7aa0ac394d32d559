"""What a network may take, whatever runs it; here, because nothing here needs torch."""

from __future__ import annotations

MAX_BYTES = 64 * 2**20
"""What all steps of a network may answer together, for a small batch [bytes]."""

MAX_PRODUCTS = 10**10
"""How many multiplications all steps of a network may take together, for a small batch."""
