import base64
import json
import re
from dataclasses import asdict, replace
from html.parser import HTMLParser
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robobt import testing
from robobt.live import replay_html as module
from robobt.live.replay_html import page_data, replay_html, write_html
from robobt.match import MatchLoop
from robobt.match.recording import RecordedRobot, Recorder, Recording, RecordingError, load_recording
from robobt.match.recording.statistics import recorded_statistics
from robobt.match.scenario.scenario import load_scenario
from robobt.skills import SelectShot, Store
from robobt.tree import Selector, TreeRunner
from robobt.world import DIVISION_A, RobotId, Team
from robobt.world.game import OPEN_PLAY
from robobt.worlds import sim_world
from tests.match.recording.made_recording import BLUE_1, YELLOW_0, Wait, frame, header, record

EVIL = "</script><script>alert(1)</script><img src=x onerror='alert(2)'>&lt;{{data}}{{title}}<!--"


@pytest.fixture
def recording(tmp_path: Path) -> Recording:
    record(tmp_path / "match.robobt.arrows")
    return load_recording(tmp_path / "match.robobt.arrows")


class Tags(HTMLParser):
    """The elements of a page and the text of its data script."""

    def __init__(self) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.data = self.title = ""
        self._inside = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        self._inside = dict(attrs).get("id") or tag

    def handle_endtag(self, tag: str) -> None:
        self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside == "recording":
            self.data += data
        elif self._inside == "title":
            self.title += data


def parse(page: str) -> Tags:
    tags = Tags()
    tags.feed(page)
    tags.close()
    return tags


def numbers(text: str, kind: str, width: int) -> Any:
    return np.frombuffer(base64.b64decode(text), dtype=kind).reshape(-1, width).astype(float)


def unroll(flat: list[Any], frames: int, start: Any) -> list[Any]:
    """The value at every frame of a list of (frames since the last change, value)."""
    values, frame = [start] * frames, 0
    for step, value in zip(flat[::2], flat[1::2], strict=True):
        frame += step
        values[frame:] = [value] * (frames - frame)
    return values


def test_the_page_holds_the_positions_to_the_millimetre(recording: Recording) -> None:
    data = json.loads(parse(replay_html(recording)).data)
    assert data["frames"] == 120
    np.testing.assert_allclose(numbers(data["times"], "<f4", 1)[:, 0], recording.times, atol=1e-6)
    ball = numbers(data["ball"], "<i2", 4) / 1000
    np.testing.assert_allclose(ball[:, :2], recording.truth.ball[:, :2], atol=5.1e-4)
    np.testing.assert_allclose(ball[:, 2], np.hypot(0.74, 0.012), atol=1e-3)
    np.testing.assert_allclose(ball[:, 3], recording.truth.ball[:, 4], atol=5.1e-4)
    for slot, robot in enumerate(data["robots"]):
        rows = numbers(robot["rows"], "<i2", 4) / 1000
        np.testing.assert_allclose(rows[:, :3], recording.truth.robots[:, slot, :3], atol=5.1e-4)
        assert unroll(robot["flags"], 120, 0) == (recording.flags[:, slot] & 7).tolist()


def test_a_robot_is_shown_in_the_view_of_its_own_team_as_its_outputs_are(recording: Recording) -> None:
    """Times its view, a robot's place is where its own team sees it: the frame its skills write in."""
    robots = page_data(recording)["robots"]
    assert {(robot["team"], robot["view"]) for robot in robots} == {("blue", 1), ("yellow", -1)}
    assert "x grows towards the goal that it attacks" in replay_html(recording)


def test_the_page_holds_every_status_and_every_word(recording: Recording) -> None:
    data = page_data(recording)
    for slot, robot in ((0, BLUE_1), (2, YELLOW_0)):
        entry = data["robots"][slot]
        letters = [data["letters"][place] for place in unroll(entry["statuses"], 120, 0)]
        assert letters == [recording.statuses_at(robot, tick) for tick in range(120)]
        said: dict[int, str] = {}
        words, when = {}, 0
        for step, node, text in zip(*(iter(entry["feedback"]),) * 3, strict=True):
            when += step
            said[node] = data["texts"][text]
            words[when] = dict(said)
        for tick, expected in words.items():
            told = recording.feedback_at(robot, tick)
            assert told == {node: text for node, text in expected.items() if text}


