"""What is closed at the end of a ``with`` block."""

from __future__ import annotations

from typing import Self


class Closing:
    """Something with a ``close``, which ``with`` calls at the end of its block."""

    __slots__ = ()

    def close(self) -> None:
        """Let go of whatever this holds."""
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
