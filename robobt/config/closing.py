"""Objects that are closed at the end of a ``with`` block."""

from __future__ import annotations

from typing import Self


class Closing:
    """An object whose ``close`` is called at the end of a ``with`` block."""

    __slots__ = ()

    def close(self) -> None:
        """Release all resources."""
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
