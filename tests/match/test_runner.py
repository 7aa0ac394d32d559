import os
import signal
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from robobt.match import MatchResult, Run, RunError, ScenarioError, run_trials_in
from robobt.match.recording import load_recording
from robobt.match.results.file import ResultsFileError
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.plays import PLAYS
from robobt.worlds import sim_world
from tests.conftest import StartPython
from tests.match.scripted import PlainWorld, Scripted, data
from tests.registries import temporarily
from tests.waiting import soon

pytestmark = pytest.mark.integration


def scenario(**changes: Any) -> Scenario:
    ball = {"position": {"center": [0, 0], "radius": 1.0}}
    return scenario_from(data(ball=ball, **changes), "test.yaml")


def figures(run: Run) -> list[dict[str, Any]]:
    """All that has to be the same in every run."""
    return [{**result.to_json(), "wall_time": None} for result in run.results]


class RaisingWorld(PlainWorld):
    def act(self, commands: Any) -> None:
        raise RuntimeError("the field is on fire")


def test_trials_have_seeds_of_their_own():
    seeds = {trial_seed(run, trial) for run in range(20) for trial in range(20)}
    assert len(seeds) == 400
    assert all(0 <= seed < 2**53 for seed in seeds)


def test_the_scenario_says_how_often_and_with_which_seed():
    run = run_trials_in(scenario(trials=3, seed=5), PlainWorld)
    assert [result.seed for result in run.results] == [trial_seed(5, trial) for trial in range(3)]
    assert not run.interrupted


def test_a_trial_does_not_depend_on_the_others():
    few, many = run_trials_in(scenario(), PlainWorld, 2), run_trials_in(scenario(), PlainWorld, 4)
    assert figures(few) == figures(many)[:2]
    assert figures(run_trials_in(scenario(), PlainWorld, 2, seed=1)) != figures(few)


@pytest.mark.usefixtures("spawned_workers")
def test_a_run_over_worker_processes_is_the_same_run(tmp_path: Path):
    """Determinism over processes, in the real simulator: traces, figures and recordings are identical."""
    paths = [tmp_path / f"{workers}.robobt.arrows" for workers in (1, 2)]
    alone, shared = (
        run_trials_in(scenario(), sim_world, 5, workers, record={3: path})
        for workers, path in zip((1, 2), paths, strict=True)
    )
    assert figures(shared) == figures(alone)
    assert load_recording(paths[0]).header.trial == 3
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_every_result_is_reported_as_it_finishes():
    seen: list[MatchResult] = []
    run = run_trials_in(scenario(), PlainWorld, 4, on_result=seen.append)
    assert seen == run.results


class TestOut:
    def test_finished_trials_are_not_played_again(self, tmp_path: Path):
        out = tmp_path / "results.jsonl"
        first = run_trials_in(scenario(), PlainWorld, 3, out=out)
        again = run_trials_in(scenario(), RaisingWorld, 3, out=out)
        assert again.results == first.results
        assert figures(run_trials_in(scenario(), PlainWorld, 5, out=out)) == figures(
            run_trials_in(scenario(), PlainWorld, 5)
        )

    def test_a_run_that_failed_keeps_what_was_finished(self, tmp_path: Path):
        out = tmp_path / "results.jsonl"
        with pytest.raises(RunError):
            run_trials_in(scenario(), _fails_at_trial_2, 5, out=out)
        assert len(out.read_text().splitlines()) == 1 + 2

    def test_results_of_another_seed_are_not_mixed_in(self, tmp_path: Path):
        out = tmp_path / "results.jsonl"
        run_trials_in(scenario(), PlainWorld, 1, out=out)
        with pytest.raises(ResultsFileError, match="seed"):
            run_trials_in(scenario(), PlainWorld, 1, seed=9, out=out)

    @pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes have no names here")
    def test_a_pipe_is_refused_instead_of_waited_for(self, tmp_path: Path):
        pipe = tmp_path / "pipe"
        os.mkfifo(pipe)
        with pytest.raises(ResultsFileError, match="not an ordinary file"):
            run_trials_in(scenario(), PlainWorld, 1, out=pipe)


class _FailsAtTrial2(PlainWorld):
    def reset(self, placement: Any, seed: int) -> None:
        super().reset(placement, seed)
        self.placed = placement

    def act(self, commands: Any) -> None:
        if self.placed == scenario().place(_placement_rng(2)):
            raise RuntimeError("not this one")
        super().act(commands)


