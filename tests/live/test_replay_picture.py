"""Pictures and animations show what was recorded, and when."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence
from typer.testing import CliRunner

import robobt
from robobt.cli import app
from robobt.match.recording import Recording, load_recording

BLUE, YELLOW, BALL, RUNNING = (47, 111, 237), (242, 194, 27), (255, 122, 26), (47, 125, 240)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    file = tmp_path_factory.mktemp("played") / "match.robobt.arrows"
    robobt.play_match(robobt.load_scenario("striker_vs_goalkeeper").lasting(1.0), seed=1, record=file)
    return load_recording(file)


def replay(recording: Recording, *arguments: str | Path) -> str:
    done = CliRunner().invoke(app, ["show", str(recording.path), *map(str, arguments)])
    assert done.exit_code == 0, done.output
    return done.output


def where(picture: Image.Image, colour: tuple[int, int, int]) -> tuple[float, float]:
    """The middle of what has a colour within the lines [m]."""
    pixels = np.asarray(picture.convert("RGB")).astype(int)[:, :640]
    rows, columns = np.nonzero(np.abs(pixels - colour).sum(axis=2) < 30)
    scale = 640 / 9.6
    x, y = (columns + 0.5 - 320) / scale, (220 - rows - 0.5) / scale
    inside = np.abs(x) < 4.45
    return float(x[inside].mean()), float(y[inside].mean())


def test_a_picture_shows_robots_and_ball_where_they_were(recording: Recording, tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "moment.png"
    made = f"robobt: --out: made the folder {path.parent}\n"
    assert replay(recording, "--out", path, "--from", "0.5") == f"{made}Picture: {path}\n"
    frame = recording.frame(int(np.searchsorted(recording.times, 0.5, side="right")) - 1)
    with Image.open(path) as picture:
        assert where(picture, BLUE) == pytest.approx(frame.own[0].position, abs=0.03)
        assert where(picture, YELLOW) == pytest.approx(frame.opponents[0].position, abs=0.03)
        assert where(picture, BALL) == pytest.approx(frame.ball.position, abs=0.03)


def test_a_robots_tree_stands_beside_the_field(recording: Recording, tmp_path: Path) -> None:
    replay(recording, "--out", tmp_path / "bare.png")
    replay(recording, "--out", tmp_path / "tree.png", "--robot", "blue 0")
    with Image.open(tmp_path / "bare.png") as bare, Image.open(tmp_path / "tree.png") as tree:
        panel = np.asarray(tree)[:, bare.width :]
        assert bare.height == tree.height
    dots = (panel == RUNNING).all(axis=2).any(axis=1)
    rows = np.count_nonzero(np.diff(dots.astype(int)) == 1)
    assert rows == recording.statuses_at(recording.header.robots[0].id, len(recording) - 1).count("R")


def test_an_animation_takes_as_long_as_what_it_shows(recording: Recording, tmp_path: Path) -> None:
    path = tmp_path / "part.gif"
    assert replay(recording, "--out", path, "--from", "0.2", "--to", "0.92") == f"Animation: {path}\n"
    with Image.open(path) as animation:
        shown = [picture.copy() for picture in ImageSequence.Iterator(animation)]
        assert animation.info["loop"] == 0
    assert {picture.info["duration"] for picture in shown} == {80}
    assert len(shown) == 9  # the last at 0.84 s
    for picture, time in ((shown[0], 0.2), (shown[-1], 0.84)):
        tick = int(np.searchsorted(recording.times, time, side="right")) - 1
        assert where(picture, BLUE) == pytest.approx(recording.frame(tick).own[0].position, abs=0.03)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--out", "x.png", "--from", "9"], "holds 0.00 to 1.00 s, not 9 s"),
        (["--out", "x.gif", "--from", "0.5", "--to", "0.5"], "are no animation"),
        (["--out", "x.gif", "--robot", "blue 7"], "no tree was recorded of 'blue 7'"),
        (["--to", "3"], "does nothing here"),
        (["--robot", "blue 0"], "does nothing here"),
        (["--live", "--out", "x.gif"], "does nothing here"),
    ],
)
def test_what_cannot_be_shown_is_said(
    recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["show", str(recording.path), *arguments])
    assert done.exit_code != 0
    assert said in " ".join(f"{done.output} {done.exception}".replace("│", " ").split())
    assert not list(tmp_path.iterdir())