def test_the_page_holds_the_header_events_and_the_referees_word(recording: Recording) -> None:
    data = page_data(recording)
    assert (data["scenario"], data["trial"], data["seed"]) == ("made", 2, "5")
    assert data["robots"][2]["mouth"] == 0.07
    assert data["robots"][0]["tree"][2] == ["Every", "Every", "leaf", 2, "", "count=7", 0]
    assert [event[1:] for event in data["events"]] == [
        ["kick", "yellow", 0, ""],
        ["goal", "blue", None, "1 : 0"],
        ["kick", "yellow", 0, ""],
        ["kick", "yellow", 0, ""],
    ]
    games = unroll(data["games"], 120, None)
    assert (games[49]["blue"], games[50]["blue"], games[50]["command"]) == (0, 1, "STOP")


def test_the_page_needs_nothing_but_itself(recording: Recording) -> None:
    page = replay_html(recording)
    assert not re.search(r"https?:|//[a-z]+\.|@import|url\(|\bimport\(|fetch\(|XMLHttpRequest", page)
    for tag, attributes in parse(page).elements:
        assert not {"src", "href", "srcset", "action"} & set(attributes), tag
        assert tag not in {"link", "iframe", "object", "embed", "base"}


def test_nothing_in_a_recording_becomes_markup(tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    trees = {BLUE_1: TreeRunner(Selector(EVIL, memory=False, children=[Wait(EVIL)]), None)}
    robots = (RecordedRobot(team=Team.BLUE, number=1, play=EVIL),)
    evil = header(field=DIVISION_A, scenario=EVIL, teams={Team.BLUE: EVIL}, robots=robots)
    with Recorder(path, evil, trees) as recorder:
        trees[BLUE_1].tick()
        recorder.tick(frame(0))
        recorder.event(EVIL, 0.0, text=EVIL)
        recorder.close({EVIL: EVIL})
    tags = parse(replay_html(load_recording(path)))
    plain = parse(replay_html(empty(tmp_path)))
    assert [tag for tag, _ in tags.elements] == [tag for tag, _ in plain.elements]
    assert tags.title == f"{EVIL}, trial 2 · robobt replay"
    data = json.loads(tags.data)
    assert data["scenario"] == data["teams"]["blue"] == data["robots"][0]["play"] == EVIL
    assert data["robots"][0]["tree"][1][0] == data["events"][0][1] == data["outcome"][EVIL] == EVIL
    assert not set("<>&") & set(tags.data)


def empty(tmp_path: Path) -> Recording:
    with Recorder(tmp_path / "empty.robobt.arrows", header()):
        pass
    return load_recording(tmp_path / "empty.robobt.arrows")


def test_a_recording_without_a_tick_has_a_page_too(tmp_path: Path) -> None:
    data = json.loads(parse(replay_html(empty(tmp_path))).data)
    assert (data["frames"], data["outcome"], data["ball"]) == (0, None, "")


def test_numbers_that_json_does_not_have_are_left_out(tmp_path: Path) -> None:
    with Recorder(tmp_path / "m.robobt.arrows", header(seed=2**70)) as recorder:
        recorder.tick(frame(0))
        recorder.close({"mean": float("nan"), "all": [1.5, float("inf")]})
    data = json.loads(
        parse(replay_html(load_recording(tmp_path / "m.robobt.arrows"))).data, parse_constant=pytest.fail
    )
    assert data["outcome"] == {"mean": None, "all": [1.5, None]}
    assert data["seed"] == str(2**70)


def test_a_robot_off_the_field_is_marked_so(tmp_path: Path) -> None:
    with Recorder(tmp_path / "m.robobt.arrows", header()) as recorder:
        for tick in range(3):
            each = frame(tick)
            each.opponents = each.opponents if tick else ()
            recorder.tick(each)
    data = page_data(load_recording(tmp_path / "m.robobt.arrows"))
    rows = numbers(data["robots"][2]["rows"], "<i2", 4)
    assert rows[0].tolist() == [-32768.0] * 4
    assert rows[1, 0] == 4400.0


def test_a_long_recording_is_shown_with_fewer_frames(
    recording: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_FRAMES", 50)
    data = page_data(recording)
    assert data["frames"] == 40
    np.testing.assert_allclose(numbers(data["times"], "<f4", 1)[:, 0], recording.times[::3], atol=1e-6)
    letters = [data["letters"][place] for place in unroll(data["robots"][0]["statuses"], 40, 0)]
    assert letters == [recording.statuses_at(BLUE_1, tick) for tick in range(0, 120, 3)]


def test_talkative_trees_are_cut_to_ten_words_a_second_between_changes(
    recording: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = page_data(recording)["robots"][0]["feedback"]
    monkeypatch.setattr(module, "MOST_FEEDBACK", 10)
    thinned = page_data(recording)["robots"][0]
    assert len(thinned["feedback"]) < len(whole) / 2
    turns, when = set(np.cumsum(thinned["statuses"][::2]).tolist()), 0
    last: dict[int, int] = {}
    for step, node in zip(thinned["feedback"][::3], thinned["feedback"][1::3], strict=True):
        when += step
        assert when in turns or when - last.get(node, -6) >= 6
        last[node] = when


def test_a_frame_of_a_full_match_costs_little(tmp_path: Path) -> None:
    """Five minutes at 60 Hz are 18 000 frames, and the page shall stay under 10 MB."""
    sizes = []
    for ticks in (60, 360):
        robots = tuple(RecordedRobot(team=team, number=number) for team in Team for number in range(6))
        with Recorder(tmp_path / "m.robobt.arrows", header(robots=robots)) as recorder:
            for tick in range(ticks):
                recorder.tick(frame(tick))
        sizes.append(len(replay_html(load_recording(tmp_path / "m.robobt.arrows"))))
    assert (sizes[1] - sizes[0]) / 300 < 200


def test_the_page_is_written_from_a_recording_or_its_file(tmp_path: Path, recording: Recording) -> None:
    one = write_html(recording, tmp_path / "one.html")
    other = write_html(str(recording.path), tmp_path / "other.html")
    assert one.read_bytes() == other.read_bytes()
    (tmp_path / "words").write_text("words")
    with pytest.raises(RecordingError, match="not a robobt recording"):
        write_html(tmp_path / "words", tmp_path / "no.html")
    assert not (tmp_path / "no.html").exists()


def shooting(path: Path, rater: str) -> Recording:
    """A shooter that looks for a shot past a goalkeeper that goes from one side to the other."""
    me, shooter = testing.robot(2.4, 0.0), RobotId(Team.BLUE, 0)
    scenes = [
        testing.frame(me, testing.held(me), opponents=(testing.robot(3.9, y, 3.1),), time=tick / 60)
        for tick, y in enumerate((0.4, 0.4, 0.4, -0.4, -0.4))
    ]
    store = Store(scenes[0], me)
    runner = TreeRunner(SelectShot(rater=rater), store)
    robots = (RecordedRobot(team=Team.BLUE, number=0),)
    with Recorder(path, header(robots=robots), {shooter: runner}, {shooter: store}) as recorder:
        for store.frame in scenes:
            runner.tick()
            recorder.tick(store.frame)
        recorder.close({})
    return load_recording(path)


def test_the_page_holds_the_goal_line_as_a_robot_judges_it_when_that_changes(tmp_path: Path) -> None:
    data = page_data(shooting(tmp_path / "shooting.robobt.arrows", "expected_goal"))
    (shooter,) = data["robots"]
    assert shooter["goal_line"][::2] == [0, 3]
    for (reach, text), best in zip(shooter["goal_line"][1::2], (slice(0, 47), slice(47, 94)), strict=True):
        assert reach == pytest.approx(465.0)
        percent = np.frombuffer(base64.b64decode(data["texts"][text]), dtype=np.uint8)
        assert len(percent) == 94
        assert percent[best].max() == percent.max() > 90
    assert not any("goal_line" in text for text in data["texts"])


@pytest.mark.parametrize("reach", [inf, -inf, nan, 1e308])
def test_a_goal_line_of_no_length_is_not_shown(tmp_path: Path, reach: float) -> None:
    recording = shooting(tmp_path / "shooting.robobt.arrows", "expected_goal")
    for _, values in recording.written["blue 0"]:
        if "goal_line" in values:
            values["goal_line"] = {"reach": reach, "chances": "AAAA"}
    assert page_data(recording)["robots"][0]["goal_line"][1::2] == [None, None]


def test_a_robot_with_a_geometric_rater_has_no_goal_line(tmp_path: Path) -> None:
    recording = shooting(tmp_path / "shooting.robobt.arrows", "segment_clearance")
    assert page_data(recording)["robots"][0]["goal_line"] == []
    assert all("goal_line" not in values for _, values in recording.written["blue 0"])


@pytest.mark.parametrize("other", ["far", {"reach": 0.4}, {"reach": 0.4, "chances": "not base64!"}, [1, 2]])
def test_a_goal_line_of_some_other_kind_is_not_drawn(tmp_path: Path, other: Any) -> None:
    recording = shooting(tmp_path / "shooting.robobt.arrows", "expected_goal")
    for _, values in recording.written["blue 0"][1:]:
        values["goal_line"] = other
    data = page_data(recording)
    assert data["robots"][0]["goal_line"][3] is None


@pytest.fixture(scope="module")
def team_match(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    path = tmp_path_factory.mktemp("team") / "team.robobt.arrows"
    with MatchLoop(load_scenario("team_v_baseline").lasting(12.0), 3, sim_world, path) as match:
        while match.tick():
            pass
    return load_recording(path)


def test_the_page_holds_the_passes_that_a_robot_compares(team_match: Recording) -> None:
    compared = [
        passes
        for robot in page_data(team_match)["robots"]
        if robot["team"] is Team.BLUE
        for passes in robot["candidates"][1::2]
    ]
    assert max(map(len, compared)) > 1
    for passes in compared:
        scores = [score for _, _, score in passes]
        assert scores == sorted(scores, reverse=True)
        assert all(abs(x) <= 4.5 and abs(y) <= 3.0 for x, y, _ in passes)


def test_the_page_holds_what_each_team_did_where_a_referee_watched(team_match: Recording) -> None:
    figures: Any = page_data(team_match)["figures"]
    assert set(figures) == {"blue", "yellow"}
    for name, team in recorded_statistics(team_match).items():
        assert figures[name] == asdict(team)
    assert figures["blue"]["distance"] > 1.0
    free = replace(team_match, games=[(0, OPEN_PLAY)])
    assert page_data(free)["figures"] == {}


def test_the_page_holds_whom_a_team_marks_and_fears(team_match: Recording) -> None:
    plans = [*zip(*[iter(page_data(team_match)["plans"]["blue"])] * 2, strict=True)]
    assert any(marks for _, (marks, _, _) in plans)
    for _, (marks, threats, _) in plans:
        # Markers come off the most dangerous opponents first.
        assert set(marks.values()) <= set(threats) or not threats


def test_the_page_holds_where_the_attacker_meets_a_rolling_ball(team_match: Recording) -> None:
    plans = [*zip(*[iter(page_data(team_match)["plans"]["blue"])] * 2, strict=True)]
    meetings = [meeting for _, (_, _, meeting) in plans if meeting]
    assert meetings
    for number, x, y in meetings:
        assert number in range(1, 6)
        # The field, and the run-up behind its lines.
        assert abs(x) <= 5.0
        assert abs(y) <= 3.5


@pytest.mark.parametrize("other", ["far", [1, 2], {"3": "x"}, [{"receiver": 3}], [{"target": [0, None]}], 7])
def test_plans_of_some_other_kind_are_not_drawn(team_match: Recording, other: Any) -> None:
    written: Any = {"blue": [(0, {"marks": other})], "blue 3": [(5, {"candidates": other})]}
    recording = replace(team_match, written={key: [] for key in team_match.written} | written)
    data = page_data(recording)
    assert data["plans"] == {"blue": [0, [{}, [], []]], "yellow": []}
    assert all(changes in ([], [5, []]) for changes in (robot["candidates"] for robot in data["robots"]))