def _placement_rng(trial: int) -> Any:
    import numpy as np

    return np.random.default_rng(np.random.SeedSequence(trial_seed(0, trial)).spawn(3)[0])


_fails_at_trial_2 = _FailsAtTrial2


@pytest.mark.parametrize("workers", [1, 2])
class TestFailures:
    def test_a_world_that_raises_is_one_clear_error(self, workers: int):
        with pytest.raises(RunError, match=r"test\.yaml: trial \d: RuntimeError: the field is on fire"):
            run_trials_in(scenario(), RaisingWorld, 2, workers)

    def test_a_scenario_that_does_not_fit_the_world_is_its_own_error(self, workers: int):
        wrong = scenario(simulator={"preset": "nothing"})
        with pytest.raises(
            ScenarioError, match=r"test\.yaml: simulator: no simulator preset is called 'nothing'"
        ):
            run_trials_in(wrong, sim_world, 2, workers)


_SLEEPY_RUN = """
import os, sys, time
from pathlib import Path
from robobt.match import run_trials_in
from tests.match.scripted import PlainWorld
from tests.match.test_runner import scenario

class SleepyWorld(PlainWorld):
    def reset(self, placement, seed):
        Path(sys.argv[1], str(os.getpid())).touch()
        time.sleep(60)

if __name__ == "__main__":
    run_trials_in(scenario(), SleepyWorld, 2, workers=2)
"""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs /proc to look for processes")
def test_workers_end_with_a_run_that_is_killed(tmp_path: Path, start_python: StartPython):
    script, ids = tmp_path / "run.py", tmp_path / "ids"
    script.write_text(_SLEEPY_RUN)
    ids.mkdir()
    root = Path(__file__).resolve().parents[2]
    run = start_python(script, ids, env={**os.environ, "PYTHONPATH": str(root)})
    soon(lambda: len(list(ids.iterdir())) == 2)
    run.kill()
    run.wait()
    soon(lambda: not any(_lives(path.name) for path in ids.iterdir()))


def _lives(process: str) -> bool:
    # One that nobody has waited for yet has ended all the same.
    try:
        return Path("/proc", process, "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_play_that_only_this_process_has_is_said_so(monkeypatch: pytest.MonkeyPatch):
    def notebook(**_: Any) -> Scripted:
        return Scripted(speed=1.0, kick=0.0, breaks="")

    cell = ModuleType("cell")
    cell.notebook, notebook.__module__, notebook.__qualname__ = notebook, "cell", "notebook"  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "cell", cell)
    with temporarily(PLAYS):
        PLAYS.register("notebook")(notebook)
        robot = {"number": 0, "play": "notebook", "start": {"position": [-2.0, 0.0], "heading": 0.0}}
        played = scenario(robots={"blue": [robot], "yellow": []})
        with pytest.raises(RunError, match=r"^a worker process does not know .*: No module named 'cell'$"):
            run_trials_in(played, PlainWorld, 2, workers=2)


def test_a_world_that_cannot_be_sent_to_workers_is_said_so():
    with pytest.raises(RunError, match="cannot be sent to worker processes"):
        run_trials_in(scenario(), lambda it: PlainWorld(it), 2, workers=2)


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_keeps_what_is_finished(workers: int):
    def stop_after_two(result: MatchResult) -> None:
        if len(seen) == 1:
            signal.raise_signal(signal.SIGINT)
        seen.append(result)

    seen: list[MatchResult] = []
    # A shell that runs the tests in the background has Ctrl-C ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        run = run_trials_in(scenario(), PlainWorld, 1000, workers, on_result=stop_after_two)
    finally:
        signal.signal(signal.SIGINT, before)
    assert run.interrupted
    assert len(run.results) == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"trials": 0}, "trials must be"),
        ({"trials": 10**9}, "trials must be"),
        ({"workers": 0}, "workers must be"),
        ({"workers": 10**6}, "workers must be"),
        ({"trials": 2, "record": {2: "x"}}, "no trial 2 to record"),
    ],
)
def test_arguments_out_of_range_are_refused(arguments: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        run_trials_in(scenario(), PlainWorld, **arguments)
