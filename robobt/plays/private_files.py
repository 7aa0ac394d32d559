"""Private plays of Python files, so that two versions of one team can play each other.

Such a play is named by its file, ``old/my_team.py:striker``. Only the file's own plays find what it
registers, and the modules that it imports from its folder are private too.
"""

from __future__ import annotations

import builtins
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout
from functools import partial
from importlib import import_module
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

from robobt.config.process import users_code
from robobt.plays.python_files import import_files, imported_files, problem_of
from robobt.plays.sources import NOBODYS, Sources, read_sources
from robobt.tree.namespace import Namespace, within

_PREFIX = "robobt_private_"
"""Prefix of the packages of private modules."""

_FILES_AND_PLAY = re.compile(r"(?P<files>[^=]+?\.py(?:,[^=]+?\.py)*):(?P<play>[^=]+)")


def split_play(name: str) -> tuple[tuple[str, ...], str]:
    """Return the Python files in a play's name, and the name within them; no files for a public name.

    ``old/my_team.py:striker`` has one file, ``old/skills.py,old/plays.py:striker`` has two.
    """
    named = _FILES_AND_PLAY.fullmatch(name)
    if named is None:
        return (), name
    return tuple(re.split(r"(?<=\.py),", named["files"])), named["play"]


def join_play(files: Sequence[str | Path], name: str) -> str:
    """Join files and play into one name; the inverse of :func:`split_play`. Return it."""
    return f"{','.join(map(str, files))}:{name}" if files else name


class PrivateFiles(Namespace):
    """The registrations of Python files, and the modules that they run as.

    Args:
        shown: the files as given, for messages.
        sources: the files' text.

    Raises:
        PythonFileError: a file raises when it runs.
    """

    def __init__(self, shown: Sequence[str], sources: Sources) -> None:
        super().__init__()
        self.sources = sources
        self.package = f"{_PREFIX}{sources.digest()[:16]}_{len(_packages)}"
        _packages[self.package] = self
        module = ModuleType(self.package)
        module.__path__ = []
        sys.modules[self.package] = module
        for file, name in zip(shown, sources.entries, strict=True):
            try:
                # Its output must not mix with a command's figures.
                with redirect_stdout(sys.stderr), users_code(file):
                    import_module(f"{self.package}.{name}")
            except (Exception, SystemExit) as error:
                for known in [known for known in sys.modules if f"{known}.".startswith(f"{self.package}.")]:
                    del sys.modules[known]
                raise problem_of(error, Path(sources.modules[name].path), file) from error

    def run(self, module: ModuleType) -> None:
        """Run one of the modules."""
        source = self.sources.modules[module.__name__.partition(".")[2]]
        # Its functions then import the private modules at any time, also later.
        module.__dict__["__builtins__"] = {**vars(builtins), "__import__": self._import}
        with within(self):
            exec(compile(source.text, source.path, "exec", dont_inherit=True), module.__dict__)

    def _import(
        self,
        name: str,
        given: Mapping[str, object] | None = None,
        local: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """Import like the statement ``import``, with the private modules first."""
        top = name.partition(".")[0]
        if level:
            return builtins.__import__(name, given, local, fromlist or (), level)
        if top in NOBODYS or not self.sources.owns(top):
            # Registrations of other modules at their first import are public.
            with within(None):
                return builtins.__import__(name, given, local, fromlist or (), 0)
        if fromlist:
            return builtins.__import__(f"{self.package}.{name}", given, local, fromlist, 0)
        import_module(f"{self.package}.{name}")
        return sys.modules[f"{self.package}.{top}"]


class _Finder:
    """Finds private modules in the sources that were read."""

    @staticmethod
    def find_spec(name: str, _path: object = None, _target: object = None) -> ModuleSpec | None:
        package, _, inner = name.partition(".")
        owner = _packages.get(package)
        if owner is None or not inner:
            return None
        source = owner.sources.modules.get(inner)
        if source is not None:
            folder = [str(Path(source.path).parent)] if source.package else None
            return spec_from_file_location(
                name, source.path, loader=_Loader(owner), submodule_search_locations=folder
            )
        return ModuleSpec(name, None, is_package=True) if owner.sources.owns(inner) else None


class _Loader(Loader):
    """Runs private modules."""

    def __init__(self, owner: PrivateFiles) -> None:
        self._owner = owner

    def create_module(self, spec: ModuleSpec) -> None:
        """Use Python's default."""

    def exec_module(self, module: ModuleType) -> None:
        self._owner.run(module)


_packages: dict[str, PrivateFiles] = {}
_by_place: dict[tuple[Path, ...], PrivateFiles] = {}
_by_name: dict[tuple[str, ...], PrivateFiles] = {}
"""Private files sent to this process, by the file names given where they were read."""

sys.meta_path.insert(0, _Finder)


def private_files(name: str) -> PrivateFiles | None:
    """Return the private files of a play's name, run once per process; None for a public play.

    Raises:
        PythonFileError: a file cannot be read, or raises when it runs.
    """
    files, _ = split_play(name)
    if not files:
        return None
    if files in _by_name:
        return _by_name[files]
    places = tuple([Path(file).absolute() for file in files])
    if places not in _by_place:
        _by_place[places] = PrivateFiles(files, read_sources(files))
    return _by_place[places]


def sender(names: Sequence[str] = ()) -> Callable[[], None]:
    """Return an object that gives another process the Python files of plays' ``names`` as they are here."""
    sent: dict[tuple[str, ...], Sources] = {}
    for name in names:
        owner = private_files(name)
        if owner is not None:
            sent[split_play(name)[0]] = owner.sources
    return partial(_know, imported_files(), sent)


def _know(imported: tuple[Path, ...], sent: Mapping[tuple[str, ...], Sources]) -> None:
    import_files(imported)
    for files, sources in sent.items():
        if files not in _by_name:
            _by_name[files] = PrivateFiles(files, sources)
