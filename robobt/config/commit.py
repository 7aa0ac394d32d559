"""The commit of robobt that is running, stored in models and training runs."""

from __future__ import annotations

import subprocess
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
BUILT_FROM = PACKAGE / "commit.txt"
"""File in a wheel with the commit it was built from; see ``hatch_build.py``."""

_GIT_TIMEOUT = 10.0
"""Timeout for git [s]."""


@cache
def source_commit() -> str:
    """Return the commit of the code, as git writes it, followed by "+" if files were changed since.

    Empty if unknown: neither a checkout nor a wheel that was built from one.
    """
    return commit_of(PACKAGE) or (BUILT_FROM.read_text("ascii").strip() if BUILT_FROM.is_file() else "")


def commit_of(package: Path) -> str:
    """Return the commit of a folder tracked by git, as :func:`source_commit` does; empty for any other.

    An installed package may be in a folder of another repository that does not track it.
    """
    if _git(package, "ls-files", "--error-unmatch", "__init__.py") is None:
        return ""
    commit = _git(package, "rev-parse", "HEAD")
    changed = _git(package, "status", "--porcelain", "--", ".")
    return f"{commit}+" if commit and changed else commit or ""


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(
            ["git", *arguments], cwd=folder, capture_output=True, text=True, timeout=_GIT_TIMEOUT, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return None if done.returncode else done.stdout.strip()
