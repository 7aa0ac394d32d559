"""What lies in a folder registers itself."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robobt.tree.discovery import import_all
from tests.registries import temporarily


def test_every_module_below_a_package_is_imported_in_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("b.py", "room/__init__.py", "room/inner.py", "__init__.py", "a.py"):
        file = tmp_path / "found_by_folder" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("import sys\nsys.found.append(__name__)\n")
    monkeypatch.setattr(sys, "found", [], raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    import_all("found_by_folder", [str(tmp_path / "found_by_folder")])
    found: list[str] = sys.found  # type: ignore[attr-defined]
    assert set(found) == {f"found_by_folder{rest}" for rest in ("", ".a", ".b", ".room", ".room.inner")}
    modules = [name for name in found if not hasattr(sys.modules[name], "__path__")]
    assert modules == sorted(modules)


def test_a_new_skill_needs_no_list(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import robobt.skills
    from robobt.skills import SKILLS

    (tmp_path / "dropped_in.py").write_text(
        "from robobt.skills.base import Skill, skill\n"
        "from robobt.tree import Status\n"
        "@skill\n"
        "class DroppedIn(Skill):\n"
        "    def on_running(self) -> Status:\n"
        "        return self.succeed()\n"
    )
    monkeypatch.setattr(robobt.skills, "__path__", [*robobt.skills.__path__, str(tmp_path)])
    with temporarily(SKILLS):
        import_all("robobt.skills", robobt.skills.__path__)
        assert "DroppedIn" in SKILLS
    assert "DroppedIn" not in SKILLS
    del sys.modules["robobt.skills.dropped_in"]
