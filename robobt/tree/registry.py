"""Registries by name: skills, plays, raters, from this package and others."""

from __future__ import annotations

import inspect
import logging
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar, Generic, TypeVar

from robobt.config.errors import unknown_name
from robobt.tree.namespace import current_namespace, within

T = TypeVar("T")

_log = logging.getLogger(__name__)


class Registry(Generic[T]):
    """A mapping from names to things of one kind.

    Other packages add to it through an entry point group. An entry point names
    either the thing itself, which is then entered under the entry point's name,
    or a module that enters things as it is imported. They are loaded when the
    registry is first listed or asked for a name it does not know. What comes
    first keeps its name: the package's own things, then those of the
    distributions in alphabetical order. A distribution that cannot be loaded, or
    claims a name that is taken, does not affect the others: its error is in :attr:`problems`. Inside
    :func:`~robobt.tree.namespace.within` objects are registered in that namespace, and found there first.

    Args:
        kind: kind of its objects, for messages ("play").
        group: entry point group that other packages add to, None for none.
        fits: returns whether an object is of that kind; used for other packages' entries.

    Attributes:
        foreign: names under which code outside robobt has registered something in any registry so far.
    """

    foreign: ClassVar[set[str]] = set()

    def __init__(
        self, kind: str, group: str | None = None, fits: Callable[[object], bool] | None = None
    ) -> None:
        self.kind = kind
        self.group = group
        self._fits = fits
        self._entries: dict[str, T] = {}
        self._sources: dict[str, str] = {}
        self._problems: dict[str, str] = {}
        self._loaded = group is None
        self._loading: str | None = None

    def register(self, name: str = "") -> Callable[[T], T]:
        """Return a decorator that registers the decorated object under ``name``.

        Raises:
            TypeError: there is no name, as in ``@register`` and ``@register()``.
            ValueError: the name is taken; the message names both.
        """
        if not isinstance(name, str) or not name:
            registry = "" if self.group is None else self.group.rpartition(".")[2].upper() + "."
            meant = getattr(name, "__name__", "foo")
            raise TypeError(f'{registry}register takes a name: write @{registry}register("{meant}")')

        def enter(entry: T) -> T:
            if (getattr(entry, "__module__", None) or "").partition(".")[0] != "robobt":
                Registry.foreign.add(name)
            namespace = current_namespace()
            entries = self._entries if namespace is None else namespace.of(self)
            if name in entries:
                source = self._sources.get(name) if namespace is None else None
                raise ValueError(
                    f"{self.kind} {name!r} is registered twice: "
                    f"{_say(entries[name], source)} and {_say(entry, self._loading)}; "
                    f"{_way_out(entries[name], entry)}"
                )
            if namespace is not None:
                entries[name] = entry
                return entry
            self._entries[name] = entry
            if self._loading is not None:
                self._sources[name] = self._loading
            return entry

        return enter

    def undo_point(self) -> Callable[[], None]:
        """Return a function that undoes what is registered later, except other packages' entries."""
        self._load()
        entries, sources = dict(self._entries), dict(self._sources)

        def undo() -> None:
            self._entries, self._sources = dict(entries), dict(sources)

        return undo

    @property
    def problems(self) -> tuple[str, ...]:
        """What is wrong with other packages' entries, a line each that names the distribution."""
        self._load()
        return tuple(self._problems.values())

    def problem_with(self, name: str) -> str | None:
        """Return why the entry of another package under this name could not be loaded, else None."""
        self._load()
        return self._problems.get(name)

    def meant(self, name: object) -> str:
        """Return the end of a message about a name that is not there: which are near, or all."""
        command = "" if self.group is None else f"robobt list {self.group.rpartition('.')[2]}"
        return unknown_name(name, self, command=command)

    def source(self, name: str) -> str | None:
        """Return the distribution whose entry point brought ``name``, None for the package's own entries."""
        return self._sources.get(name)

    def __getitem__(self, name: str) -> T:
        """Return the entry.

        Raises:
            KeyError: no such name; the message lists the names there are, names the
                nearest of many, or says why the entry of another package could not be loaded.
        """
        own = self._own()
        if name in own:
            found: T = own[name]
            return found
        if name not in self._entries:
            self._load()
        if name not in self._entries:
            if name in self._problems:
                raise KeyError(self._problems[name])
            raise KeyError(f"no {self.kind} is called {name!r}; {self.meant(name)}")
        return self._entries[name]

    def __contains__(self, name: object) -> bool:
        if name in self._own():
            return True
        if name not in self._entries:
            self._load()
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        self._load()
        return iter(sorted({*self._entries, *self._own()}))

    def __len__(self) -> int:
        self._load()
        return len({*self._entries, *self._own()})

    def _own(self) -> dict[str, Any]:
        namespace = current_namespace()
        return {} if namespace is None else namespace.of(self)

    def _load(self) -> None:
        if not self._loaded:
            # Other packages' objects are public, in every namespace.
            with within(None):
                self._load_packages()

    def _load_packages(self) -> None:
        # Set first: what is being loaded may look names up itself.
        self._loaded = True
        found = entry_points(group=self.group) if self.group is not None else ()
        for point in sorted(found, key=lambda point: (_distribution(point), point.name)):
            self._loading = _distribution(point)
            before = set(self._entries)
            try:
                self._enter(point)
            except (Exception, SystemExit) as error:
                # A module that raises half-way has entered only half of what belongs together.
                for name in set(self._entries) - before:
                    del self._entries[name], self._sources[name]
                self._refuse(point, f"{type(error).__name__}: {error}")
            finally:
                self._loading = None

    def _enter(self, point: EntryPoint) -> None:
        entry = point.load()
        if isinstance(entry, ModuleType):
            return
        if self._fits is not None and not self._fits(entry):
            raise TypeError(f"{_say(entry, None)} is not a {self.kind}")
        # Importing its module may have entered it already, through a decorator.
        if point.name not in self._entries or self._entries[point.name] is not entry:
            self.register(point.name)(entry)

    def _refuse(self, point: EntryPoint, reason: str) -> None:
        words = " ".join(reason.split())
        problem = (
            f"{self.kind} {point.name!r} ({point.value}) of the distribution "
            f"{_distribution(point)} cannot be used: {words}"
        )
        # Two distributions may claim one name; neither report hides the other.
        key = point.name if point.name not in self._problems else f"{point.name} of {_distribution(point)}"
        self._problems[key] = problem
        _log.warning("%s", problem)


