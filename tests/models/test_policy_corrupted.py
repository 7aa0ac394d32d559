"""Whatever happens to a model file, loading it is a clear error: never a crash, never a hang."""

from __future__ import annotations

import io
import os
import tarfile
import zipfile
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
import torch

from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from tests.models.made_models import go_to_ball_card, network, shoot_card, write_model

KINDS = (
    "truncated",
    "one bit",
    "some bits",
    "bytes",
    "block of zeros",
    "block moved",
    "block lost",
    "something before",
    "something after",
    "wrong card",
    "card's text",
    "another archive",
    "random",
)


@pytest.fixture(scope="module")
def originals(tmp_path_factory: pytest.TempPathFactory) -> list[bytes]:
    folder = tmp_path_factory.mktemp("models")
    write_model(folder, formats=("torchscript", "onnx"))
    by_torch = folder / "by_torch.pt"
    extra = {"card.json": go_to_ball_card("by_torch").to_json()}
    torch.jit.save(torch.jit.trace(network(), torch.zeros(1, 6)), by_torch, _extra_files=extra)
    return [path.read_bytes() for path in (folder / "small.pt", folder / "small.onnx", by_torch)]


def corrupted(kind: str, originals: list[bytes], rng: np.random.Generator) -> bytes:
    """Sealed files in TorchScript and ONNX with something wrong; never the original."""
    data = bytearray(originals[rng.integers(2)])
    size = len(data)
    place = int(rng.integers(size))
    block = int(rng.integers(1, size // 4))
    if kind == "truncated":
        return bytes(data[:place])
    if kind in ("one bit", "some bits"):
        for _ in range(1 if kind == "one bit" else int(rng.integers(1, 200))):
            data[int(rng.integers(size))] ^= 1 << int(rng.integers(8))
    elif kind == "bytes":
        data[place : place + block] = rng.bytes(len(data[place : place + block]))
    elif kind == "block of zeros":
        data[place : place + block] = bytes(len(data[place : place + block]))
    elif kind == "block moved":
        cut = data[place : place + block]
        del data[place : place + block]
        data = cut + data
    elif kind == "block lost":
        del data[place : place + block]
    elif kind == "something before":
        data = bytearray(rng.bytes(int(rng.integers(1, 300)))) + data
    elif kind == "something after":
        data += rng.bytes(int(rng.integers(1, 300)))
    elif kind == "wrong card":
        return other_card(originals[0], rng)
    elif kind == "card's text":
        words = [b'"GoToBall"', b'"version": 1', b'"size": 6', b'"max_speed": 1.5', b'"period": 0.03']
        word = words[rng.integers(len(words))]
        at = data.index(word)
        data[at + int(rng.integers(len(word)))] ^= 1 << int(rng.integers(8))
    elif kind == "another archive":
        return other_archive(rng)
    elif kind == "random":
        start = (b"", b"PK\x03\x04", b"\x08\x08\x12\x07pytorch", b"\x80\x02", b"\x1f\x8b")[rng.integers(5)]
        return start + rng.bytes(int(rng.integers(0, 5000)))
    if bytes(data) in originals:
        # Zeros over zeros, or a block moved to where it was.
        data[place] ^= 1
    return bytes(data)


def other_card(data: bytes, rng: np.random.Generator) -> bytes:
    """The archive with a card that is not its own, all CRCs in order."""
    observation = go_to_ball_card().observation
    cards = [
        shoot_card().to_json(),
        go_to_ball_card(observation=observation.model_copy(update={"version": 2})).to_json(),
        go_to_ball_card("other").to_json()[: int(rng.integers(1, 400))],
        rng.bytes(int(rng.integers(0, 400))),
        "[" * int(rng.integers(1, 60_000)),
        '{"kind": "policy", "name": 3}',
    ]
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(buffer, "w") as new:
        for name in old.namelist():
            if not name.endswith("card.json"):
                new.writestr(name, old.read(name))
        if rng.integers(8):
            new.writestr("model/extra/card.json", cards[rng.integers(len(cards))])
        new.comment = old.comment
    return buffer.getvalue()


def other_archive(rng: np.random.Generator) -> bytes:
    buffer = io.BytesIO()
    which = rng.integers(4)
    if which == 0:
        torch.save({"weights": torch.rand(int(rng.integers(1, 50)))}, buffer)
    elif which == 1:
        np.savez(buffer, weights=rng.normal(size=int(rng.integers(1, 50))))
    elif which == 2:
        with tarfile.open(fileobj=buffer, mode="w:gz") as archive:
            archive.addfile(tarfile.TarInfo("data.pkl"))
    else:
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as zipped:
            for name in ("m/data.pkl", "m/version", "m/code/__torch__/a.py", "m/extra/card.json"):
                zipped.writestr(name, rng.bytes(int(rng.integers(0, 300))))
    return buffer.getvalue()


def refused(path: Path, data: bytes) -> str:
    path.write_bytes(data)
    with pytest.raises(ModelError) as caught:
        load_policy(path)
    said = str(caught.value)
    assert said.startswith(f"{path}: ")
    assert "\n" not in said
    assert len(said) < 1000
    return said


@pytest.mark.parametrize("kind", KINDS)
def test_a_corrupted_file_is_a_clear_error(kind: str, originals: list[bytes], tmp_path: Path) -> None:
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(20):
        refused(tmp_path / "model.pt", corrupted(kind, originals, rng))


@pytest.mark.slow
def test_ten_thousand_corrupted_files_are_clear_errors(originals: list[bytes], tmp_path: Path) -> None:
    rng = np.random.default_rng(2026)
    said = set()
    for number in range(10_000):
        kind = KINDS[number % len(KINDS)]
        said.add(refused(tmp_path / "model.pt", corrupted(kind, originals, rng)))
    assert len(said) > 10


def flipped(original: bytes, rng: np.random.Generator) -> bytes:
    data = bytearray(original)
    for _ in range(int(rng.integers(1, 4))):
        data[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
    return bytes(data)


def resealed(data: bytes) -> bytes:
    return data[:-64] + sha256(data[:-64]).hexdigest().encode()


@pytest.mark.integration
@pytest.mark.parametrize("which", ["sealed anew in TorchScript", "sealed anew in ONNX", "written by torch"])
@pytest.mark.parametrize(
    "count", [200, pytest.param(5_000, marks=pytest.mark.slow)], ids=["some", "five thousand"]
)
def test_without_a_seal_of_its_own_a_file_is_refused_or_unharmed(
    count: int, which: str, originals: list[bytes], tmp_path: Path
) -> None:
    # A bit of the archive's dates and the like may flip unnoticed, no other.
    rng = np.random.default_rng(7)
    path = tmp_path / "model.pt"
    original = originals[
        ["sealed anew in TorchScript", "sealed anew in ONNX", "written by torch"].index(which)
    ]
    path.write_bytes(original)
    inputs = rng.normal(size=(20, 6))
    wanted = load_policy(path)(inputs)
    refusals = 0
    for _ in range(count):
        changed = flipped(original, rng)
        path.write_bytes(changed if which == "written by torch" else resealed(changed))
        try:
            loaded = load_policy(path)
        except ModelError:
            refusals += 1
        else:
            assert np.array_equal(loaded(inputs), wanted)
    assert refusals > 0.5 * count


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes here")
def test_a_pipe_that_nobody_writes_to_does_not_hang(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "model.pt")
    with pytest.raises(ModelError, match="is no file"):
        load_policy(tmp_path / "model.pt")
