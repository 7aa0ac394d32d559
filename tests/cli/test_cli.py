import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from robobt import __version__
from robobt.cli import app
from robobt.config.resources import bundled_scenarios, models_folder
from robobt.config.yaml import write_yaml
from robobt.match.recording import load_recording
from robobt.plays import PLAYS, python_files
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS
from robobt.skills.ball.go_to_ball import GO_TO_BALL_POLICIES
from tests.match.scripted import data
from tests.registries import temporarily

COMMANDS = (
    *("match", "compare", "tournament", "list", "show", "record"),
    *("train", "evaluate", "export", "shots", "serve", "log"),
)
MINE = """
from robobt.plays import PLAYS
from robobt.skills.base import Skill, skill


@skill
class Idle(Skill):
    \"\"\"Does nothing.\"\"\"

    def on_running(self):
        return self.run()


@PLAYS.register("idle")
def idle():
    \"\"\"Nothing at all.\"\"\"
    return Idle()
"""


def robobt(*arguments: str | Path, code: int = 0) -> Result:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == code, result.output
    return result


def told(*arguments: str | Path) -> dict[str, Any]:
    """What a command prints with --json: exactly one object."""
    printed = json.loads(robobt(*arguments, "--json").stdout)
    assert isinstance(printed, dict)
    return printed


def complaint(*arguments: str | Path, code: int = 1) -> str:
    """The one line on stderr of a command that fails."""
    result = robobt(*arguments, code=code)
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    if code == 1:
        assert len(result.stderr.splitlines()) == 1
    return result.stderr


