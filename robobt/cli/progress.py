"""Progress bars of commands that take longer than a moment."""

from __future__ import annotations

from rich.markup import escape

from robobt.cli.screen import errors


class Progress:
    """A progress bar on stderr for ``total`` steps; nothing where stderr is no terminal."""

    def __init__(self, name: str, total: int) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
        from rich.progress import Progress as Bars

        self._bars = Bars(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=errors,
            transient=True,
            disable=not errors.is_terminal,
        )
        self._bar = self._bars.add_task(escape(name), total=total)

    def __enter__(self) -> Progress:
        self._bars.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bars.stop()

    def name(self, text: str) -> None:
        """Change what stands before the bar."""
        self._bars.update(self._bar, description=escape(text))

    def advance(self, steps: int = 1) -> None:
        """Count more steps as done."""
        self._bars.advance(self._bar, steps)

    def reach(self, done: int, total: int) -> None:
        """Say how many of how many steps are done, where ``total`` changes on the way."""
        self._bars.update(self._bar, completed=done, total=total)
