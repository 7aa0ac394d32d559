"""``robobt compare``, and how the command line changes a scenario."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.cli.common import console

QUICK = ("--trials", "2", "--set", "ends.time_limit=0.3", "--workers", "1")


def run(*options: object) -> str:
    shown = CliRunner().invoke(app, [str(option) for option in options])
    assert shown.exit_code == 0, shown.output
    return shown.output


@pytest.mark.integration
def test_every_combination_is_played_from_the_same_starts(tmp_path: Path) -> None:
    plays = ("--blue", "attack_main", "--blue", "attack_main:speed_factor=0.5, rater=open_angle")
    keepers = ("--yellow", ":speed_factor=1.0", "--yellow", ":speed_factor=0.5")
    out = tmp_path / "kept"
    given = ("compare", "striker_vs_goalkeeper", *plays, *keepers, *QUICK, "--out", out, "--json")
    said = json.loads(run(*given))
    assert list(said["variants"]) == [
        "attack_main | :speed_factor=1.0",
        "attack_main | :speed_factor=0.5",
        "attack_main:speed_factor=0.5, rater=open_angle | :speed_factor=1.0",
        "attack_main:speed_factor=0.5, rater=open_angle | :speed_factor=0.5",
    ]
    first, *others = said["variants"].values()
    assert first["against_first"] is None
    assert first["distinct"] == 2
    assert all(one["against_first"]["scored"]["n"] == 2 for one in others)
    seeds = [
        [json.loads(line).get("seed") for line in path.read_text().splitlines()]
        for path in sorted(out.iterdir())
    ]
    assert len(seeds) == 4
    assert all(one[-2:] == seeds[0][-2:] for one in seeds)
    assert json.loads(run(*given)) == said


def test_the_figures_are_printed_as_tables() -> None:
    shown = run(
        "compare", "striker_vs_goalkeeper", "--blue", "attack_main", "--blue", ":speed_factor=0.5", *QUICK
    )
    assert "striker_vs_goalkeeper: 2 trials a variant, seed 1" in shown
    assert ":speed_factor=0.5, compared with attack_main:" in shown
    assert (
        "scores with :speed_factor=0.5 but not with attack_main in 0 trials, the other way round in 0."
        in shown
    )


def test_long_variants_are_told_apart_on_a_narrow_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(console, "width", 80)
    speeds = (
        "--blue",
        "attack_main:dribble_speed=1.25,speed_factor=0.5",
        "--blue",
        "attack_main:dribble_speed=1.25,speed_factor=0.75",
    )
    shown = run("compare", "striker_vs_goalkeeper", "--blue", "", *speeds, *QUICK)
    table, *rest = shown.split("compared with as it is:")
    assert len(rest) == 2
    assert "…" not in shown
    names = [line.split()[0] for line in table.splitlines() if line[:1].strip()]
    name = ["attack_main:", "dribble_speed=1.25,"]
    assert names[names.index(name[0]) :][:6] == [*name, "speed_factor=0.5", *name, "speed_factor=0.75"]


@pytest.mark.integration
def test_variants_with_names_alike_get_files_of_their_own(tmp_path: Path) -> None:
    tree = "play: mine\ntree: Stop\n"
    alike = [tmp_path / "my play.yaml", tmp_path / "my_play.yaml", tmp_path / ("my" * 120 + ".yaml")]
    for path in alike:
        path.write_text(tree)
    out = tmp_path / "kept"
    plays = [option for path in alike for option in ("--blue", str(path))]
    run("compare", "striker_vs_goalkeeper", *plays, *QUICK, "--out", out)
    assert len(list(out.iterdir())) == 3


def test_trials_that_are_the_same_match_are_told() -> None:
    fixed = ("--set", "blue 0.start.position=[-1, 0]", "--set", "ball.position=[0, 0]")
    shown = run(
        "compare",
        "striker_vs_goalkeeper",
        "--blue",
        ":speed_factor=1",
        "--blue",
        ":speed_factor=0.5",
        *fixed,
        *QUICK,
    )
    assert "only 1 of 2 trials differ; vary the starts or add noise" in " ".join(shown.split())


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ((), "needs two variants"),
        (("--blue", "attack_main", "--blue", "", "--out", __file__), "is not a folder"),
        (("--blue", "attack_main", "--blue", "attack_main"), "is given twice"),
        (("--blue", "attack_man", "--blue", "attack_nn"), "no play is called 'attack_man'"),
        (("--blue", ":sped=1", "--blue", "attack_nn"), "no such parameter"),
        (("--blue", ":speed_factor=1,speed_factor=2", "--blue", "attack_nn"), "a parameter is given twice"),
        (("--set", "ends.time=3"), "ends.time: there is no such field"),
        (("--set", "blue 0=3"), "takes a field or a parameter of the robot"),
        (("--set", "blue 7.play=goalkeeper"), "there is no robot 'blue 7'"),
    ],
)
def test_what_does_not_fit_is_one_plain_error(options: tuple[str, ...], problem: str) -> None:
    shown = CliRunner().invoke(app, ["compare", "striker_vs_goalkeeper", *options])
    assert shown.exit_code != 0
    assert problem in " ".join(shown.output.replace("│", " ").split())
    assert "Traceback" not in shown.output


@pytest.mark.parametrize(("kept", "told"), [(False, "nothing is kept"), (True, "the same command goes on")])
def test_a_run_that_is_stopped_says_what_is_kept(
    kept: bool, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("robobt.match.loop.MatchLoop.tick", stopped)
    out = ("--out", str(tmp_path)) if kept else ()
    given = ["compare", "striker_vs_goalkeeper", "--blue", "", "--blue", "attack_nn", *QUICK, *out]
    shown = CliRunner().invoke(app, given)
    assert shown.exit_code == 130
    assert told in " ".join(shown.stderr.split())


def test_a_tree_that_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def bursts(_: object) -> None:
        raise ZeroDivisionError("mine")

    monkeypatch.setattr("robobt.skills.aim.select_shot.SelectShot.on_running", bursts)
    shown = " ".join(
        run(
            "compare", "striker_vs_goalkeeper", "--blue", ":speed_factor=0.5", "--blue", "take_shot", *QUICK
        ).split()
    )
    assert ":speed_factor=0.5: trees failed in" in shown
    assert "ZeroDivisionError: mine" in shown
    assert "take_shot: trees failed in" not in shown


def test_match_takes_the_same_changes() -> None:
    short = ("match", "striker_vs_goalkeeper", "--trials", "1", "--set", "ends.time_limit=0.3", "--json")
    said = json.loads(run(*short, "--blue", "attack_nn", "--set", "simulator.preset=grsim"))
    assert said["time"]["mean"] == pytest.approx(0.3, abs=0.03)
    assert json.loads(run(*short))["trace"] != said["trace"]
