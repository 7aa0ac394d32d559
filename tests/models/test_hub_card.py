"""A model's page has the metadata that hubs read, and says what its card says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.config.resources import models_folder
from robobt.config.yaml import parse_marked
from robobt.models.file import read_model_file
from robobt.models.hub_card import hub_page

SHIPPED = sorted(models_folder().glob("*.pt"))


def split(page: str) -> tuple[dict[str, Any], str]:
    """Return the metadata and the text below."""
    before, metadata, text = page.split("---\n", 2)
    assert before == ""
    plain = parse_marked(metadata, "metadata").plain()
    assert isinstance(plain, dict)
    return plain, text


@pytest.mark.parametrize("path", SHIPPED, ids=[path.stem for path in SHIPPED])
def test_hubs_read_what_the_card_says(path: Path) -> None:
    file = read_model_file(path)
    metadata, text = split(hub_page(file, "mit"))
    policy = file.card.kind == "policy"
    assert metadata["library_name"] == "robobt"
    assert metadata["license"] == "mit"
    assert metadata["pipeline_tag"] == ("reinforcement-learning" if policy else "tabular-classification")
    assert {"robotics", file.card.skill} <= set(metadata["tags"])
    assert metadata["metrics"] == list(file.card.held_out)
    (model,) = metadata["model-index"]
    (result,) = model["results"]
    assert model["name"] == path.stem
    assert result["task"]["type"] == metadata["pipeline_tag"]
    assert result["dataset"]["name"]
    assert {one["type"]: one["value"] for one in result["metrics"]} == {
        name: one.value for name, one in file.card.held_out.items()
    }
    assert {one["type"]: one["args"]["n"] for one in result["metrics"]} == {
        name: one.n for name, one in file.card.held_out.items()
    }
    assert f"# {path.stem}\n" in text
    assert file.sha256 in text
    assert f'load_policy("{path.name}")' in text


def test_a_licence_that_nobody_told_is_left_out() -> None:
    metadata, _ = split(hub_page(read_model_file(SHIPPED[0])))
    assert "license" not in metadata


def test_the_page_is_written_beside_a_model(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["show", "duel_ppo", "--out", str(tmp_path / "README.md")])
    assert done.exit_code == 0, done.stderr
    metadata, _ = split((tmp_path / "README.md").read_text())
    assert metadata["license"] == "mit"
    own = tmp_path / "mine.pt"
    own.write_bytes((models_folder() / "duel_ppo.pt").read_bytes())
    done = CliRunner().invoke(app, ["show", str(own), "--out", str(tmp_path / "own.md")])
    assert "add the model's license" in " ".join(done.output.split())
    assert "license" not in split((tmp_path / "own.md").read_text())[0]
