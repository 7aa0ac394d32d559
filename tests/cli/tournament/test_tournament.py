"""``robobt tournament``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app

QUICK = (
    "--scenario",
    "striker_vs_goalkeeper",
    "--set",
    "ends.time_limit=0.3",
    "--rounds",
    "1",
    "--workers",
    "0",
)


def invoke(*options: object) -> Result:
    return CliRunner().invoke(app, ["tournament", "run", *map(str, options)])


def plain(shown: Result) -> str:
    return " ".join(shown.output.replace("│", " ").split())


@pytest.mark.integration
def test_a_tournament_is_played_kept_told_and_reported(tmp_path: Path) -> None:
    store, page = tmp_path / "night.sqlite", tmp_path / "night.html"
    given = (
        "take_shot",
        "attack_main:speed_factor=0.5,rater=open_angle",
        "attack_nn",
        *QUICK,
        "--out",
        store,
    )
    shown = invoke(*given, "--html", page, "--recordings", "worst", "--json")
    assert shown.exit_code == 0, shown.output
    said = json.loads(shown.stdout)
    assert (said["matches"], said["distinct"], said["failed"]) == (6, 6, {})
    assert set(said["standings"]) == {
        "take_shot",
        "attack_main:speed_factor=0.5,rater=open_angle",
        "attack_nn",
    }
    assert [(one["first"], one["matches"]) for one in said["encounters"]] == [
        ("take_shot", 2),
        ("take_shot", 2),
        ("attack_main:speed_factor=0.5,rater=open_angle", 2),
    ]
    assert page.read_text().count(".recordings/") == 2
    again = invoke(*given)
    assert again.exit_code == 0
    assert "striker_vs_goalkeeper: 6 matches, seed 1, no referee" in again.output
    assert "won-drawn-lost of the row against the column" in again.output


@pytest.mark.integration
def test_a_sequential_test_that_stays_undecided_exits_with_2() -> None:
    shown = invoke("take_shot", "--against", "attack_main", "--sprt", "0", "30", *QUICK)
    assert shown.exit_code == 2
    assert "undecided between take_shot and attack_main after 1 round" in plain(shown)
    assert "bounds -2.94 (beta 0.05) and 2.94 (alpha 0.05)" in plain(shown)


@pytest.mark.parametrize(("goals", "code"), [((1, 0), 0), ((0, 1), 1)])
def test_a_sequential_test_exits_with_what_it_found(
    goals: tuple[int, int], code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    from robobt.tournament.fixtures import Fixture
    from robobt.tournament.job import Job
    from tests.tournament.made_up import played

    def decided(_: Job, fixture: Fixture, __: object) -> object:
        return played(*fixture, goals if fixture.blue == "take_shot" else goals[::-1])

    monkeypatch.setattr(Job, "play", decided)
    given = ("take_shot", "--against", "attack_main", "--sprt", "0", "100", *QUICK[:-4], "--workers", "0")
    shown = invoke(*given, "--json")
    assert shown.exit_code == code
    said = json.loads(shown.stdout)
    assert said["sprt"]["verdict"] == ("better", "not better")[code]
    assert said["matches"] < 100
    assert (said["sprt"]["alpha"], said["sprt"]["beta"]) == (0.05, 0.05)
    # Who may err more often knows sooner.
    soon = json.loads(invoke(*given, "--alpha", 0.2, "--beta", 0.2, "--json").stdout)
    assert (soon["sprt"]["alpha"], soon["sprt"]["beta"]) == (0.2, 0.2)
    assert soon["matches"] < said["matches"]


@pytest.mark.parametrize("options", [(), ("--json",)])
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_sequential_test_whose_tables_nobody_reads_exits_with_what_it_found(
    stream: str, options: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    from robobt.cli import common
    from robobt.cli.tournament import tournament as command
    from robobt.tournament.job import Job
    from tests.tournament.made_up import played

    def nobody_reads(*_: object, **__: object) -> None:
        raise BrokenPipeError

    monkeypatch.setattr(Job, "play", lambda _, fixture, __: played(*fixture))
    if stream == "stdout":
        monkeypatch.setattr(command, "print_json", nobody_reads)
        monkeypatch.setattr(command.console, "print", nobody_reads)
    else:
        monkeypatch.setattr(common.errors, "print", nobody_reads)
        monkeypatch.setattr(command, "tell_code", lambda _: common.warn("two states of the code"))
    assert (
        invoke("take_shot", "--against", "attack_main", "--sprt", "0", "30", *QUICK, *options).exit_code == 2
    )


def test_a_report_that_cannot_be_written_costs_no_figures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from robobt.tournament.job import Job
    from tests.tournament.made_up import played

    def full(path: Path, *_: object) -> None:
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(Job, "play", lambda _, fixture, __: played(*fixture))
    monkeypatch.setattr("robobt.tournament.report.write_report", full)
    report = tmp_path / "report.html"
    shown = invoke("take_shot", "attack_main", *QUICK, "--html", report, "--json")
    assert json.loads(shown.stdout)["matches"] == 2
    assert (shown.exit_code, str(report) in shown.stderr) == (1, True)


def test_a_folder_in_the_place_of_a_report_is_refused_before_the_first_match(tmp_path: Path) -> None:
    shown = invoke("take_shot", "attack_main", *QUICK, "--html", tmp_path)
    assert (shown.exit_code, shown.stdout) == (1, "")
    assert "--html" in shown.stderr


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (("take_shot",), "a tournament needs two entrants"),
        (("take_shot", "take_shot"), "two entrants are called 'take_shot'"),
        (("take_shot", "take_sht"), "no play is called 'take_sht'"),
        (("take_shot", "attack_main:sped=1"), "no such parameter"),
        (("take_shot", "gone.yaml"), "gone.yaml: cannot be read"),
        (("take_shot", "attack_nn", "--scenario", "gone"), "no such file or bundled scenario"),
        (("take_shot", "attack_nn", "--scenario", "table4_trial1_own"), "where yellow has no robot"),
        (("take_shot", "attack_nn", "--set", "ends.time=3"), "ends.time: there is no such field"),
        (("take_shot", "attack_nn", "--recordings", "all"), "needs --out"),
        (("take_shot", "attack_nn", "--referee", "none"), "must be own or official"),
        (("take_shot", "attack_nn", "--alpha", "0.1"), "--alpha, --beta: are for --sprt"),
        (("take_shot", "attack_nn", "--speed-factor", "2"), "--speed-factor: is for matches with programs"),
        (("take_shot", "attack_nn", "--sprt", "0", "30"), "needs one entrant, and --against"),
        (
            ("take_shot", "attack_nn", "--out", "a.x", "--html", "./a.x"),
            "would take the place of the store a.x",
        ),
        (("take_shot", "attack_nn", "--out", __file__), "cannot be used: file is not a database"),
    ],
)
def test_what_does_not_fit_is_one_plain_error(options: tuple[str, ...], problem: str) -> None:
    shown = invoke("--scenario", "striker_vs_goalkeeper", *options)
    assert shown.exit_code in (1, 2)
    assert problem in plain(shown)
    assert "Traceback" not in shown.output


def test_a_program_that_is_not_there_is_told_before_any_match(tmp_path: Path) -> None:
    file = tmp_path / "theirs.yaml"
    file.write_text("entrant: theirs\nprogram: {command: [./no-such-program]}\n")
    given = (file, "--against", "take_shot", "--sprt", "0", "30", *QUICK)
    shown = invoke(*given, "--out", tmp_path / "a.sqlite")
    assert shown.exit_code == 1
    assert f"{file}: program.command.0: there is no such program: ./no-such-program" in plain(shown)
    assert not (tmp_path / "a.sqlite").exists()


def test_a_store_of_another_tournament_is_named_with_the_field(tmp_path: Path) -> None:
    store = tmp_path / "night.sqlite"
    given = ("take_shot", "attack_nn", *QUICK[:4], "--workers", "0", "--rounds", "1", "--out", store)
    assert invoke(*given).exit_code == 0
    shown = invoke(*given, "--seed", 5)
    assert shown.exit_code == 1
    assert f"{store}: seed: the store holds a tournament of '1', not of '5'; give another file" in plain(
        shown
    )


def test_a_stopped_tournament_says_what_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("robobt.tournament.job.Job.play", stopped)
    shown = invoke("take_shot", "attack_nn", *QUICK)
    assert shown.exit_code == 130
    assert "stopped after 0 of 2 matches; without --out nothing is kept" in plain(shown)


def test_a_program_that_is_no_game_controller_is_told_before_any_match(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from robobt.tournament.job import Job

    monkeypatch.setattr(Job, "play", lambda *_: pytest.fail("a match was tried"))
    wrong = tmp_path / "wrong"
    wrong.write_text("#!/bin/sh\nexit 3\n")
    wrong.chmod(0o755)
    given = ("take_shot", "attack_nn", *QUICK, "--referee", "official", "--game-controller", wrong)
    shown = invoke(*given, "--out", tmp_path / "a.sqlite")
    assert shown.exit_code == 1
    assert "wrong: the game controller does not start" in plain(shown)
    assert not (tmp_path / "a.sqlite").exists()
