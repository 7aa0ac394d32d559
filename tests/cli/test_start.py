"""A command imports what it uses, so that it starts quickly."""

from __future__ import annotations

import subprocess
import sys

import pytest

from robobt.cli import application

HEAVY = {
    "numpy",
    "pydantic",
    "numba",
    "scipy.optimize",
    "scipy.special",
    "torch",
    "onnxruntime",
    "matplotlib",
}


@pytest.mark.parametrize(
    ("command", "needed"),
    [("--help", set()), ("scenarios", {"pydantic"}), ("plays", {"numpy", "pydantic", "numba"})],
)
def test_a_list_needs_little(command: str, needed: set[str]) -> None:
    code = (
        "import sys; from robobt.cli import main\n"
        "try: main()\n"
        f"finally: print(*sorted({HEAVY!r} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code, command], capture_output=True, text=True, check=True)
    assert set(done.stdout.splitlines()[-1].split()) == needed


def test_one_command_alone_is_the_same_as_among_all() -> None:
    def names(app: object) -> set[str]:
        return {info.name for info in (*app.registered_commands, *app.registered_groups)}  # type: ignore[attr-defined]

    assert names(application("match")) == {"match"}
    assert names(application("shots")) == {"shots"}
    everything = names(application("no such command"))
    assert everything == names(application()) > {"match", "shots"}