def help_of(command: str = "") -> str:
    return " ".join(robobt(*command.split(), "--help").stdout.replace("│", " ").split())


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A Python file with a skill and a play, which are forgotten after the test."""
    monkeypatch.setattr(python_files, "_imported", {})
    monkeypatch.setattr(sys, "path", list(sys.path))
    path = tmp_path / "mine.py"
    path.write_text(MINE)
    with temporarily(PLAYS), temporarily(SKILLS):
        yield path


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    path = tmp_path / "mine.yaml"
    path.write_text(write_yaml(data(ball={"position": {"center": [0, 0], "radius": 0.5}})))
    return path


class TestHelp:
    def test_without_a_command_the_commands_are_listed(self):
        listed = CliRunner().invoke(app, []).output
        assert all(command.split()[0] in listed for command in COMMANDS)

    @pytest.mark.integration
    @pytest.mark.parametrize("command", COMMANDS)
    def test_every_command_has_help(self, command: str):
        assert command.rpartition(" ")[2] in help_of(command)

    def test_the_version(self):
        assert robobt("--version").stdout == f"robobt {__version__}\n"

    def test_nothing_heavy_is_loaded_for_help(self):
        code = (
            "import sys, robobt.cli; "
            "print({'numpy', 'numba', 'torch', 'scipy', 'pymunk', 'pydantic'} & set(sys.modules))"
        )
        loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert loaded.stdout == "set()\n"


@pytest.mark.integration
class TestMatch:
    def test_it_prints_outcomes_times_and_goals(self, scenario: Path):
        printed = robobt("match", scenario, "--trials", "3").stdout
        assert "3 trials, seed 0" in printed
        assert "95 % interval" in printed
        assert "blue 0" in printed
        assert "Goals: blue" in printed

    def test_json_is_one_object_with_the_keys_of_the_help(self, scenario: Path):
        printed = told("match", scenario, "--trials", "3", "--seed", "4")
        assert (printed["trials"], printed["requested"], printed["seed"]) == (3, 3, 4)
        assert printed["interrupted"] is False
        assert printed["recording"] is None
        explained = help_of("match")
        for key in (*printed, *printed["robots"]["blue 0"], *next(iter(printed["outcomes"].values()))):
            assert key in explained

    def test_the_same_seed_is_the_same_run(self, scenario: Path):
        traces = [told("match", scenario, "-n", "3", "-s", seed)["trace"] for seed in ("1", "1", "2")]
        assert traces[0] == traces[1] != traces[2]

    def test_a_recording_can_be_a_page_at_once(self, scenario: Path, tmp_path: Path):
        page = tmp_path / "replay.html"
        assert told("match", scenario, "--record", page)["recording"] == str(page)
        assert page.read_text().startswith("<!doctype html>")

    def test_a_trial_can_be_chosen_for_recording(self, scenario: Path, tmp_path: Path):
        recording = tmp_path / "second.robobt.arrows"
        printed = robobt("match", scenario, "-n", "3", "--record-trial", "1", "--record", recording).stdout
        assert f"Recording of trial 1: {recording}" in printed
        assert load_recording(recording).header.trial == 1

    def test_a_recording_has_a_name_of_its_own(
        self, scenario: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ):
        monkeypatch.chdir(tmp_path)
        robobt("match", scenario, "--record-trial", "0")
        assert (tmp_path / "test-0.robobt.arrows").exists()

    def test_a_name_with_a_path_in_it_leads_nowhere_else(
        self, scenario: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ):
        scenario.write_text(write_yaml({**data(), "name": "../elsewhere/mine"}))
        inside = tmp_path / "inside"
        inside.mkdir()
        monkeypatch.chdir(inside)
        robobt("match", scenario, "--record-trial", "0")
        assert [path.name for path in inside.iterdir()] == [".._elsewhere_mine-0.robobt.arrows"]

    @pytest.mark.parametrize("name", ["mine.yaml", "results.jsonl", "replay.mp4", "replay"])
    def test_a_recording_does_not_replace_a_file_of_another_kind(
        self, scenario: Path, tmp_path: Path, name: str
    ):
        before = scenario.read_text()
        complained = complaint("match", scenario, "--record", tmp_path / name, code=2)
        assert "takes a name that ends in" in complained
        assert [path.name for path in tmp_path.iterdir()] == [scenario.name]
        assert scenario.read_text() == before

    def test_recording_and_results_are_two_files(self, scenario: Path, tmp_path: Path):
        both = tmp_path / "both.robobt.arrows"
        assert "a file each" in complaint("match", scenario, "--record", both, "--out", both, code=2)

    def test_results_are_kept_and_a_run_goes_on_from_there(self, scenario: Path, tmp_path: Path):
        out = tmp_path / "results.jsonl"
        robobt("match", scenario, "-n", "2", "--out", out)
        assert told("match", scenario, "-n", "4", "--out", out)["trials"] == 4
        assert len(out.read_text().splitlines()) == 5

    def test_a_tree_that_fails_is_told(self, scenario: Path):
        broken = data()
        broken["robots"]["blue"][0]["params"] = {"breaks": "raise"}
        scenario.write_text(write_yaml({**broken, "ends": {"time_limit": 0.1}}))
        result = robobt("match", scenario, code=3)
        assert (
            "blue 0: its tree failed in 5 ticks; the first: Scripted: RuntimeError: broken" in result.stderr
        )
        *_, last = result.stderr.splitlines()
        assert last.startswith("robobt: trees failed, so the exit status is 3; --on-error raise ends the run")
        figures = json.loads(robobt("match", scenario, "--json", code=3).stdout)
        assert figures["robots"]["blue 0"]["errors"] == 5

    def test_a_robot_that_fails_all_the_time_for_one_reason_is_told(self):
        given = (
            "match",
            "striker_vs_goalkeeper",
            "-n",
            "2",
            "--set",
            "ends.time_limit=0.1",
            "--workers",
            "1",
        )
        said = robobt(*given, "--blue", "attack_learned").stderr
        assert "blue 0 did nothing: its tree failed in every tick; Score: it has no model" in said
        assert "did nothing" not in robobt(*given).stderr

    @pytest.mark.parametrize(
        ("trials", "said"),
        [("1", "One trial says little"), ("9", "9 trials say little"), ("10", None)],
    )
    def test_few_trials_are_told_to_say_little(self, scenario: Path, trials: str, said: str | None):
        shown = robobt("match", scenario, "-n", trials, "-w", "1", "--set", "ends.time_limit=0.1").stdout
        assert said in shown if said else "little" not in shown

    def test_a_page_may_end_in_htm(self, scenario: Path, tmp_path: Path):
        robobt("match", scenario, "--record", tmp_path / "x.HTM")
        assert (tmp_path / "x.HTM").read_text().startswith("<!")

    def test_a_tree_that_fails_can_end_the_run(self, scenario: Path):
        broken = data()
        broken["robots"]["blue"][0]["params"] = {"breaks": "raise"}
        scenario.write_text(write_yaml(broken))
        said = complaint("match", scenario, "--on-error", "raise")
        assert said.startswith(f"robobt: {scenario}: trial 0: blue 0: Scripted: RuntimeError: broken")

    def test_nodes_can_follow_a_script(self, scenario: Path):
        substitute = ["--substitute", "blue 0:Scripted=RUNNING"]
        assert told("match", scenario, *substitute)["robots"]["blue 0"]["kicks"]["mean"] == 0
        assert told("match", scenario)["robots"]["blue 0"]["kicks"]["mean"] == 1

    @pytest.mark.parametrize(
        ("rule", "said"),
        [
            ("Scripted=RUNNING", "takes ROBOT:PATH=STATUS"),
            ("blue 0:Scripted=[", "Scripted: expected the node content"),
        ],
    )
    def test_a_rule_that_is_none_is_a_usage_error(self, scenario: Path, rule: str, said: str):
        assert said in " ".join(
            complaint("match", scenario, "--substitute", rule, code=2).replace("│", " ").split()
        )

    def test_a_play_of_the_users_own_file_is_played(self, mine: Path, scenario: Path):
        own = data()
        own["robots"]["blue"][0].update(play="idle", params={})
        scenario.write_text(write_yaml({**own, "ends": {"time_limit": 0.1}}))
        assert told("match", scenario, "--import", mine)["robots"]["blue 0"]["errors"] == 0


@pytest.mark.integration
class TestReplay:
    def test_a_recording_becomes_a_page_beside_it_or_where_it_is_wanted(self, scenario: Path, tmp_path: Path):
        recording = tmp_path / "a.robobt.arrows"
        robobt("match", scenario, "--record", recording)
        assert robobt("show", recording).stdout == f"Page: {tmp_path / 'a.html'}\n"
        robobt("show", recording, "--out", tmp_path / "b.html")
        assert (tmp_path / "a.html").read_text() == (tmp_path / "b.html").read_text()

    def test_a_page_replaces_no_page_but_a_replay(self, scenario: Path, tmp_path: Path):
        recording, page = tmp_path / "a.robobt.arrows", tmp_path / "a.html"
        robobt("match", scenario, "--record", recording)
        page.write_text("<title>my notes</title>")
        assert "is there already and no replay" in complaint("show", recording, code=2)
        assert page.read_text() == "<title>my notes</title>"
        robobt("show", recording, "--out", page)
        robobt("show", recording)

    def test_a_page_does_not_replace_its_recording(self, scenario: Path, tmp_path: Path):
        recording = tmp_path / "a.robobt.arrows"
        robobt("match", scenario, "--record", recording)
        page = tmp_path / "a.html"
        page.hardlink_to(recording)
        assert "is the recording itself" in complaint("show", recording, code=2)
        assert "takes a name that ends in .html" in complaint("show", recording, "--out", recording, code=2)
        assert page.read_bytes() == recording.read_bytes()

    def test_a_folder_is_no_recording(self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
        monkeypatch.chdir(tmp_path)
        Path("a.robobt.arrows").mkdir()
        assert "Is a directory" in complaint("show", "a.robobt.arrows")


@pytest.mark.integration
class TestLists:
    def test_every_bundled_scenario_is_listed(self):
        printed = robobt("list", "scenarios").stdout
        assert all(name in printed for name in bundled_scenarios())
        listed = told("list", "scenarios")["scenarios"]
        assert [entry["name"] for entry in listed] == list(bundled_scenarios())
        explained = help_of("list")
        assert all(key in explained for entry in listed for key in (*entry, *entry["robots"][0]))

    def test_one_scenario_is_shown_with_its_robots(self, scenario: Path):
        printed = " ".join(robobt("show", scenario).stdout.split())
        assert "blue 0 scripted(kick=4.0) at (-2, 0) m, heading 0 rad" in printed
        assert "ball within 0.5 m of (0, 0) m" in printed
        assert "Ends: time_limit 10.0" in printed

    def test_a_scenario_is_copied_whole_to_be_changed(self, tmp_path: Path):
        copy = tmp_path / "mine.yaml"
        assert "--out mine.yaml" in robobt("show", "six_v_six").stdout
        robobt("show", "six_v_six", "--out", copy)
        assert copy.read_text() == bundled_scenarios()["six_v_six"].read_text()
        assert (
            told("show", copy)["scenarios"][0]["robots"]
            == told("show", "six_v_six")["scenarios"][0]["robots"]
        )

    def test_every_play_is_listed_with_its_parameters(self):
        printed = robobt("list", "plays").stdout
        assert "speed: float = 1.0" in printed
        listed = {entry["name"]: entry for entry in told("list", "plays")["plays"]}
        assert list(listed) == list(PLAYS)
        speed = listed["scripted"]["parameters"][0]
        assert speed == {"name": "speed", "type": "float", "required": False, "default": 1.0}

    def test_every_skill_is_listed_with_what_it_reads_and_writes(self):
        robobt("list", "skills")
        listed = {entry["name"]: entry for entry in told("list", "skills")["skills"]}
        assert list(listed) == list(SKILLS)
        assert listed["KickToTarget"]["reads"] == list(SKILLS["KickToTarget"].reads)
        assert all(entry["description"] for entry in listed.values())

    def test_every_rater_is_listed_with_its_settings_and_what_they_mean(self):
        assert "full_angle: float = 0.3  free angle that scores 1 [rad]" in robobt("list", "raters").stdout
        listed = {entry["name"]: entry for entry in told("list", "raters")["raters"]}
        assert list(listed) == list(RATERS)
        assert {"name": "spacing", "type": "float", "required": False, "default": 0.02} in listed["gaussian"][
            "parameters"
        ]

    def test_every_policy_is_listed(self):
        assert "Drive to the place beside the ball" in robobt("list", "policies").stdout
        assert [entry["name"] for entry in told("list", "policies")["policies"]] == list(GO_TO_BALL_POLICIES)

    @pytest.mark.parametrize("kind", ["plays", "skills", "raters", "policies", "tasks", "models"])
    def test_every_key_is_in_the_help(self, kind: str):
        printed = told("list", kind)
        explained = help_of("list")
        assert all(key in explained for key in (*printed, *printed[kind][0]))
        assert printed["problems"] == []

    @pytest.mark.parametrize("kind", ["skill", "rater", "policy", "play", "task"])
    def test_a_name_that_is_none_is_told_with_those_there_are(self, kind: str):
        said = " ".join(complaint("show", "nothing", "--kind", kind, code=2).split())
        assert re.search(r"is called 'nothing'; (there are \w+|'robobt list \w+' lists all \d+)", said)

    def test_a_name_of_several_things_asks_which(self):
        said = complaint("show", "attack_main", code=2) if "attack_main" in bundled_scenarios() else ""
        with temporarily(PLAYS):
            PLAYS.register("six_v_six")(PLAYS["stand_still"])
            said = complaint("show", "six_v_six", code=2)
            assert "is a play and a scenario; choose with --kind" in " ".join(said.split())
            assert "blue 0" in robobt("show", "six_v_six", "--kind", "scenario").stdout

    def test_what_is_wrong_with_another_package_is_a_warning(self, monkeypatch: pytest.MonkeyPatch):
        problem = "skill 'Bad' (bad:Bad) of the distribution bad cannot be used: RuntimeError: no"
        monkeypatch.setitem(SKILLS._problems, "Bad", problem)
        result = robobt("show", "Stop")
        assert result.stderr == f"robobt: {problem}\n"
        assert "Stop" in result.stdout
        assert told("list", "skills")["problems"] == [problem]

    def test_a_name_that_another_package_failed_to_bring_is_told_with_the_reason(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scenario: Path
    ):
        problem = "thing 'Bad' (bad:Bad) of the distribution bad cannot be used: RuntimeError: no"
        for registry in (SKILLS, PLAYS):
            monkeypatch.setitem(registry._problems, "Bad", problem)
        tree = tmp_path / "tree.yaml"
        tree.write_text("play: mine\ntree: Bad\n")
        played = data()
        played["robots"]["blue"][0].update(play="Bad", params={})
        scenario.write_text(write_yaml(played))
        for arguments, code in (
            (("show", "Bad"), 2),
            (("show", "Bad", "--kind", "play"), 2),
            (("show", tree), 1),
            (("match", scenario), 1),
        ):
            said = " ".join(complaint(*arguments, code=code).replace("│", " ").split())
            assert "of the distribution bad cannot be used: RuntimeError: no" in said, arguments

    def test_what_a_file_of_the_users_registers_is_listed(self, mine: Path):
        assert "Nothing at all." in robobt("list", "plays", "--import", mine).stdout
        (listed,) = told("show", "Idle", "--import", mine)["skills"]
        assert listed["description"] == "Does nothing."
        for kind in ((), ("--kind", "skill")):
            assert told("show", f"{mine}:Idle", *kind)["skills"] == [listed]
        assert "no play is called 'Nothing' in" in complaint("show", f"{mine}:Nothing", code=2)

    def test_one_can_be_looked_at_alone(self):
        assert len(told("show", "KickToTarget")["skills"]) == 1
        printed = robobt("show", "KickToTarget").stdout
        assert "KickToTarget" in printed
        assert "DribbleTo" not in printed


@pytest.mark.integration
class TestTree:
    def test_it_is_shown_as_text(self):
        printed = robobt("show", "goalkeeper").stdout
        assert "ShotComing" in printed

    def test_a_terminal_that_lacks_a_sign_is_shown_another(self):
        result = CliRunner(charset="ascii").invoke(app, ["show", "goalkeeper"])
        assert result.exit_code == 0, result.output
        assert "?" in result.stdout

    def test_it_is_drawn(self, tmp_path: Path):
        svg, dot = tmp_path / "tree.svg", tmp_path / "tree.dot"
        robobt("show", "goalkeeper:speed_factor=0.5", "--out", svg)
        robobt("show", "goalkeeper", "--out", dot)
        assert svg.read_text().startswith("<svg")
        assert dot.read_text().startswith("digraph")

    def test_a_copy_of_a_play_keeps_its_name(self, tmp_path: Path):
        mine, tree, copy = tmp_path / "mine.py", tmp_path / "tree.yaml", tmp_path / "copy.yaml"
        mine.write_text(
            "from robobt import play\nfrom robobt.skills import Stop\nidle = play('idle')(lambda: Stop())\n"
        )
        tree.write_text("play: my_play\ntree: Stop\n")
        for play, name in ((tree, "my_play"), (f"{mine}:idle", "idle"), ("goalkeeper", "goalkeeper")):
            robobt("show", play, "--out", copy)
            assert copy.read_text().startswith((f"play: {name}\n", f"{{play: {name},"))

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (["nothing"], "nothing is called 'nothing'"),
            (["scripted:speed"], "takes name=value"),
            (["scripted:sped=1"], "scripted has no such parameter"),
            (["scripted:speed=["], "speed: expected the node content"),
            (["scripted", "--out", "tree.gif"], "takes a name that ends in .svg, .dot, .yaml, .xml"),
            (["scripted", "--robot", "blue 0"], "is for a recording, and this is a play"),
            (["KickToTarget", "--lint"], "is for a play, and this is a skill"),
            (["KickToTarget", "--out", "x.svg"], "does nothing here: a skill is only printed"),
        ],
    )
    def test_usage_errors_say_what_there_is(self, arguments: list[str], said: str):
        assert said in " ".join(complaint("show", *arguments, code=2).replace("│", " ").split())

    def test_it_is_one_object_in_json(self):
        printed = told("show", "goalkeeper")
        assert printed["nodes"][0] == {"path": "goalkeeper", "type": "Selector", "depth": 0}
        assert printed["nodes"][2]["path"] == "goalkeeper/aim/BallAimedAtGoal"
        assert printed["nodes"][2]["depth"] == 2

    def test_mistakes_are_looked_for(self, tmp_path: Path):
        path = tmp_path / "mine.yaml"
        tree = {"Repeat": {"name": "again", "num_success": -1, "child": "KickToTarget"}}
        path.write_text(write_yaml({"play": "mine", "tree": tree}))
        printed = robobt("show", path, "--lint", code=1).stdout
        assert "again: repeats its child for ever [unbounded]" in printed
        assert (
            "again/KickToTarget: reads 'shot' or 'pass_', but no other node of the tree writes it" in printed
        )
        found = json.loads(robobt("show", path, "--lint", "--json", code=1).stdout)
        assert "reads 'shot' or 'pass_', but no other node" in robobt("show", path).stderr
        assert found["findings"][0]["rule"] == "unbounded"
        assert len(found["wiring"]) == 1
        explained = help_of("show")
        assert all(key in explained for key in (*found, *found["findings"][0], *found["nodes"][0]))

    def test_a_tree_without_mistakes_is_told_too(self):
        assert robobt("show", "goalkeeper", "--lint").stdout == "Nothing found.\n"

    def test_what_its_nodes_do_in_a_match_is_counted(self, scenario: Path):
        printed = robobt("show", "scripted", "--statistics", scenario).stdout
        assert printed.startswith("blue 0\nnode ")
        counted = told("show", "scripted", "--statistics", scenario, "--seed", "3")
        assert (counted["scenario"], counted["seed"]) == ("test", 3)
        (node,) = counted["robots"]["blue 0"]
        assert node["runs"] == node["ticks"] > 0
        explained = help_of("show")
        assert all(key in explained for key in (*counted, *node))

    def test_a_play_that_no_robot_has_is_counted_in_place_of_the_first_robots(self, scenario: Path):
        done = robobt("show", "goalkeeper:speed_factor=0.5", "--statistics", scenario)
        assert done.stdout.startswith("blue 0\nnode ")
        assert "'test' has no robot with this play; blue 0 plays it in place of scripted" in done.stderr
        counted = told("show", "goalkeeper", "--statistics", scenario)
        assert len(counted["robots"]["blue 0"]) == len(counted["nodes"]) > 1

    def test_what_a_docstring_refers_to_is_shown_by_its_name(self):
        assert "Tick it after SelectPass in every" in robobt("show", "PassIsSteady").stdout
        assert "the defaults of GoToBallSettings" in robobt("show", "go_to_ball").stdout

    def test_a_skill_is_told_to_be_one_where_parameters_are_given(self):
        said = " ".join(complaint("show", "KickToTarget:speed_factor=2", code=2).split())
        assert "'KickToTarget' is a skill, which takes no parameters here" in said

    def test_a_page_is_opened_in_a_browser(self):
        assert "open it in a browser" in complaint("show", "match.html", code=2)

    def test_a_seed_is_for_counting(self):
        assert "is for --statistics" in complaint("show", "goalkeeper", "--seed", "1", code=2)

    def test_a_play_of_the_users_own_file(self, mine: Path):
        assert "Idle" in robobt("show", "idle", "--import", mine).stdout

    def test_what_is_wrong_with_that_file_is_told_with_its_line(self, mine: Path):
        mine.write_text("x = 1\nx.y\n")
        said = complaint("show", "idle", "--import", mine)
        assert said == f"robobt: {mine}:2: AttributeError: 'int' object has no attribute 'y'\n"


class TestErrors:
    def test_a_missing_scenario_is_named_and_those_there_are(self):
        assert complaint("match", "nowhere").startswith("robobt: nowhere: no such file or bundled scenario; ")

    def test_a_wrong_field_is_named_with_its_file(self, scenario: Path):
        scenario.write_text(write_yaml(data(period=5)))
        assert complaint("match", scenario).startswith(f"robobt: {scenario}: period: input should be less")

    @pytest.mark.parametrize(
        ("simulator", "said"),
        [
            ({"ball": {"mass": -1}}, "simulator.ball.mass: input should be greater"),
            ({"realism": "much"}, "simulator: no realism level is called 'much'; there are"),
        ],
    )
    def test_wrong_settings_of_the_simulator_are_named(self, scenario: Path, simulator: Any, said: str):
        scenario.write_text(write_yaml(data(simulator=simulator)))
        assert complaint("match", scenario).startswith(f"robobt: {scenario}: {said}")

    def test_square_brackets_survive(self, scenario: Path):
        scenario.write_text("name: [red]\n")
        assert "name" in complaint("match", scenario)

    def test_a_file_that_is_no_recording(self, scenario: Path):
        recording = scenario.with_name("mine.robobt.arrows")
        scenario.rename(recording)
        assert complaint("show", recording).startswith(f"robobt: {recording}")

    def test_a_file_that_is_not_there(self):
        assert "nowhere.log" in complaint("show", "nowhere.log")
        assert "nothing is called 'nowhere.jsonl'" in complaint("show", "nowhere.jsonl", code=2)

    def test_a_place_that_cannot_be_written(self, scenario: Path, tmp_path: Path):
        (tmp_path / "file").write_text("")
        assert str(tmp_path / "file") in complaint("match", scenario, "--out", tmp_path / "file" / "x.jsonl")

    def test_a_trial_that_is_not_played_cannot_be_recorded(self, scenario: Path):
        said = complaint("match", scenario, "-n", "2", "--record-trial", "7", code=2)
        assert "there is no trial 7; they are 0 to 1" in said

    @pytest.mark.parametrize("option", [["--port", "8765"], ["--no-open"], ["--paused"]])
    def test_options_of_the_live_page_need_it(self, scenario: Path, option: list[str]):
        assert "is for --live" in complaint("match", scenario, *option, code=2)

    def test_debug_shows_where(self):
        result = CliRunner().invoke(app, ["--debug", "match", "nowhere"])
        assert type(result.exception).__name__ == "ScenarioError"
        assert "--debug" in help_of()

    def test_debug_stands_behind_the_command_too(self):
        command = [sys.executable, "-m", "robobt", "match", "nowhere", "--debug"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        assert "Traceback" in run.stderr


def test_a_match_tells_the_delays_that_it_has_measured():
    usual = "match", "striker_vs_goalkeeper", "--trials", "1", "--set", "ends.time_limit=4"
    assert told(*usual)["delays"] == {}
    arguments = *usual, "--set", "predict=measured"
    delay = told(*arguments)["delays"]["blue 0"]
    assert delay["low"] < delay["seconds"] < delay["high"]
    assert delay["seconds"] < 0.01
    assert "blue 0" in robobt(*arguments).stdout
    two = *arguments, "--trials", "2"
    assert told(*two, "--workers", "2")["delays"] == told(*two, "--workers", "1")["delays"] != {}


def test_the_package_runs_as_the_command_does():
    run = subprocess.run([sys.executable, "-m", "robobt", "--version"], capture_output=True, text=True)
    assert run.stdout == f"robobt {__version__}\n"
    assert run.returncode == 0


def test_models_are_listed_where_there_is_no_folder_of_ones_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    listed = told("list", "models")
    assert listed["problems"] == []
    assert len(listed["models"]) == len([*models_folder().glob("*.pt")])
    monkeypatch.setenv("ROBOBT_MODELS", "nowhere")
    assert "nowhere: there is no such file" in robobt("list", "models", code=1).output
