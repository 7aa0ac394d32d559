"""The Python files of a team: the files named, and the team's modules that they import."""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from robobt.config.errors import ConfigError

NOBODYS = frozenset({*sys.stdlib_module_names, "robobt"})
"""Modules that never belong to a team, whatever is beside its files."""


class PythonFileError(ConfigError):
    """A Python file that cannot be used."""


@dataclass(slots=True, frozen=True)
class Source:
    """A module: its path, its text, and whether it is a package's ``__init__``."""

    path: str
    text: bytes
    package: bool


@dataclass(slots=True)
class Sources:
    """A team's modules, as read at one time.

    Attributes:
        entries: dotted names of the files that were named, in order.
        modules: every module by its dotted name.
    """

    entries: list[str] = field(default_factory=list)
    modules: dict[str, Source] = field(default_factory=dict)

    def digest(self) -> str:
        """Hash the texts, independent of the paths."""
        digest = hashlib.blake2b(repr(self.entries).encode(), digest_size=16)
        for name, source in sorted(self.modules.items()):
            digest.update(f"\n{name} {len(source.text)}\n".encode() + source.text)
        return digest.hexdigest()

    def owns(self, name: str) -> bool:
        """Return whether a module, or a folder that holds one, has this dotted name."""
        return name in self.modules or any(known.startswith(f"{name}.") for known in self.modules)


def read_python(file: str | Path) -> tuple[Path, bytes]:
    """Return the real path of a Python file, and its text.

    Raises:
        PythonFileError: it cannot be read, or is no Python file.
    """
    shown = str(file)
    try:
        path = Path(file).resolve()
        text = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise PythonFileError(shown, f"cannot be read: {reason}") from error
    if path.suffix != ".py":
        raise PythonFileError(shown, "is not a Python file; its name must end in .py")
    return path, text


def read_sources(files: Sequence[str | Path]) -> Sources:
    """Read Python files and all modules in their folders that they import anywhere in their text.

    A file beside an ``__init__.py`` is a module of that package, and its imports are searched in the
    package's folder. All modules of an imported package are read, because it may import them by computed
    names.

    Raises:
        PythonFileError: a file cannot be read or is no Python file, or two have one name.
    """
    found, roots = Sources(), []
    for file in files:
        path, text = read_python(file)
        root = path.parent
        while (root / "__init__.py").is_file():
            root = root.parent
        parts = [part.replace(".", "_") for part in path.relative_to(root).with_suffix("").parts]
        package = parts[-1] == "__init__"
        name = ".".join(parts[:-1] if package else parts)
        if name in found.entries:
            raise PythonFileError(str(file), f"another file given with it is the module {name} too")
        found.entries.append(name)
        found.modules[name] = Source(str(path), text, package)
        roots += [root] if root not in roots else []
    reader = _ImportReader(roots, found.modules)
    for name in found.entries:
        reader.follow(name)
    return found


class _ImportReader:
    """Reads what modules import from the folders ``roots`` into ``modules``."""

    def __init__(self, roots: Sequence[Path], modules: dict[str, Source]) -> None:
        self._roots, self._modules = roots, modules
        self._followed: set[str] = set()

    def follow(self, name: str) -> None:
        """Read all modules that a module imports, recursively."""
        waiting = [name]
        while waiting:
            name = waiting.pop()
            if name in self._followed:
                continue
            self._followed.add(name)
            for wanted in self._wanted(name, self._modules[name]):
                parts = wanted.split(".")
                if parts[0] in NOBODYS:
                    continue
                # A package runs before its modules.
                for end in range(1, len(parts) + 1):
                    waiting += self._read(".".join(parts[:end]))

    def _read(self, name: str) -> list[str]:
        """Read a module, or all modules of a package; return those that exist."""
        if name in self._modules:
            return [name]
        for root in self._roots:
            base = root.joinpath(*name.split("."))
            for path in (base / "__init__.py", base.with_name(f"{base.name}.py")):
                if path.is_file():
                    package = path.parent == base
                    self._modules[name] = Source(str(path), path.read_bytes(), package)
                    return [name, *(self._inside(name, base) if package else ())]
        return []

    def _inside(self, name: str, folder: Path) -> Iterator[str]:
        for path in sorted(folder.rglob("*.py")):
            parts = [name, *path.relative_to(folder).with_suffix("").parts]
            package = parts[-1] == "__init__"
            inner = ".".join(parts[:-1] if package else parts)
            if inner not in self._modules:
                self._modules[inner] = Source(str(path), path.read_bytes(), package)
                yield inner

    @staticmethod
    def _wanted(name: str, source: Source) -> Iterator[str]:
        """Yield the dotted names that a module imports; of ``from a import b`` also ``a.b``."""
        package = name if source.package else name.rpartition(".")[0]
        # For a file in a package, the package.
        yield from [package] if package else []
        try:
            tree = ast.parse(source.text)
        except (SyntaxError, ValueError):
            # The error is reported where the module runs.
            return
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                yield from [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                above = package.split(".") if package else []
                above = above[: len(above) - node.level + 1] if node.level else []
                base = ".".join([*above, *([node.module] if node.module else [])])
                yield from [base] if base else []
                yield from [f"{base}.{alias.name}" if base else alias.name for alias in node.names]
