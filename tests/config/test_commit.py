"""What is kept says from which commit of robobt it was made, as far as anybody can know."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from robobt.config import commit
from robobt.config.commit import commit_of, source_commit

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="needs git")


def git(folder: Path, *arguments: str) -> str:
    who = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
    return subprocess.run(
        ["git", *who, *arguments], cwd=folder, check=True, capture_output=True, text=True
    ).stdout.strip()


@pytest.fixture
def package(tmp_path: Path) -> Path:
    package = tmp_path / "checkout" / "robobt"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("")
    git(package.parent, "init", "-q")
    git(package.parent, "add", ".")
    git(package.parent, "commit", "-qm", "first")
    return package


@needs_git
def test_a_checkout_tells_its_commit_and_whether_its_files_are_that_commits(package: Path) -> None:
    head = git(package, "rev-parse", "HEAD")
    assert commit_of(package) == head
    (package / "__init__.py").write_text("changed = True\n")
    assert commit_of(package) == f"{head}+"


@needs_git
def test_a_package_in_another_repositorys_folder_is_not_that_repository(package: Path) -> None:
    installed = package.parent / ".venv" / "robobt"
    installed.mkdir(parents=True)
    (installed / "__init__.py").write_text("")
    assert commit_of(installed) == ""


def test_without_git_a_wheel_tells_and_all_else_is_unknown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(commit, "BUILT_FROM", tmp_path / "commit.txt")
    assert source_commit.__wrapped__() == ""
    (tmp_path / "commit.txt").write_text("ab" * 20 + "\n")
    assert source_commit.__wrapped__() == "ab" * 20
