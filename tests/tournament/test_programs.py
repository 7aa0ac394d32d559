"""Programs as entrants: served, watched, and ended; who misbehaves has lost by rule."""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from robobt.match import load_scenario
from robobt.match.recording import load_recording
from robobt.tournament.entrants import Entrant, EntrantError, read_entrant
from robobt.tournament.plan import Plan
from robobt.tournament.play import Played, play_tournament
from robobt.tournament.played import PlayedMatch
from robobt.tournament.recordings import Keep, Recordings
from robobt.world.game import Team
from robobt.worlds import sim_world
from tests.tournament.made_up import drill, plan, runner
from tests.waiting import soon

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs /proc"),
]

CLIENT = Path(__file__).parent.parent / "league" / "programs" / "client.py"
ROOT = Path(__file__).parent.parent.parent

FILE = """
entrant: {name}
program:
  command: [env, "PYTHONPATH={root}", {python}, {client}, "{name}", "{{team}}", "{port}", "{folder}"]
  ready_within: {ready}
  silent_for: {silent}
  ends_within: 5
  {more}
"""


def program(
    folder: Path, name: str, ready: float = 30.0, port: str = "{grsim}", more: str = "", silent: float = 3.0
) -> Entrant:
    file = folder / f"{name}.yaml"
    given = {"ready": ready, "port": port, "more": more, "silent": silent, "folder": folder}
    file.write_text(FILE.format(name=name, root=ROOT, python=sys.executable, client=CLIENT, **given))
    return read_entrant(str(file))


def run(tmp_path: Path, *teams: Entrant, workers: int = 0, seconds: float = 3.0, **options: Any) -> Played:
    given = {"scenario": drill(seconds), "entrants": (runner(0.0), *teams), "against": "at 0"}
    what = plan(1, **given, speed=3.0)
    with what.open_store(tmp_path / "night.sqlite") as store:
        return play_tournament(what, store, workers, **options)


def left(folder: Path) -> list[str]:
    """Clients of this test that still run."""
    found = []
    for process in Path("/proc").iterdir():
        with suppress(OSError):
            words = (process / "cmdline").read_text().split("\0")
            if str(CLIENT) in words and str(folder) in words:
                found.append(" ".join(words))
    return found


def test_a_program_drives_its_robots_from_either_side(tmp_path: Path) -> None:
    recordings = Recordings(tmp_path / "recordings", Keep.ALL, "at 0")
    found = run(tmp_path, program(tmp_path, "drives"), recordings=recordings)
    assert [(match.outcome, round(match.time, 1)) for match in found.matches] == [("time", 3.0)] * 2
    for match in found.matches:
        recording = load_recording(recordings.path(match.fixture))
        start, end = recording.frame(0), recording.frame(len(recording) - 1)
        side, other = (Team.BLUE, Team.YELLOW) if match.blue == "drives" else (Team.YELLOW, Team.BLUE)
        # Ahead at 1 m/s, from when its first command is there; the other one stands still.
        before, after = (frame.seen_by(side).own[0].x for frame in (start, end))
        assert 1.5 < after - before <= 3.0
        assert start.seen_by(other).own[0].position == end.seen_by(other).own[0].position
    assert {path.read_text() for path in (tmp_path / "night.output").glob("*/*.txt")} == {"ready\n"}
    assert not left(tmp_path)


@pytest.mark.parametrize(
    ("workers", "name", "settings"),
    [(0, "steps", ("{steps}", "lockstep: true")), (1, "drives", ("{grsim}",))],
)
def test_a_program_that_may_stay_is_started_once_for_either_side(
    workers: int, name: str, settings: tuple[str, ...], tmp_path: Path
) -> None:
    port, *more = settings
    teams = (runner(0.0), program(tmp_path, name, port=port, more="\n  ".join(["stays: true", *more])))
    what = plan(2, scenario=drill(1.0), entrants=teams, against="at 0", speed=3.0)
    with what.open_store(tmp_path / "night.sqlite") as store:
        found = play_tournament(what, store, workers)
    assert [match.forfeited_by for match in found.matches] == [None] * 4
    assert len(list((tmp_path / "night.output").glob("*/*.txt"))) == 2
    soon(lambda: not left(tmp_path))


@pytest.mark.slow
def test_a_program_that_may_stay_and_has_lost_by_rule_is_started_anew(tmp_path: Path) -> None:
    found = run(tmp_path, program(tmp_path, "crashes", more="stays: true"), seconds=24.0)
    assert [match.forfeited_by for match in found.matches] == ["crashes"] * 2
    assert len(list((tmp_path / "night.output").glob("*/*.txt"))) == 2
    assert not left(tmp_path)


STEPS = """
entrant: {name}
program:
  command: [env, "PYTHONPATH={root}", {python}, -m, robobt, match, {scenario}, --referee, none, --trials, "1",
    --world, "league://steps?teams={{team}}&vision={{vision}}&referee={{referee}}&{{team}}={{steps}}&follow_referee=true&place=\
false"]
  lockstep: true
  ready_within: 120
  silent_for: 120
"""


def stepped(folder: Path, name: str, scenario: str) -> Entrant:
    file = folder / f"{name}.yaml"
    file.write_text(STEPS.format(name=name, root=ROOT, python=sys.executable, scenario=scenario))
    return read_entrant(str(file))


