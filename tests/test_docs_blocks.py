"""The Python, YAML and commands of the pages run, block after block, in smaller numbers.

A page's blocks share their names, as in a notebook. What they need besides is put there before, and where
they name another machine or a long time, ``REPLACED`` says what is run instead.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import robobt
import robobt.skills
import robobt.skills.tactics
from robobt.config.yaml import parse_marked
from robobt.learning import TASKS
from robobt.learning.envs.go_to_ball.settings import GoToBallSettings
from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.training.settings import settings_of
from robobt.match.scenario.changes import changed
from robobt.match.scenario.scenario import load_scenario, scenario_from
from robobt.plays import PLAYS
from robobt.shots.data.files import write_shots
from robobt.skills import SKILLS, SelectShot, Stop
from robobt.tournament.entrants import EntrantFile, read_entrant
from robobt.tournament.plan import Plan
from robobt.tree import Selector, Status, TreeRunner
from robobt.tree.devtools.substitution import substitutions
from robobt.world.observation import OWN_OBSERVATIONS
from tests.models.made_models import (
    Onward,
    Passing,
    Straight,
    among_robots_card,
    network,
    score_card,
    team_card,
    write_model,
)
from tests.programs import PROGRAMS, calls_a_program, program_and_words
from tests.registries import temporarily
from tests.shots.made_up import made_up_table

pytestmark = pytest.mark.slow

DOCS = Path(__file__).parent.parent / "docs"

REPLACED = {
    "engines": {
        "RayEngine, ": "",
        'with RayEngine("ray://head:10001") as engine, running_on(engine):': "if True:",
        "10_000, workers=engine.workers": "2",
    },
    "league": {'world="league://grsim"': 'world="sim"', "trials=10": "trials=1"},
    "learning": {"seed=3": "steps=2000, changes={'evaluation.held_out': 20, 'evaluation.starts': 20}"},
    "live": {"def on_running": "class Drawing(Skill):\n  gap = 0.5\n  def on_running"},
    "scenarios": {"trials=20": "trials=2"},
    "team": {"...": "Stop()"},
    "what_if": {"61.5": "9.0", "50, 0": "2, 0", "seconds=3.0": "seconds=0.3"},
    "trees": {"...\n": "runner.tick()\n"},
}
"""By page, what is run instead of what."""

ELSEWHERE = {
    "tick_on": "tests/testing/test_plugin.py: pytest runs it",
    "TeamConnection": "tests/league/test_remote.py: it takes a game controller that knows the team's key",
    "OfficialRefereeFactory": "tests/league/test_official_controller.py: it takes the official program",
    "SoccerParallelEnv": "tests/learning/envs/test_soccer_interfaces.py: it takes PettingZoo",
    "stable_baselines3": "tests/learning/envs/test_soccer_interfaces.py: it takes Stable-Baselines3",
    "check_regression_case": "tests/match/test_regression_cases.py: it takes a case saved before",
}
"""By a word of it, where a block runs that cannot run here."""


def blocks(page: str, kind: str) -> list[str]:
    found = re.findall(r"(?ms)^ *```(\w*)\n(.*?)^ *```", (DOCS / f"{page}.md").read_text())
    of_kind = [block for language, block in found if language == kind]
    return [block for block in of_kind if not any(word in block for word in ELSEWHERE)]


def pages(kind: str) -> list[str]:
    return [page.stem for page in sorted(DOCS.glob("*.md")) if blocks(page.stem, kind)]


def a_recording() -> Mapping[str, object]:
    scenario = robobt.load_scenario("six_v_six").lasting(20.5)
    robobt.play_match(scenario, seed=1, record="six_v_six-0.robobt.arrows")
    return {}


def shots() -> Mapping[str, object]:
    for name, seed in (("train.csv", 1), ("test.csv", 2)):
        write_shots(made_up_table(seed=seed), name)
    return {}


def a_tree_file() -> Mapping[str, object]:
    Path("striker.yaml").write_text(next(block for block in blocks("tree_files", "yaml") if "play:" in block))
    return {}


def a_runner() -> Mapping[str, object]:
    match = robobt.Match(robobt.load_scenario("striker_vs_goalkeeper"))
    return {"runner": TreeRunner(Selector("all", False, [SelectShot(), Stop()]), match.players[0].store)}


def models() -> Mapping[str, object]:
    write_model(Path("models"), Passing(), score_card("score"))
    for skill, name in (("Duel", "duel"), ("Goalkeeper", "save")):
        write_model(Path("models"), network(23, 4), team_card(skill, 0, 1, name=name))
    write_model(Path("models"), Onward(), among_robots_card(name="way"))
    return {"module": Straight()}


def a_skill() -> Mapping[str, object]:
    from robobt.skills.base import Skill

    return {"Skill": Skill, "Status": Status, "thoughts": lambda: 0.5}


def a_store() -> Mapping[str, object]:
    entrants = (read_entrant("team_player"), read_entrant("field_player"))
    with Plan(robobt.load_scenario("three_v_three"), entrants, 1, 1).open_store(Path("night.sqlite")):
        return {}


BEFORE: dict[str, Callable[[], Mapping[str, object]]] = {
    "learned_skills": models,
    "live": a_skill,
    "recording": a_recording,
    "shots": shots,
    "team": lambda: vars(robobt.skills.tactics) | vars(robobt.skills),
    "tournament": a_store,
    "tree_files": a_tree_file,
    "trees": a_runner,
    "what_if": a_recording,
}
"""By page, what puts the files there that its blocks read, and returns the names that they use."""


@pytest.mark.parametrize("page", pages("python"))
def test_the_python_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scope = {"__name__": "__main__", **BEFORE.get(page, dict)()}
    found = blocks(page, "python")
    if page == "learned_skills":
        found.reverse()  # the models are named before it is said how one is made
    text = "\n".join(found)
    for old, new in REPLACED.get(page, {}).items():
        assert old in text
        text = text.replace(old, new)
    with temporarily(PLAYS), temporarily(SKILLS), temporarily(TASKS):
        exec(compile(text, page, "exec"), scope)


def environment(data: dict[str, Any]) -> object:
    keepers = "keepers" in data
    return (ScoreOnGoalkeeperSettings if keepers else GoToBallSettings).model_validate(data)


def scenario(data: dict[str, Any]) -> object:
    if "robots" in data:
        return scenario_from({"ends": {"time_limit": 30}, **data}, "page")
    return changed(robobt.load_scenario("six_v_six"), data)


def training(data: dict[str, Any]) -> object:
    if "stages" in data:
        return settings_of({"task": "duel", "steps": 1, "learner": "ppo", **data}, "page")
    return SoccerSettings.model_validate(data)


CHECKED: dict[str, Callable[[Any], object]] = {
    "environments": environment,
    "referee": scenario,
    "several_robots": training,
    "scenarios": lambda data: scenario({"robots": {"blue": data}} if isinstance(data, list) else data),
    "simulator": scenario,
    "tournament": EntrantFile.model_validate,
    "trees": substitutions,
}
"""By page, what reads its YAML; that of tree_files is played in the test above."""


@pytest.mark.parametrize("page", pages("yaml"))
def test_the_yaml_of_a_page_is_read(page: str) -> None:
    for block in blocks(page, "yaml"):
        # Two lines with one key are two ways to write it.
        ways = block.splitlines() if block.count("keepers: ") > 1 else [block]
        for way in ways:
            if page not in ("tree_files", "own_tasks"):
                CHECKED[page](parse_marked(way, page).plain())


SHORTER = {
    "compare": ["--trials", "1"],
    "evaluate": ["--starts", "20"],
    "match": ["--trials", "1"],
    "record demonstrations": ["--episodes", "2"],
    "shots collect": ["--count", "150"],
    "tournament run": ["--rounds", "1", "--workers", "0"],
    "tournament sweep": [
        "--candidates",
        "2",
        "--concurrent",
        "2",
        "--rounds",
        "1",
        "--confirm-rounds",
        "0",
        "--workers",
        "0",
    ],
    "what-if": ["--trials", "2", "--seconds", "0.3"],
    "train": ["--set", "steps=2000", "--set", "evaluation.starts=20", "--set", "evaluation.held_out=20"],
}
"""By command, options that come last and so hold."""

LESS = {
    r" --stages full| --sprt \S+ \S+": "",
    r"--seeds 5": "--seeds 1",
    r"--workers \d+": "--workers 1",
    r"(paper table4)(?!.*--runs)": r"\1 --runs 1",
    r"--runs \d+": "--runs 1",
    r"paper deployed": "paper deployed --shots 1 --only attack_main --defenders 0",
    r"--from 12\.5": "--from 1.5",
    r"--at 61\.5": "--at 9.0",
    r"--scan": "--scan --every 30 --moments 1",
    r"--from 10 --to 20": "--from 0.5 --to 1.5",
    r"\bFOLDER\b": str(DOCS.parent / "models" / "paper_shots.parquet"),
    r"\bMODEL\b": "models/score.pt",
}
"""What else is made shorter."""

NOT_HERE = {
    "ray": "tests/engines/test_cluster.py: it takes a cluster",
    "league://": "tests/league/test_other_simulators.py: it takes another simulator",
    "official": "tests/league/test_official_controller.py: it takes the official program",
    "../old": "tests/tournament/test_two_states.py: it takes another checkout",
    "other_machine": "tests/tournament/test_store.py: it takes another machine's results",
    "--live": "tests/cli/test_live.py: it lasts until Ctrl-C",
    "robobt serve": "tests/cli/test_league.py: it lasts until Ctrl-C, on ports that nobody uses",
    "log.gz": "tests/cli/test_league.py: it takes the log of a match",
    "python -m benchmarks": "tests/benchmarks/test_commands.py: it takes hours",
}
"""By a word of it, where a command runs that cannot run here; test_docs reads it as robobt does."""


def test_what_runs_elsewhere_names_the_test() -> None:
    for said in [*NOT_HERE.values(), *ELSEWHERE.values()]:
        assert Path(__file__).parents[1].joinpath(said.partition(":")[0]).is_file()


def lines(page: str) -> list[str]:
    typed = "\n".join([*blocks(page, "sh"), *blocks(page, "")]).splitlines()
    commands = [line.split("  #")[0].strip() for line in typed if calls_a_program(line)]
    return [line for line in commands if not any(word in line for word in NOT_HERE)]


def entrants() -> Mapping[str, object]:
    Path("mine.yaml").write_text(blocks("tournament", "yaml")[0])
    Path("my_skills.py").write_text("")
    return {}


def own_plays() -> Mapping[str, object]:
    source = next(block for block in blocks("trees", "python") if "# my_plays.py" in block)
    Path("my_plays.py").write_text(source)
    Path("mine.yaml").write_text(blocks("scenarios", "yaml")[0])
    return {}


def own_task() -> Mapping[str, object]:
    OWN_OBSERVATIONS.clear()  # the page's own, of the test of its Python
    Path("my_task.py").write_text(blocks("own_tasks", "python")[0])
    Path("my_play.yaml").write_text(blocks("own_tasks", "yaml")[0])
    return {}


FILES = {
    "learning": models,
    "own_tasks": own_task,
    "recording": a_recording,
    "tournament": entrants,
    "trees": own_plays,
    "what_if": a_recording,
}
"""By page, what puts the files there that its commands read."""


def with_commands() -> list[str]:
    """All but the start page, which has tests of its own in the fast suite."""
    return [page.stem for page in sorted(DOCS.glob("*.md")) if page.stem != "index"]


@pytest.mark.parametrize("page", [page for page in with_commands() if lines(page)])
def test_the_commands_of_a_page_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    FILES.get(page, dict)()
    monkeypatch.setattr("robobt.match.load_scenario", lambda source: load_scenario(source).lasting(2.0))
    with (
        temporarily(PLAYS),
        temporarily(SKILLS),
        temporarily(TASKS),
    ):  # one file's plays are registered once in a process
        for line in lines(page):
            shorter = line
            for long, short in LESS.items():
                shorter = re.sub(long, short, shorter)
            program, words = program_and_words(shorter)
            command = [*words, *SHORTER.get(words[0], SHORTER.get(" ".join(words[:2]), []))]
            done = CliRunner().invoke(PROGRAMS[program], command)
            verdicts = (0, 1) if line.startswith("robobt tournament sweep") else (0,)  # 1: nothing is better
            assert done.exit_code in verdicts, f"{shorter}: {done.output} {done.exception}"
