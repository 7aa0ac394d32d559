"""Recordings and logs become observations; what is identified from them becomes a preset file."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

from robobt.cli import app
from robobt.identify import Identification, Observations, identify, report, write_preset
from robobt.identify.estimate import Estimate, unseen
from robobt.identify.noise import identify_noise
from robobt.identify.observations import without_repeats
from robobt.identify.preset_file import preset_of
from robobt.identify.report import parts_of
from robobt.identify.sources import NothingToIdentifyError, load_observations, observations_of
from robobt.league.log.files import LogKind, LogWriter
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, write_vision
from robobt.match import MatchLoop, load_scenario
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import Scenario
from robobt.sim import SimSettings, preset, settings_from
from robobt.sim.realism import RealismSettings
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId
from robobt.worlds import sim_world
from tests.identify.made import chipped, driven

pytestmark = pytest.mark.integration

NOISY = {"realism": {"robot_noise": 0.001, "ball_noise": 0.001, "heading_noise": 0.004, "vision_delay": 0.03}}


def played(scenario: Scenario, path: Path) -> Path:
    with MatchLoop(scenario, 0, sim_world, record=path) as match:
        while match.tick():
            pass
    return path


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    scenario = load_scenario("three_v_three").lasting(12.0)
    changed = scenario.model_copy(update={"simulator": NOISY})
    return played(changed, tmp_path_factory.mktemp("identify") / "match.robobt.arrows")


@pytest.fixture(scope="module")
def seen(recording: Path) -> Observations:
    return load_observations(recording)


@dataclass
class Found:
    """What the command identifies, how many parts of the work it counts, what it prints and writes."""

    identified: Identification
    parts: int
    result: Result
    file: Path


@pytest.fixture(scope="module")
def found(recording: Path) -> Found:
    made: list[Identification] = []
    parts: list[int] = []

    def watched(seen: Observations, on_part: Callable[[], None]) -> Identification:
        def counted() -> None:
            parts.append(1)
            on_part()

        made.append(identify(seen, counted))
        return made[-1]

    file = recording.with_name("field.yaml")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(report, "identify", watched)
        arguments = ["record", "identify", str(recording), "--out", str(file), "--json"]
        result = CliRunner().invoke(app, arguments)
    assert made, result.output
    return Found(made[0], len(parts), result, file)


def test_a_recording_holds_what_was_seen_and_sent(seen: Observations, found: Found) -> None:
    assert len(seen) > 400
    assert all(seen.commanded(robot) for robot in range(len(seen.robots)))
    assert found.identified.delay.value == pytest.approx(0.03, abs=0.003)


def test_a_recording_without_detections_is_refused(recording: Path) -> None:
    old = load_recording(recording)
    old.pictures = None
    with pytest.raises(NothingToIdentifyError, match="does not say what cameras saw"):
        observations_of(old)


def test_a_recording_with_few_pictures_is_refused_by_its_name(tmp_path: Path) -> None:
    file = played(load_scenario("three_v_three").lasting(0.5), tmp_path / "short.robobt.arrows")
    result = CliRunner().invoke(app, ["record", "identify", str(file)])
    assert result.exit_code == 1
    told = " ".join(result.stderr.split())
    assert re.search(rf"{file.name}: holds \d+ pictures, too few to identify anything$", told), told


def test_a_log_shows_robots_and_ball_but_no_commands(tmp_path: Path) -> None:
    robot = RobotId(Team.YELLOW, 3)
    with LogWriter(tmp_path / "field.log") as log:
        for i in range(200):
            at = i / 60
            frame = CameraFrame(0, i, at, at + 0.02)
            if i != 50:
                frame.robots.append(RobotDetection(robot, 0.5 * at, 0.0, 0.0))
            frame.balls.append(BallDetection(1.0, 2.0))
            log.write(round((at + 0.02) * 1e9), LogKind.VISION, write_vision(frame))
    seen = load_observations(tmp_path / "field.log")
    assert seen.robots == (robot,)
    assert not seen.commanded(0)
    assert np.isnan(seen.poses[50, 0]).all()
    assert seen.ball[7] == pytest.approx([1.0, 2.0])
    assert seen.age == pytest.approx(0.02)


def test_a_log_without_robots_is_refused(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "empty.log"):
        pass
    with pytest.raises(NothingToIdentifyError, match="shows no robots"):
        load_observations(tmp_path / "empty.log")


def test_lost_detections_are_gaps_and_things_at_rest_are_not() -> None:
    noisy = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.0], [0.2, 0.0]])
    assert np.isnan(without_repeats(noisy)[:, 0]).tolist() == [False, False, True, False]
    still = np.zeros((50, 2))
    assert np.isfinite(without_repeats(still)).all()


def test_a_preset_file_is_played_in(tmp_path: Path) -> None:
    limits = RobotLimits(max_speed=2.0, acceleration=2.5, braking=4.0)
    realism = RealismSettings(robot_noise=0.001, heading_noise=0.004, vision_delay=0.05)
    found = identify(driven(limits, SimSettings(realism=realism), seconds=20.0))
    path = tmp_path / "field.yaml"
    write_preset(found, path)
    text = path.read_text()
    assert "# ball.slide_deceleration: not seen enough" in text
    assert "# blue 0.max_speed: 2" in text
    settings = preset(str(path))
    assert settings.limits.max_speed == pytest.approx(2.0, rel=0.03)
    assert settings.limits.braking == pytest.approx(4.0, rel=0.03)
    assert settings.realism.vision_delay == pytest.approx(0.05, abs=0.002)
    # What was not seen enough is the preset's own.
    assert settings.ball == preset("default").ball


def test_what_was_not_seen_enough_goes_into_no_preset() -> None:
    found = identify(driven(RobotLimits(), SimSettings(), seconds=5.0))
    nothing = found.noise._replace(robot_noise=unseen())
    object.__setattr__(found, "noise", nothing)
    assert settings_from(preset_of(found)).realism.robot_noise == 0.0


def test_cameras_without_noise_show_the_truth_in_the_preset_too() -> None:
    found = identify(driven(RobotLimits(), SimSettings(), seconds=10.0))
    noise = found.noise._replace(
        robot_noise=Estimate(4.7e-6, 4.2e-6, 5.2e-6, 12, True),
        heading_noise=Estimate(2e-15, 7e-16, 3e-15, 12, True),
    )
    object.__setattr__(found, "noise", noise)
    object.__setattr__(found, "delay", Estimate(2.4e-10, 0.0, 6e-4, 12, True, "s"))
    assert settings_from(preset_of(found)).realism == RealismSettings()


def test_noise_is_never_less_than_nothing() -> None:
    seen = driven(RobotLimits(), SimSettings(), seconds=5.0)
    poses = np.array(seen.poses)
    # Two robots of which one alone is noisy leave a wide interval.
    poses[:, 1] += np.random.default_rng(0).normal(0.0, 0.002, poses[:, 1].shape)
    found = identify_noise(replace(seen, poses=poses))
    assert found.robot_noise.value > 0.0
    assert found.robot_noise.low == 0.0
    assert found.heading_noise.low == 0.0


def test_hops_and_what_a_kick_carries_on_are_played_with(tmp_path: Path) -> None:
    changes = {"ball": {"first_hop": 0.7, "rebound": 0.55}, "realism": {"ball_noise": 0.001}}
    found = identify(chipped(SimSettings.model_validate(changes), chips=2))
    carried = found.kicks._replace(carried=Estimate(0.8, 0.75, 0.85, 5, True))
    write_preset(replace(found, kicks=carried), tmp_path / "field.yaml")
    settings = preset(str(tmp_path / "field.yaml"))
    assert settings.ball.first_hop == pytest.approx(0.7, abs=0.01)
    assert settings.ball.rebound == pytest.approx(0.55, abs=0.02)
    assert settings.limits.carried == 0.8


@cache
def late() -> Identification:
    settings = SimSettings(realism=RealismSettings(vision_delay=0.03, command_delay=0.02))
    return identify(driven(RobotLimits(dead_time=0.04), settings, seconds=12.0))


@pytest.mark.parametrize("base", ["default", "erforce", "grsim", "real_2025"])
def test_an_identified_delay_stands_in_place_of_all_that_the_base_has(base: str) -> None:
    settings = settings_from(preset_of(late(), base))
    whole = settings.realism.vision_delay + settings.limits.obeys_after(settings.realism.command_delay)
    assert whole == pytest.approx(0.09, abs=0.006)


def test_identified_limits_join_the_axes_whatever_the_base_says() -> None:
    assert not settings_from(preset_of(late(), "erforce")).limits.separate_axes
    assert "separate_axes" not in str(preset_of(late()))


def test_what_the_base_alone_says_is_told(
    recording: Path, found: Found, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(report, "identify", lambda *_: found.identified)
    out = tmp_path / "field.yaml"
    arguments = ["record", "identify", str(recording), "--base", "erforce", "--out", str(out)]
    shown = CliRunner().invoke(app, arguments).stdout
    assert "preset erforce" in shown
    assert "limits.kick_carried 0.9" in " ".join(shown.split())
    assert "# limits.kick_carried: 0.9" in out.read_text()
    # It was identified, though erforce has another.
    assert "limits.acceleration" not in out.read_text()
    taken = json.loads(CliRunner().invoke(app, [*arguments, "--json"]).stdout)["taken"]
    assert taken["limits.kick_carried"] == 0.9
    assert "ball.stop_speed" not in taken


def test_the_command_prints_figures_and_writes_the_file(
    recording: Path, found: Found, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert found.result.exit_code == 0, found.result.stderr
    figures = json.loads(found.result.stdout)["figures"]
    assert figures["delay"]["seen"]
    assert figures["ball.switch_share"].keys() == {"value", "low", "high", "count", "seen", "unit"}
    assert preset(str(found.file)).realism.robot_noise == pytest.approx(0.001, rel=0.1)
    # The same again for the screen, without identifying it once more.
    monkeypatch.setattr(report, "identify", lambda *_: found.identified)
    shown = CliRunner().invoke(app, ["record", "identify", str(recording)]).stdout
    # The page, the file and the screen have one name for each figure, and one line on a usual screen.
    for name in figures:
        assert re.search(rf"^{re.escape(name.removeprefix('blue 1.'))}\b", shown, re.MULTILINE) or " " in name
    assert re.search(r"^side_braking, m/s²  ", shown, re.MULTILINE)
    assert re.search(r"^blue +0 +1 +2 *$", shown, re.MULTILINE)
    assert "-: not seen enough" in shown
    assert max(map(len, shown.splitlines())) <= 80


def test_every_figure_is_on_the_page_and_each_part_of_the_work_is_counted(
    seen: Observations, found: Found
) -> None:
    page = (Path(__file__).parents[2] / "docs" / "identify.md").read_text(encoding="utf-8")
    named = {it.rpartition(".")[2] for it in re.findall(r"`([a-z._]+)`", page)}
    assert {name.rpartition(".")[2] for name, _ in found.identified.figures()} <= named
    # Whoever waits sees how far it is.
    assert found.parts == parts_of(seen) == 1 + len(seen.robots)


@pytest.mark.slow  # it identifies twelve robots
def test_the_commands_of_the_page_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = Path(__file__).parents[2] / "docs" / "identify.md"
    block = page.read_text(encoding="utf-8").split("```sh\n")[1].split("```")[0]
    commands = block.replace("time_limit=60", "time_limit=4").splitlines()
    assert len(commands) == 3
    for command in commands:
        program, *arguments = shlex.split(command)
        assert program == "robobt"
        done = CliRunner().invoke(app, arguments)
        assert done.exit_code == 0, done.stderr


def test_an_unknown_base_is_a_usage_error(recording: Path) -> None:
    done = CliRunner().invoke(app, ["record", "identify", str(recording), "--base", "other"])
    assert done.exit_code == 2
    assert "no simulator preset is called 'other'" in done.stderr


def test_a_recording_without_realism_shows_what_is(tmp_path: Path) -> None:
    seen = load_observations(
        played(load_scenario("three_v_three").lasting(2.0), tmp_path / "p.robobt.arrows")
    )
    assert len(seen) > 50
    assert not np.isnan(seen.poses).any()


@pytest.mark.parametrize("name", ["real_2024", "raven_4"])
def test_without_simulated_cameras_a_late_preset_is_identified_from_the_truth(
    name: str, tmp_path: Path
) -> None:
    # Its robots obey late, so that the trees are shown a prediction, but the cameras show what is.
    scenario = load_scenario("striker_vs_goalkeeper").lasting(4.0)
    changed = scenario.model_copy(update={"simulator": {"preset": name}})
    recording = load_recording(played(changed, tmp_path / "late.robobt.arrows"))
    assert recording.observed is not None
    assert np.abs(recording.observed.robots - recording.truth.robots)[..., :2].max() > 0.005
    seen = observations_of(recording)
    assert seen.poses == pytest.approx(recording.truth.robots[:, :, :3], abs=1e-6)
    limits = preset(name).limits
    assert identify(seen).delay.value == pytest.approx(limits.dead_time, abs=0.01)
