"""How long a first match takes, and how many functions it compiles."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from typing import Annotated, Any

import typer
from numba.core.event import Event, Listener, install_listener

from robobt.cli import Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.cli.compile_ahead import LINES, TRAINING
from robobt.world.compiled_ahead import compiled_lines
from robobt.world.compiled_key import COMPILING


class Compilations(Listener):
    """What is compiled, each version of a function an item: its name, the types, and whether it is robobt's.

    Attributes:
        items: those items.
        seconds: CPU time of compiling, loading from a cache not included [s].
    """

    def __init__(self) -> None:
        self.items: list[tuple[str, str, bool]] = []
        self.seconds = 0.0
        self._begun: list[float] = []

    def on_start(self, event: Event) -> None:
        """Note what is compiled, and when it begins."""
        self._begun.append(time.process_time())
        if event.data is not None:
            function = event.data["dispatcher"].py_func
            own = function.__module__.startswith("robobt.")
            name = f"{function.__module__}.{function.__qualname__}"
            self.items.append((name, str(event.data["args"]), own))

    def on_end(self, event: Event) -> None:  # noqa: ARG002
        """Add the time, that of functions compiled within another once."""
        begun = self._begun.pop()
        if not self._begun:
            self.seconds += time.process_time() - begun

    def figures(self) -> dict[str, float]:
        """Return the numbers of functions and versions, robobt's own and numba's, and the CPU time [s]."""
        own = Counter(item[:2] for item in self.items if item[2])
        functions = Counter(name for name, _ in own)
        return {
            "functions": len(functions),
            "versions": own.total(),
            "twice": sum(count > 1 for count in functions.values()),
            "of_numba": len(self.items) - own.total(),
            "compiling_s": self.seconds,
        }


def first_run(scenario: str = "six_v_six", ahead: bool = False) -> dict[str, float]:
    """Play a trial of a scenario in a new process that has nothing compiled, and measure it.

    Args:
        scenario: name or file.
        ahead: whether to compile ahead before, in processes of its own.

    Returns:
        The figures of :class:`Compilations` in the match, ``match_cpu_s``, and for compiling ahead
        ``ahead_cpu_s`` and ``ahead_wall_s``; the times include the start of Python [s].
    """
    figures = {}
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "NUMBA_CACHE_DIR": folder}
        if ahead:
            begun = time.monotonic()
            figures["ahead_cpu_s"] = _cpu([sys.executable, "-m", "robobt.cli.compile_ahead"], env)[0]
            figures["ahead_wall_s"] = time.monotonic() - begun
        script = f"from benchmarks.first_run import play_one; play_one({scenario!r})"
        figures["match_cpu_s"], printed = _cpu([sys.executable, "-c", script], env)
    return {**json.loads(printed), **figures}


def play_one(scenario: str) -> None:
    """Play a trial and print the figures of what it compiled as JSON.

    Args:
        scenario: name or file.
    """
    import robobt

    compilations = Compilations()
    with install_listener(COMPILING, compilations):
        robobt.play_match(robobt.load_scenario(scenario), 1)
    print(json.dumps(compilations.figures()))


def write() -> None:
    """Write the list of functions that are compiled ahead, from what matches and environments call."""
    import gymnasium

    import robobt
    from robobt.learning.tasks import TASKS, environment_id

    for scenario in ("striker_vs_goalkeeper", "six_v_six"):
        robobt.play_match(robobt.load_scenario(scenario), 1)
    match = compiled_lines()
    for name in TASKS:
        env: Any = gymnasium.make_vec(f"{environment_id(name)}-v0", 12)
        env.reset(seed=1)
        for _ in range(100):
            env.step(env.action_space.sample())
    training = [line for line in compiled_lines() if line not in match]
    LINES.write_text("\n".join([*match, TRAINING, *training, ""]), "utf-8")


def _cpu(command: list[str], env: dict[str, str]) -> tuple[float, str]:
    before = os.times()
    printed = subprocess.run(command, env=env, check=True, stdout=subprocess.PIPE, text=True).stdout
    after = os.times()
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return used, printed


def first_run_command(
    scenario: Annotated[str, typer.Option("--scenario", help="Name or file of a scenario.")] = "six_v_six",
    writing: Annotated[
        bool, typer.Option("--write", help="Write the list of what is compiled ahead instead.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Measure a first match in a new process, with nothing compiled and with what is compiled ahead.

    Keys of --json: lazily and ahead, each with functions, versions, twice (functions of robobt that the
    match compiled, versions of them, and functions compiled more than once), of_numba (numba's own helpers),
    compiling_s (CPU time of compiling in the match), match_cpu_s (of the whole process); and for ahead
    ahead_cpu_s and ahead_wall_s (what compiling ahead took).
    """
    if writing:
        write()
        return
    with errors.status("playing first matches"):
        rows = {"lazily": first_run(scenario), "ahead": first_run(scenario, ahead=True)}
    if as_json:
        print_json(rows)
        return
    shown = table(
        "compiled", "functions", "versions", "twice", "of numba", "compiling, s", "match, s", "ahead, s"
    )
    for name, row in rows.items():
        counts = [f"{row[key]:g}" for key in ("functions", "versions", "twice", "of_numba")]
        times = [f"{row.get(key, 0.0):.1f}" for key in ("compiling_s", "match_cpu_s", "ahead_cpu_s")]
        shown.add_row(name, *counts, *times)
    console.print(shown)
    wall = rows["ahead"]["ahead_wall_s"]
    say(
        f"CPU time of a trial of {scenario} in a new process; compiling ahead took {wall:.1f} s by the clock."
    )