def _distribution(point: EntryPoint) -> str:
    return point.dist.name if point.dist is not None else "?"


def _say(entry: object, source: str | None) -> str:
    qualname = getattr(entry, "__qualname__", repr(entry))
    where = f"{getattr(entry, '__module__', '?')}.{qualname}"
    if source is not None:
        return f"{where} of the distribution {source}"
    file, line = _place(entry)
    return where if file is None else f"{_shown(file)}:{line}: {qualname}"


def _place(entry: Any) -> tuple[Path | None, int]:
    """Return where a class or function begins that is not robobt's; no file where that is not known."""
    try:
        if entry.__module__.partition(".")[0] == "robobt":
            return None, 0
        found = inspect.unwrap(entry)
        file = inspect.getsourcefile(found)
        return None if file is None else Path(file), inspect.getsourcelines(found)[1]
    except (AttributeError, TypeError, OSError):
        return None, 0


def _shown(file: Path) -> Path:
    return file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file


def _way_out(first: object, second: object) -> str:
    """Return what to do about two things with one name."""
    files = [_place(entry)[0] for entry in (first, second)]
    if None in files or files[0] == files[1]:
        return "give one of them another name"
    blue, yellow = [f"{_shown(file)}:PLAY" for file in files if file is not None]
    return (
        "give one of them another name, or let two states of one team meet without --import: "
        f"robobt match SCENARIO --blue {blue} --yellow {yellow}"
    )
