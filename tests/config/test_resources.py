from pathlib import Path

import pytest

from robobt.config import resources


def test_a_checkout_has_them_beside_the_package():
    assert resources.scenarios_folder().parts[-2:] == ("examples", "scenarios")
    assert resources.models_folder().name == "models"
    assert "striker_vs_goalkeeper" in resources.bundled_scenarios()


def test_a_wheel_has_them_inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "scenarios").mkdir()
    (tmp_path / "scenarios" / "mine.yaml").write_text("")
    (tmp_path / "scenarios" / "notes.txt").write_text("")
    (tmp_path / "models").mkdir()
    monkeypatch.setattr(resources, "_DATA", tmp_path)
    assert resources.bundled_scenarios() == {"mine": tmp_path / "scenarios" / "mine.yaml"}
    assert resources.models_folder() == tmp_path / "models"
