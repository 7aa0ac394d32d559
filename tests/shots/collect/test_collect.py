import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robobt.shots.collect.balanced import balanced_attempt
from robobt.shots.collect.collect import PAPER_COUNT, CollectionError, collect_shots, play_trial
from robobt.shots.collect.file import CollectionFile
from robobt.shots.collect.paper import PARTS, SECTIONS, paper_attempt, splits
from robobt.shots.collect.plan import CollectionSettings
from robobt.shots.collect.watch import LateWorld, take_shot
from robobt.shots.data.files import read_shots
from robobt.shots.data.schema import SHOT_COLUMNS, ShotDataError
from robobt.shots.keepers.population import REAL, read_population
from robobt.sim import SimWorld, preset
from robobt.world import RobotCommand, RobotId, Team
from robobt.world.field import DIVISION_B
from robobt.world.protocol import Placement
from tests.conftest import StartPython
from tests.waiting import soon

pytestmark = pytest.mark.integration

SETTINGS = CollectionSettings(seed=5)


def rows_of(path: Path) -> list[str]:
    """What the rows say, bit for bit; a number that is none equals itself."""
    return [repr(row) for row in read_shots(path).to_pylist()]


@pytest.fixture(scope="module")
def collected(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shots") / "shots.csv"
    collect_shots(SETTINGS, path, 80)
    return path


def test_there_is_one_row_a_shot_and_as_many_as_asked_for(collected: Path):
    table = read_shots(collected)
    assert table.num_rows == 80
    assert len(set(table.column("trial").to_pylist())) == 80


def test_the_same_shots_are_in_either_kind_of_file(collected: Path, tmp_path: Path):
    collect_shots(SETTINGS, tmp_path / "shots.parquet", 40)
    assert rows_of(tmp_path / "shots.parquet") == rows_of(collected)[:40]


def test_a_shot_is_played_the_same_again():
    first, second = play_trial(SETTINGS, 7), play_trial(SETTINGS, 7)
    assert repr(first) == repr(second)
    assert first.row is not None
    assert first.row["trial"] == 7


def test_both_scenarios_and_both_ranges_are_there(collected: Path):
    table = read_shots(collected)
    assert set(table.column("scenario").to_pylist()) == {"motion", "still"}
    assert set(table.column("variant").to_pylist()) == {"still", "mid_range", "close_range"}


def test_goals_and_misses_near_and_far_and_goalkeepers_on_and_off_the_line_are_there(collected: Path):
    table = read_shots(collected)
    near = table.column("distance_to_goal").to_numpy() < 2.0
    on_line = np.abs(table.column("opp_y").to_numpy()) < 0.2
    goals = table.column("success").to_numpy()
    assert 0.1 < near.mean() < 0.5
    assert 0.2 < on_line.mean() < 0.8
    assert 0.1 < goals.mean() < 0.6


def test_a_row_says_what_the_kick_did(collected: Path):
    table = read_shots(collected)
    assert np.nanmax(np.abs(table.column("kick_error").to_numpy())) < 0.05
    speeds = table.column("kick_speed").to_numpy()
    assert 6.5 < np.nanmedian(speeds) < 7.6
    assert np.abs(table.column("ball_forward").to_numpy() - 0.098).max() < 0.02


def test_places_are_even_over_range_angle_and_offset():
    attempts = [balanced_attempt(CollectionSettings(scenario="still", seed=3), i) for i in range(200)]
    params = [attempt.scenario.robots.blue[0].params for attempt in attempts]
    reach = [np.hypot(4.5 - p["place_x"], p["place_y"]) for p in params]
    assert np.histogram(reach, bins=4, range=(1.15, 4.8))[0].min() >= 25
    targets = [p["target_y"] for p in params]
    assert np.histogram(targets, bins=4, range=(-0.47, 0.47))[0].min() >= 40
    bearings = [np.arctan2(p["place_y"], 4.5 - p["place_x"]) for p in params]
    assert np.histogram(bearings, bins=4, range=(-1.3, 1.3))[0].min() >= 40


def test_a_shot_says_which_kind_of_goalkeeper_it_met(collected: Path, recorded: list[dict]):
    assert set(read_shots(collected).column("goalkeeper").to_pylist()) == {"half_speed", "full_speed"}
    assert {row["goalkeeper"] for row in recorded} == {"fitted"}


@pytest.mark.integration
def test_shots_are_collected_against_the_goalkeeper_of_robobulls():
    settings = CollectionSettings(seed=5, style="robobulls")
    rows = [play_trial(settings, trial).row for trial in range(4)]
    assert {row["goalkeeper"] for row in rows if row is not None} == {"robobulls"}


def test_several_opponents_are_there_when_asked_for():
    settings = CollectionSettings(seed=5, opponents=4)
    counts = {len(balanced_attempt(settings, i).scenario.robots.yellow) for i in range(40)}
    assert counts == {1, 2, 3, 4}


@pytest.fixture(scope="module")
def recorded() -> list[dict]:
    settings = CollectionSettings(seed=5, goalkeepers=read_population(REAL))
    return [play_trial(settings, trial).row for trial in range(60)]


def test_shots_against_fitted_goalkeepers_are_those_of_their_seed(recorded: list[dict]):
    settings = CollectionSettings(seed=5, goalkeepers=read_population(REAL))
    assert [repr(play_trial(settings, trial).row) for trial in range(8)] == [
        repr(row) for row in recorded[:8]
    ]


def test_most_shots_against_fitted_goalkeepers_begin_with_the_kick(recorded: list[dict]):
    at_kick = [row for row in recorded if row is not None and row["variant"] in ("at_kick", "recorded")]
    assert len(at_kick) > 0.6 * len(recorded)
    assert np.mean([row["time"] == 0.0 for row in at_kick]) > 0.9
    assert np.mean([row["v_towards_ball"] for row in at_kick]) > 0.3
    goals = np.mean([row["success"] for row in at_kick])
    assert 0.2 < goals < 0.8


def test_a_goalkeeper_that_acts_late_goes_on_as_it_moves_until_then():
    keeper = RobotId(Team.YELLOW, 0)
    bare = SimWorld(DIVISION_B, {keeper: None}, preset("robobulls"), 0.03)
    world = LateWorld(bare, keeper, 0.075, 0.03, {keeper: (0.0, 0.5)})
    world.reset(Placement({keeper: (4.0, 0.0, 0.0)}), 0)
    speeds = []
    for _ in range(6):
        speeds.append(world.truth().opponents[0].vy)
        world.act({keeper: RobotCommand(0.0, 0.0)})
    assert speeds[:3] == pytest.approx([0.5] * 3, abs=0.02)
    # Two periods and a half: the first command that counts is half of the old one.
    assert 0.2 < speeds[3] < 0.45
    assert speeds[5] < 0.2


def test_a_collection_that_was_cut_off_goes_on_where_it_was(collected: Path, tmp_path: Path):
    path = tmp_path / "shots.csv"
    collect_shots(SETTINGS, path, 30)
    described = path.with_name("shots.csv.json")
    described.write_text(described.read_text().replace('"complete": true', '"complete": false'))
    lines = path.read_bytes().splitlines(keepends=True)
    # Ten shots, not the first ones, and one that was cut short.
    path.write_bytes(b"".join(lines[:1] + lines[3:13]) + lines[13][:40])
    done = collect_shots(SETTINGS, path, 30)
    assert done.new == 20
    assert rows_of(path) == rows_of(collected)[:30]


def test_more_shots_can_be_asked_for_later(collected: Path, tmp_path: Path):
    path = tmp_path / "shots.parquet"
    collect_shots(SETTINGS, path, 20)
    assert collect_shots(SETTINGS, path, 20).new == 0
    assert collect_shots(SETTINGS, path, 35).new == 15
    assert rows_of(path) == rows_of(collected)[:35]
    assert not path.with_name("shots.parquet.csv").exists()


def test_every_column_is_described_beside_the_file(collected: Path):
    described = json.loads(collected.with_name("shots.csv.json").read_text())
    assert [column["name"] for column in described["columns"]] == [column.name for column in SHOT_COLUMNS]
    assert all(column["meaning"] for column in described["columns"])


def test_other_settings_do_not_go_on_with_a_collection(collected: Path):
    with pytest.raises(ShotDataError, match="seed 5, not 6"):
        collect_shots(CollectionSettings(seed=6), collected, 80)


def test_a_file_that_is_no_collection_is_left_alone(tmp_path: Path):
    path = tmp_path / "notes.csv"
    path.write_text("mine")
    with pytest.raises(ShotDataError, match=r"notes\.csv"):
        collect_shots(SETTINGS, path, 5)
    assert path.read_text() == "mine"
    with pytest.raises(ShotDataError, match=r"shots\.txt"):
        collect_shots(SETTINGS, tmp_path / "shots.txt", 5)


@pytest.mark.parametrize(("count", "workers"), [(0, 1), (5, 0), (10**9, 1)])
def test_arguments_out_of_range_are_refused(count: int, workers: int, tmp_path: Path):
    with pytest.raises(ValueError, match="must be 1 to"):
        collect_shots(SETTINGS, tmp_path / "shots.csv", count, workers)


def test_the_papers_protocol_has_its_own_number_of_shots(tmp_path: Path):
    settings = CollectionSettings(protocol="paper")
    with pytest.raises(ValueError, match="743 shots"):
        collect_shots(settings, tmp_path / "shots.csv", 5)
    assert PAPER_COUNT == sum(part.shots for part in PARTS) == 542 + 201
    assert sum(part.shots for part in PARTS[:7]) == 542


def test_the_papers_shots_are_attack_mains_with_its_tolerances():
    attempt = paper_attempt(CollectionSettings(protocol="paper"), 1)
    blue, yellow = attempt.scenario.robots.blue[0], attempt.scenario.robots.yellow[0]
    assert (blue.play, yellow.params["speed_factor"]) == ("attack_main", 0.5)
    assert blue.params["rater"] == {"name": "segment_clearance", "tolerance": attempt.labels["tolerance"]}
    assert attempt.labels["tolerance"] == 0.3645
    still = paper_attempt(CollectionSettings(protocol="paper"), 5)
    assert still.section in SECTIONS.values()


def test_an_attacker_that_leaves_its_section_has_taken_no_shot():
    attempt = paper_attempt(CollectionSettings(protocol="paper"), 7)
    assert take_shot(replace(attempt, section=None), 7)[0] is not None
    elsewhere = replace(attempt, section=((-4.5, -4.0), (-3.0, 3.0)))
    assert take_shot(elsewhere, 7)[0] is None


def test_the_papers_split_keeps_the_share_of_goals():
    success = [1, 0, 0] * 300
    names = splits(success[:743], seed=0)
    assert [names.count(name) for name in ("train", "valid", "test")] == [363, 179, 201]
    valid = [success[i] for i, name in enumerate(names) if name == "valid"]
    assert sum(valid) == round(179 * sum(success[:542]) / 542)


def test_a_trial_that_raises_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    def broken(*_: object) -> None:
        raise ValueError("no ball")

    monkeypatch.setattr("robobt.shots.collect.collect.play_trial", broken)
    with pytest.raises(CollectionError, match="trial 0: ValueError: no ball"):
        collect_shots(SETTINGS, tmp_path / "shots.csv", 5)


def kill_after(start_python: StartPython, path: Path, rows: int, workers: int) -> None:
    """Start a collection of 80 shots as a process of its own and kill it in the middle."""
    command = ["-m", "robobt", "shots", "collect", "--count", "80", "--seed", "5"]
    growing = path if path.suffix == ".csv" else path.with_name(path.name + ".csv")
    process = start_python(*command, "--out", path, "-w", workers)
    soon(lambda: growing.exists() and growing.read_bytes().count(b"\n") > rows)
    process.kill()
    process.wait()


def test_a_killed_collection_keeps_every_finished_shot_and_gets_none_twice(
    collected: Path, tmp_path: Path, start_python: StartPython
):
    path = tmp_path / "shots.parquet"
    kill_after(start_python, path, 10, workers=1)
    kept = path.with_name("shots.parquet.csv").read_bytes().count(b"\n") - 1
    done = collect_shots(SETTINGS, path, 80)
    assert kept >= 10
    assert done.new <= 80 - kept + 1
    assert rows_of(path) == rows_of(collected)


@pytest.mark.slow
def test_killed_with_workers_and_taken_up_with_others_it_is_the_same_collection(
    collected: Path, tmp_path: Path, start_python: StartPython
):
    path = tmp_path / "shots.csv"
    kill_after(start_python, path, 30, workers=2)
    collect_shots(SETTINGS, path, 80, workers=3)
    assert rows_of(path) == rows_of(collected)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")
def test_two_runs_do_not_collect_in_one_file_at_once(tmp_path: Path):
    path = tmp_path / "shots.parquet"
    with (
        CollectionFile(path, SETTINGS),
        pytest.raises(ShotDataError, match="is being written by another run"),
    ):
        collect_shots(SETTINGS, path, 20)
