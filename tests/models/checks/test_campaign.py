"""Hostile model files by the thousand: each is loaded or refused in time, and nothing else happens."""

from __future__ import annotations

import os
import random
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from robobt.models import policy
from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from tests.campaign import count
from tests.models.checks.test_hostile_torchscript import PLAIN, PLAIN_STATE
from tests.models.made_models import members_of, sealed

pytestmark = pytest.mark.slow


@contextmanager
def nothing_happens(folder: Path) -> Iterator[Path]:
    """Check that a file stays as it is, none is added and the memory stays bounded."""
    victim = folder / "victim"
    victim.write_bytes(b"precious" * 8)
    here = set(os.listdir())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield victim
    assert victim.read_bytes() == b"precious" * 8
    assert set(os.listdir()) == here
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 400_000


def loaded(path: Path) -> bool:
    """Whether it is; anything but a policy or a refusal, within 10 s, is an error."""
    policy._LOADED.clear()
    begun = time.process_time()
    said = ""
    try:
        load_policy(path)
    except ModelError as error:
        said = str(error)
    assert time.process_time() - begun < 10.0
    assert "\n" not in said
    return not said


def mutated(members: dict[str, bytes], rng: random.Random) -> dict[str, bytes]:
    """The members with a few of their bytes, names and lengths changed."""
    changed = dict(members)
    for _ in range(rng.randrange(1, 4)):
        name = rng.choice(list(changed))
        data = bytearray(changed[name])
        kind = rng.randrange(6)
        place = rng.randrange(len(data) + 1)
        if kind == 0 and data:
            data[place % len(data)] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[place:place] = rng.randbytes(rng.randrange(1, 20))
        elif kind == 2:
            del data[place : place + rng.randrange(1, 20)]
        elif kind == 3:
            data[place:place] = data[: rng.randrange(1, 60)]
        elif kind == 4:
            other = rng.choice(
                [name.upper(), f"{name}x", name.replace("/", "//"), f"extra/{name}", "bytecode.pkl"]
            )
            changed[other] = changed.pop(name)
            continue
        else:
            digits = [at for at, byte in enumerate(data) if 48 <= byte < 58]
            if digits:
                data[rng.choice(digits)] = rng.choice(b"0123456789")
        changed[name] = bytes(data)
    return changed


def test_mutated_archives(tmp_path: Path) -> None:
    rng, accepted = random.Random(13), 0
    starts = [
        members_of(tmp_path),
        {"data.pkl": PLAIN_STATE, "version": b"3", "code/__torch__.py": PLAIN.encode()},
    ]
    starts[1]["constants.pkl"] = b"\x80\x02)."
    with nothing_happens(tmp_path):
        for _ in range(count(100_000)):
            accepted += loaded(sealed(tmp_path, mutated(rng.choice(starts), rng)))
    print(f"{accepted} of {count(100_000)} were loaded")
