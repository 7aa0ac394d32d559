"""Plays, skills and raters in a user's Python file that is not installed."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Iterable
from contextlib import redirect_stdout
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any
from zlib import crc32

from robobt.config.process import users_code
from robobt.plays.base import PLAYS
from robobt.plays.sources import PythonFileError, read_python
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS
from robobt.skills.ball.go_to_ball import GO_TO_BALL_POLICIES
from robobt.tree import Registry
from robobt.world.observation import OWN_OBSERVATIONS

REGISTRIES: list[Registry[Any]] = [PLAYS, SKILLS, RATERS, GO_TO_BALL_POLICIES]
"""Registries that a file may add to; if it raises, its entries are removed."""

_imported: dict[Path, ModuleType] = {}


def import_file(path: str | Path) -> ModuleType:
    """Run the ``.py`` file at ``path`` and return it as a module.

    The plays, skills, raters and policies that it registers are there then.

    A file runs once; later calls return the same module. It can import modules beside it. Its output goes to
    stderr. If it raises, all its registrations are removed. Worker processes of a match run the same files
    (:func:`imported_files`).

    Raises:
        PythonFileError: the file cannot be read, or raises when it runs.
    """
    real, source = read_python(path)
    if real not in _imported:
        _imported[real] = _run(real, source, str(path))
    return _imported[real]


def import_files(paths: Iterable[str | Path]) -> None:
    """Run several files; see :func:`import_file`."""
    for path in paths:
        import_file(path)


def imported_files() -> tuple[Path, ...]:
    """Return the files that :func:`import_file` has run in this process, in order."""
    return tuple(_imported)


def _run(path: Path, source: bytes, shown: str) -> ModuleType:
    spec = spec_from_file_location(_own_name(path), path)
    assert spec is not None
    module = module_from_spec(spec)
    # At the end of the path, so that a file named like an installed module does not replace it.
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
    sys.modules[module.__name__] = module
    undo, observations = [registry.undo_point() for registry in REGISTRIES], dict(OWN_OBSERVATIONS)
    try:
        # Its output must not mix with a command's figures.
        with redirect_stdout(sys.stderr), users_code(shown):
            exec(compile(source, str(path), "exec"), module.__dict__)
    except (Exception, SystemExit) as error:
        del sys.modules[module.__name__]
        for take_back in undo:
            take_back()
        OWN_OBSERVATIONS.clear()
        OWN_OBSERVATIONS.update(observations)
        raise problem_of(error, path, shown) from error
    return module


def _own_name(path: Path) -> str:
    """Return a module name that no installed module has, the same in every process that runs this file."""
    return f"file_{path.stem.replace('.', '_')}_{crc32(bytes(path)):08x}"


def problem_of(error: BaseException, path: Path, shown: str) -> PythonFileError:
    """Return the error from running a file, with the line of the file that raised it or called what did."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        line, reason = error.lineno or None, error.msg
    else:
        lines = [
            part.lineno for part in traceback.extract_tb(error.__traceback__) if part.filename == str(path)
        ]
        line = lines[-1] if lines else None
        said = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
        reason = f"{type(error).__name__}: {said}" if said else type(error).__name__
    return PythonFileError(shown, reason, line=line)