def twice(tmp_path: Path, what: Plan) -> list[list[PlayedMatch]]:
    found = []
    for name in ("once", "again"):
        with what.open_store(tmp_path / f"{name}.sqlite") as store:
            found.append(play_tournament(what, store, 2).matches)
    for once, again in zip(*found, strict=True):
        assert once.forfeited_by is again.forfeited_by is None, (once.sides, again.sides)
        assert (once.trace, once.ticks) == (again.trace, again.ticks)
    return found


@pytest.mark.slow
def test_matches_of_programs_in_lock_step_are_the_same_bit_for_bit(tmp_path: Path) -> None:
    teams = [
        program(tmp_path, name, port="{steps}", more="lockstep: true", silent=60.0)
        for name in ("steps", "steps 2")
    ]
    found = twice(tmp_path, plan(1, scenario=drill(2.4), entrants=tuple(teams)))
    assert len({match.trace for match in found[0]}) == 2
    assert all(match.ticks > 100 for match in found[0])
    assert not left(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("sides", [1, 2])
def test_robobts_own_matches_in_lock_step_are_the_same_bit_for_bit(sides: int, tmp_path: Path) -> None:
    scenario = load_scenario("striker_vs_goalkeeper").lasting(3.0)
    teams = [stepped(tmp_path, name, "striker_vs_goalkeeper") for name in ("first", "second")]
    if sides == 1:
        teams[1] = read_entrant("attack_main")
    found = twice(tmp_path, plan(1, scenario=scenario, entrants=tuple(teams), world=sim_world))
    # One program on both sides is the same match whatever it is called.
    assert (found[0][0].trace == found[0][1].trace) is (sides == 2)


@pytest.mark.slow
def test_programs_side_by_side_never_meet(tmp_path: Path) -> None:
    teams = [program(tmp_path, name) for name in ("drives", "twice")]
    what = plan(2, entrants=tuple(teams), speed=3.0)
    with what.open_store(tmp_path / "night.sqlite") as store:
        found = play_tournament(what, store, 2)
    assert [match.forfeited_by for match in found.matches] == [None] * 4
    assert not left(tmp_path)


@pytest.mark.slow
def test_who_misbehaves_has_lost_and_nothing_is_left(tmp_path: Path) -> None:
    bad = {
        "exits": "its program ended with exit code 1: nothing to do here",
        "crashes": "its program ended with exit code 1: RuntimeError: on purpose",
        "mute": "its program did not command a robot within 8 s",
        "nan": "its program did not command a robot within 8 s",
        "silent": "its program was silent for 3 s",
    }
    end = "its program, or a child of it, did not end within 5 s of SIGTERM"
    bad |= {
        "floods": "its program sent more than 50 packets a control period, for too long",
        "shouts": "its program printed more than 64 MB",
        "stubborn": end,
        "deaf": end,
    }
    teams = [program(tmp_path, name, 8.0) for name in bad]
    found = run(tmp_path, *teams, workers=2, seconds=24.0)
    assert not found.failed
    for name, told in bad.items():
        matches = [match for match in found.matches if name in match.fixture]
        assert [match.forfeited_by for match in matches] == [name, name], name
        for match in matches:
            said, _, printed = str(match.side(name).first_error).partition("; its output: ")
            assert said == f"{name}: {told}"
            assert Path(printed).is_file()
    assert not left(tmp_path)
    assert sum(path.stat().st_size for path in (tmp_path / "night.output").glob("*/*")) < 10 << 20


@pytest.mark.parametrize("told", [True, False])
@pytest.mark.slow
def test_a_forfeit_says_where_the_output_lies(told: bool, tmp_path: Path) -> None:
    found = run(tmp_path, program(tmp_path, "exits"), tell_outputs=told).matches[0]
    said, _, printed = str(found.side("exits").first_error).partition("; its output: ")
    assert said == "exits: its program ended with exit code 1: nothing to do here"
    assert Path(printed).read_text() == "nothing to do here\n" if told else printed == ""


def test_a_program_that_is_not_there_has_lost(tmp_path: Path) -> None:
    file = tmp_path / "gone.yaml"
    file.write_text("entrant: gone\nprogram: {command: [./no-such-program]}\n")
    found = run(tmp_path, read_entrant(str(file)))
    assert [match.forfeited_by for match in found.matches] == ["gone", "gone"]
    assert found.matches[0].side("gone").first_error == "gone: ./no-such-program: there is no such program"


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("program: 60\n", "program: input should be a mapping, not 60"),
        ("program: {}\n", "program.command: is missing"),
        ("program: {command: []}\n", "program.command: list should have at least 1 item, not 0"),
        ("program: {command: ./start.sh}\n", "program.command: input should be a list, not './start.sh'"),
        ("program: {command: [x], ready_within: 0}\n", "program.ready_within"),
        ("program: {command: [x], lockstep: true}\n", "program.lockstep: needs {steps} in the command"),
        ("program: {command: [x]}\nplayers: [{play: stand_still}]\n", "program: plays all robots"),
        ("", "players: is missing, and there is no program either"),
    ],
)
def test_a_wrong_file_is_told_by_its_field(content: str, problem: str, tmp_path: Path) -> None:
    file = tmp_path / "team.yaml"
    file.write_text(f"entrant: a\n{content}")
    with pytest.raises(EntrantError, match=problem):
        read_entrant(str(file))
