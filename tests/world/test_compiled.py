"""What numba compiles runs wherever it is installed."""

from __future__ import annotations

from typing import Any

from robobt.world.compiled import compiled


def test_code_that_cannot_be_kept_is_compiled_all_the_same() -> None:
    # numba finds no folder for code that is in no file, as for that of a read-only installation.
    words: dict[str, Any] = {}
    exec("def double(x): return 2 * x", words)
    assert compiled(words["double"])(3) == 6
