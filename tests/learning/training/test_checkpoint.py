from __future__ import annotations

import numpy as np
import pytest

from robobt.learning.training.checkpoint import CheckpointError, load, load_latest, previous, save

ARRAYS = {"weights": np.arange(100, dtype=np.float32).reshape(10, 10), "empty": np.zeros((0, 3))}
PLAIN = {"steps": 7, "rng": {"state": 2**127 + 1}, "best": None}


def test_what_was_saved_is_loaded(tmp_path):
    save(tmp_path / "c", ARRAYS, PLAIN)
    arrays, plain = load(tmp_path / "c")
    assert plain == PLAIN
    assert arrays.keys() == ARRAYS.keys()
    for name, array in ARRAYS.items():
        assert arrays[name].dtype == array.dtype
        assert np.array_equal(arrays[name], array)


def test_the_one_before_is_kept_and_no_temporary_file_is_left(tmp_path):
    for steps in (1, 2, 3):
        save(tmp_path / "c", ARRAYS, {"steps": steps})
    assert load(tmp_path / "c")[1]["steps"] == 3
    assert load(previous(tmp_path / "c"))[1]["steps"] == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["c", "c.previous"]


def test_every_damage_is_noticed(tmp_path):
    save(tmp_path / "c", ARRAYS, PLAIN)
    sound = (tmp_path / "c").read_bytes()
    rng = np.random.default_rng(0)
    for _ in range(200):
        damaged = bytearray(sound)
        if rng.random() < 0.5:
            damaged = damaged[: rng.integers(0, len(sound))]
        else:
            damaged[rng.integers(0, len(sound))] ^= 1 << rng.integers(0, 8)
        (tmp_path / "c").write_bytes(damaged)
        with pytest.raises(CheckpointError, match=r"c: (damaged or cut short|not a checkpoint)"):
            load(tmp_path / "c")


def test_a_damaged_checkpoint_falls_back_on_the_one_before(tmp_path):
    save(tmp_path / "c", ARRAYS, {"steps": 1})
    save(tmp_path / "c", ARRAYS, {"steps": 2})
    assert load_latest(tmp_path / "c")[1:] == ({"steps": 2}, None)
    (tmp_path / "c").write_bytes((tmp_path / "c").read_bytes()[:50])
    _, plain, problem = load_latest(tmp_path / "c")
    assert plain == {"steps": 1}
    assert problem is not None
    assert "damaged" in problem
    (tmp_path / "c").unlink()
    assert load_latest(tmp_path / "c")[1] == {"steps": 1}


def test_with_neither_the_newest_is_named(tmp_path):
    with pytest.raises(CheckpointError, match="c: cannot be read"):
        load_latest(tmp_path / "c")
