"""Model files tried one by one, each in a process of its own: ``python -m tests.models.checks.trials``."""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np
import torch

from robobt.models.file import ModelError
from robobt.models.policy import Policy, load_policy
from tests.models.checks.generated import onnx_file, torchscript_file
from tests.models.made_models import write_model

MAKERS: dict[str, Callable[[Path, int], Path]] = {"torchscript": torchscript_file, "onnx": onnx_file}
MEMORY = 2 * 2**30
SECONDS = 10
EXTREME = [
    0.0,
    9.5,
    1e9,
    -1e9,
    np.inf,
    -np.inf,
    np.nan,
    2.0**31,
    -(2.0**31),
    2.0**63,
    -(2.0**63),
    1.0,
    -1.0,
    3e38,
]


def run(policy: Policy) -> bool:
    """Ask a policy about ordinary and extreme observations; whether it answered all of them."""
    size, rng, answered = policy.card.observation.size, np.random.default_rng(1), True
    ordinary = [rng.normal(0.0, 2.0, (count, size)) for count in (1, 2, 17, 63, 64, 65, 200)]
    extreme = [np.full((3, size), value) for value in EXTREME]
    one = policy.single()
    for inputs in [*ordinary, *extreme, *[rng.choice(EXTREME, (64, size)) for _ in range(5)]]:
        try:
            policy(inputs)
            one(inputs[0])
        except ModelError:
            answered = False
    return answered


def trial(make: Callable[[], Path]) -> dict[str, object]:
    """Make, load and run a file in a forked process; what came of it, and what it took."""
    reading, writing = os.pipe()
    begun = time.monotonic()
    child = os.fork()
    if not child:
        try:
            os.write(writing, json.dumps(_tried(make)).encode())
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as stream:
        said = stream.read()
    status = os.waitpid(child, 0)[1]
    told: dict[str, object] = json.loads(said) if said else {"outcome": "exit"}
    if os.WIFSIGNALED(status):
        name = signal.Signals(os.WTERMSIG(status)).name
        told = {"outcome": "hang" if name in ("SIGXCPU", "SIGALRM") else name}
    return told | {"seconds": time.monotonic() - begun}


def _tried(make: Callable[[], Path]) -> dict[str, object]:
    path = make()
    before = _memory("VmHWM")
    # Processor time, as others may use the machine; a sleeping process ends as well.
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    signal.alarm(12 * SECONDS)
    limit = _memory("VmData") + MEMORY
    resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
    said = ""
    try:
        outcome = "loaded" if run(load_policy(path)) else "loaded, fails on some"
    except ModelError as error:
        outcome, said = "refused", str(error).partition(": ")[2]
    except Exception as error:
        outcome, said = type(error).__name__, str(error)
    return {"outcome": outcome, "said": said, "memory": _memory("VmHWM") - before}


def _memory(field: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * int(next(line.split()[1] for line in lines if line.startswith(f"{field}:")))


def main() -> None:
    """Try files and print what came of them, a line of JSON each if asked, and a summary for each format."""
    parser = argparse.ArgumentParser()
    parser.add_argument("format", nargs="+", choices=sorted(MAKERS))
    parser.add_argument("--seed", type=int, default=44)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--each", action="store_true", help="print every trial")
    given = parser.parse_args()
    torch.set_num_threads(1)
    with tempfile.TemporaryDirectory() as folder:
        # What the first load imports is no file's doing.
        import_module("torch._dynamo")
        load_policy(write_model(Path(folder), formats=("torchscript", "onnx")))
        load_policy(Path(folder) / "small.onnx")
        for kind in given.format:
            print(json.dumps(_tried_of(kind, Path(folder), given)))


def _tried_of(kind: str, folder: Path, given: argparse.Namespace) -> dict[str, object]:
    outcomes: Counter[str] = Counter()
    most, slowest = 0, 0.0
    for number in range(given.count):
        seed = 1_000_000 * given.seed + number
        told = trial(lambda seed=seed: MAKERS[kind](Path(tempfile.mkdtemp(dir=folder)), seed))
        if given.each:
            print(json.dumps({"seed": seed} | told), flush=True)
        outcomes[str(told["outcome"])] += 1
        most = max(most, int(str(told.get("memory", 0))))
        slowest = max(slowest, float(str(told["seconds"])))
    return {"outcomes": outcomes, "memory": most, "seconds": round(slowest, 1)}


if __name__ == "__main__":
    main()
