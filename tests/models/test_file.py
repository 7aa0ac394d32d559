"""Model files are read as bytes, and whatever is wrong with one is a line that names it."""

from __future__ import annotations

import io
import os
import zipfile
from hashlib import sha256
from pathlib import Path

import onnx
import pytest
import torch

from robobt.models import file as model_file
from robobt.models import find
from robobt.models.file import (
    MANIFEST,
    ModelError,
    UnknownModelError,
    manifest_text,
    read_manifest,
    read_model_file,
)
from robobt.models.find import find_model, list_models
from tests.models.made_models import go_to_ball_card, network, write_model


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("models")
    write_model(folder, formats=("torchscript", "onnx"))
    return folder


def put(folder: Path, data: bytes, name: str = "other.pt") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def rezipped(data: bytes, change: dict[str, bytes], comment: bytes | None = None) -> bytes:
    """The archive with some members replaced, its CRCs in order."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(buffer, "w") as new:
        for name in old.namelist():
            new.writestr(name, change.get(name, old.read(name)))
        new.comment = old.comment if comment is None else comment
    return buffer.getvalue()


@pytest.mark.parametrize("name", ["small.pt", "small.onnx"])
def test_an_intact_file_is_read_with_its_card(folder: Path, name: str) -> None:
    file = read_model_file(folder / name)
    assert file.card.model_copy(update={"payload": ""}) == go_to_ball_card()
    assert file.format == ("torchscript" if name.endswith(".pt") else "onnx")
    assert file.sha256 == sha256((folder / name).read_bytes()).hexdigest()
    assert file.size == (folder / name).stat().st_size


def test_the_format_is_told_by_the_content_not_by_the_name(folder: Path, tmp_path: Path) -> None:
    swapped = put(tmp_path, (folder / "small.onnx").read_bytes(), "small.pt")
    assert read_model_file(swapped).format == "onnx"


def test_other_tools_read_the_files_too(folder: Path) -> None:
    model = onnx.load(folder / "small.onnx")
    onnx.checker.check_model(model)
    assert [one.key for one in model.metadata_props] == ["card.json", "sha256"]
    extra = {"card.json": ""}
    loaded = torch.jit.load(folder / "small.pt", _extra_files=extra)
    assert loaded(torch.zeros(2, 6)).shape == (2, 3)
    assert "GoToBall" in str(extra["card.json"])


def test_what_lies_in_the_files_says_nothing_of_the_machine(folder: Path) -> None:
    for path in list_models(folder):
        data = path.read_bytes()
        assert str(Path(__file__).parent.parent.parent).encode() not in data


@pytest.mark.parametrize("name", ["small.pt", "small.onnx"])
def test_every_flipped_bit_of_the_first_and_last_bytes_is_noticed(
    folder: Path, tmp_path: Path, name: str
) -> None:
    data = (folder / name).read_bytes()
    for place in [*range(150), *range(len(data) - 250, len(data))]:
        broken = bytearray(data)
        broken[place] ^= 1 << (place % 8)
        with pytest.raises(ModelError, match=r"other\.pt"):
            read_model_file(put(tmp_path, bytes(broken)))


@pytest.mark.parametrize("name", ["small.pt", "small.onnx"])
@pytest.mark.parametrize("share", [0.0, 0.001, 0.1, 0.5, 0.9, 0.999])
def test_a_file_that_was_cut_is_refused(folder: Path, tmp_path: Path, name: str, share: float) -> None:
    data = (folder / name).read_bytes()
    with pytest.raises(ModelError, match=r"other\.pt"):
        read_model_file(put(tmp_path, data[: int(len(data) * share)]))


def test_another_card_does_not_pass_for_the_files_own(folder: Path, tmp_path: Path) -> None:
    data = (folder / "small.pt").read_bytes()
    card = read_model_file(folder / "small.pt").card
    wrong = card.model_copy(update={"skill": "Shoot"}).to_json().encode()
    with pytest.raises(ModelError, match="altered"):
        read_model_file(put(tmp_path, rezipped(data, {"model/extra/card.json": wrong})))


def test_a_card_does_not_vouch_for_another_network(folder: Path, tmp_path: Path) -> None:
    card = read_model_file(folder / "small.pt").card.to_json()
    other = write_model(tmp_path, network(seed=1), go_to_ball_card("second"))
    members = model_file.unpack_archive(other.read_bytes())
    del members["extra/card.json"]
    with pytest.raises(ModelError, match="not what its card was written for"):
        read_model_file(put(tmp_path, model_file.pack_archive(members, card)))


def test_an_archive_without_a_card_says_what_writes_one(tmp_path: Path) -> None:
    path = tmp_path / "plain.pt"
    torch.jit.save(torch.jit.trace(network(), torch.zeros(1, 6)), path)
    with pytest.raises(ModelError, match="no model card in it"):
        read_model_file(path)


def test_an_archive_that_torch_wrote_with_a_card_is_a_model_file(tmp_path: Path) -> None:
    path = tmp_path / "own.pt"
    extra = {"card.json": go_to_ball_card("own").to_json()}
    torch.jit.save(torch.jit.trace(network(), torch.zeros(1, 6)), path, _extra_files=extra)
    assert read_model_file(path).card == go_to_ball_card("own")


def foreign() -> dict[str, bytes]:
    weights = io.BytesIO()
    torch.save(network().state_dict(), weights)
    text = io.BytesIO()
    with zipfile.ZipFile(text, "w") as archive:
        archive.writestr("hello.txt", "hello")
    nothing = io.BytesIO()
    with zipfile.ZipFile(nothing, "w"):
        pass
    outside = io.BytesIO()
    with zipfile.ZipFile(outside, "w") as archive:
        for name in ("m/data.pkl", "m/version", "m/code/a.py", "m/../../up"):
            archive.writestr(name, "")
    return {
        "weights": weights.getvalue(),
        "text": text.getvalue(),
        "empty archive": nothing.getvalue(),
        "outside": outside.getvalue(),
        "nothing": b"",
        "words": b"hello",
        "pickle": b"cos\nsystem\n(S'exit 1'\ntR.",
        "gzip": b"\x1f\x8b\x08\x00" + bytes(100),
        "zeros": bytes(1000),
        "long varint": b"\xff" * 100,
        "many fields": b"\x08\x01" * 100_000,
    }


@pytest.mark.parametrize("what", list(foreign()))
def test_foreign_files_are_refused(tmp_path: Path, what: str) -> None:
    with pytest.raises(ModelError, match=r"other\.pt"):
        read_model_file(put(tmp_path, foreign()[what]))
    # And so they are with a seal as if they had been exported.
    data = foreign()[what]
    with pytest.raises(ModelError, match=r"other\.pt"):
        read_model_file(put(tmp_path, data + sha256(data).hexdigest().encode()))


def test_an_archive_that_unpacks_to_too_much_is_not_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("data.pkl", "version", "code/a.py"):
            archive.writestr(f"m/{name}", bytes(model_file.MAX_MODEL_SIZE // 2))
    assert len(buffer.getvalue()) < 100_000
    monkeypatch.setattr(zipfile.ZipFile, "read", lambda *_: pytest.fail("it was unpacked"))
    with pytest.raises(ModelError, match="more than a model does"):
        read_model_file(put(tmp_path, buffer.getvalue()))


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.pt"
    with path.open("wb") as stream:
        stream.truncate(model_file.MAX_MODEL_SIZE + 1)
    with pytest.raises(ModelError, match="larger"):
        read_model_file(path)


def test_what_is_no_file_is_refused_without_opening_it(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.pt")
    for name, said in (("pipe.pt", "is no file"), (".", "is no file"), ("none.pt", "no such file")):
        with pytest.raises(ModelError, match=said):
            read_model_file(tmp_path / name)


def test_the_manifest_lists_what_was_exported_and_sha256sum_reads_it(folder: Path) -> None:
    listed = read_manifest(folder)
    assert {name: sha256((folder / name).read_bytes()).hexdigest() for name in listed} == listed
    assert set(listed) == {"small.pt", "small.onnx"}
    assert (folder / MANIFEST).read_text() == manifest_text(listed)


def test_a_listed_file_has_to_be_the_one_that_is_listed(tmp_path: Path) -> None:
    path = write_model(tmp_path)
    other = write_model(tmp_path / "other", network(seed=1))
    path.write_bytes(other.read_bytes())
    with pytest.raises(ModelError, match="manifest"):
        read_model_file(path)
    assert read_model_file(other).card.name == "small"


@pytest.mark.parametrize(
    "line", ["small.pt", "12  small.pt", f"{'0' * 64}  ../small.pt", f"{'0' * 64}small.pt"]
)
def test_a_manifest_that_is_none_is_an_error_with_its_line(tmp_path: Path, line: str) -> None:
    path = write_model(tmp_path)
    (tmp_path / MANIFEST).write_text(f"\n{line}\n")
    with pytest.raises(ModelError, match="manifest, line 2"):
        read_model_file(path)


def test_names_are_those_of_installed_models(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(find, "models_folder", lambda: folder)
    assert find_model("small") == folder / "small.pt"
    assert find_model("a/b.pt") == Path("a/b.pt")
    assert find_model(Path("small")) == Path("small")
    with pytest.raises(UnknownModelError, match=r"'big'.*small"):
        find_model("big")


def test_a_file_that_is_there_and_no_model_is_called_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("README.md").write_text("words")
    with pytest.raises(
        ModelError, match=r"^'README\.md' is not a model file: model files end in \.pt or \.onnx$"
    ):
        find_model("README.md")
    Path("words.onnx").write_text("words")
    with pytest.raises(ModelError, match="is not a robobt model file, or is damaged"):
        read_model_file("words.onnx")
