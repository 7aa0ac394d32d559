"""A command imports what it uses, so that it starts quickly."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from robobt.cli import application

HEAVY = {
    "numpy",
    "pydantic",
    "numba",
    "pymunk",
    "scipy.optimize",
    "scipy.special",
    "torch",
    "onnxruntime",
    "matplotlib",
}


NEEDED = {
    "--help": set(),
    "list scenarios": {"pydantic"},
    "list models": {"numpy", "pydantic"},
    "list policies": {"numpy", "pydantic"},
    "list raters": {"numpy", "pydantic"},
    "list plays": {"numpy", "pydantic"},
    "list plays --json": {"numpy", "pydantic"},
    "list skills": {"numpy", "pydantic"},
    "list scenarios --json": {"numpy", "pydantic"},
    "list tasks": {"numpy", "pydantic"},
    "list challenges": {"numpy", "pydantic"},
}
"""What has been imported after each of these commands, which run one after the other in one process."""


def test_a_list_needs_little() -> None:
    code = (
        "import sys; from robobt.cli import main\n"
        f"for command in {[*NEEDED]!r}:\n"
        "    sys.argv = ['robobt', *command.split()]\n"
        "    try: main()\n"
        "    except SystemExit as end: print(end.code or 0, file=sys.stderr, end=' ')\n"
        f"    print(*sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = [line.split() for line in done.stderr.splitlines()]
    assert {line[0] for line in found} == {"0"}
    assert dict(zip(NEEDED, [set(line[1:]) for line in found], strict=True)) == NEEDED


def test_a_match_plays_without_scipy() -> None:
    code = (
        "import sys; sys.modules['scipy'] = None; import robobt\n"
        "print(robobt.run_trials(robobt.load_scenario('team_v_baseline').lasting(0.2), 1).summary().trace)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_one_command_alone_is_the_same_as_among_all() -> None:
    def names(app: object) -> set[str]:
        return {info.name for info in (*app.registered_commands, *app.registered_groups)}  # type: ignore[attr-defined]

    assert names(application("match")) == {"match"}
    assert names(application("shots")) == {"shots"}
    everything = names(application("no such command"))
    assert everything == names(application()) > {"match", "shots"}


@pytest.mark.parametrize(
    ("typed", "offered"), [("match striker", "striker_vs_goalkeeper"), ("show attack_m", "attack_main")]
)
def test_a_shell_completes_names(typed: str, offered: str) -> None:
    environment = dict(
        os.environ, _ROBOBT_COMPLETE="complete_bash", COMP_WORDS=f"robobt {typed}", COMP_CWORD="2"
    )
    done = subprocess.run(
        [sys.executable, "-c", "from robobt.cli import main; main()"],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
    )
    assert done.stdout.split() == [offered]
