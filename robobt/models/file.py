"""Model files, read and checked as bytes before anything that could run them sees them.

A model file is a TorchScript archive or an ONNX file that carries its
:class:`~robobt.models.card.ModelCard`. The last 64 bytes of either, an
archive's comment or a piece of ONNX's metadata, are the SHA-256 of all before them,
and the card carries that of the network: a file that was truncated or altered anywhere is refused here,
without torch or onnxruntime. An archive written by torch itself, with a card among its extra files, has no
such seal; there the members' CRCs are checked.
"""

from __future__ import annotations

import re
import stat
import time
import zipfile
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Literal

from robobt.config.errors import RobobtError, one_line
from robobt.models.card import ModelCard, read_card
from robobt.models.protobuf import field, fields

Format = Literal["torchscript", "onnx"]

SUFFIXES: dict[Format, str] = {"torchscript": ".pt", "onnx": ".onnx"}
"""How the names of model files end, the preferred format first."""

MANIFEST = "manifest"
"""The file beside models that lists their checksums, as ``sha256sum`` writes it."""

MAX_MODEL_SIZE = 16 * 2**20
"""A file longer than this is not read, and an archive that holds more is not unpacked [bytes]."""

CARD = "card.json"
"""Under this name the card is in the file."""

_RECENT = 1_000_000_000
"""A file that was changed less than this ago may change again without its time telling [ns]."""
_SEAL = 64
_MAX_MEMBERS = 1000
_ZIP = b"PK\x03\x04"
_CARD_MEMBER = f"extra/{CARD}"
_METADATA = 14
"""Field ``metadata_props`` of ONNX's ModelProto."""


class ModelError(RobobtError, ValueError):
    """A model cannot be used; the message is one line that names the file."""


class UnknownModelError(ModelError):
    """No model has this name."""


@dataclass(frozen=True)
class ModelFile:
    """A model file with a valid card and checksums.

    Attributes:
        path: the file.
        format: format of the network.
        sha256: checksum of the whole file.
        size: size of the whole file [bytes].
        card: the model's card.
        content: the network without the card, as passed to torch or onnxruntime. A TorchScript archive is
            packed again from its checked parts, so that nothing else of the file is passed on.
    """

    path: Path
    format: Format
    sha256: str
    size: int
    card: ModelCard
    content: bytes


def read_model_file(path: str | Path) -> ModelFile:
    """Read a model file and check everything that can be checked without running it.

    A file that has not changed is read once per process.

    Raises:
        ModelError: it is missing, too large, no model file, truncated, altered, without a valid card, or not
        the file that the manifest beside it lists.
    """
    path = Path(path)
    return _checked(path, _state_of(path), _state_of(path.parent / MANIFEST))


@lru_cache(maxsize=32)
def _checked(path: Path, _state: Hashable, _manifest: Hashable) -> ModelFile:
    data = _read(path)
    checksum = sha256(data).hexdigest()
    listed = read_manifest(path.parent).get(path.name)
    if listed is not None and listed != checksum:
        raise ModelError(f"{path}: its checksum is not the one that {path.parent / MANIFEST} lists")
    sealed = data[-_SEAL:] == _seal_of(data[:-_SEAL])
    try:
        if data.startswith(_ZIP):
            kind: Format = "torchscript"
            members = unpack_archive(data)
            text = members.pop(_CARD_MEMBER, None)
            digest, content = payload_of(members), pack_archive(members)
        elif sealed:
            kind = "onnx"
            content, text = _split_onnx(data)
            digest = sha256(content).hexdigest()
        else:
            raise ModelError("is not a robobt model file, or is damaged")
        if text is None:
            raise ModelError("there is no model card in it; robobt export writes files with one")
        card = read_card(text)
        if not sealed and (card.payload or kind == "onnx"):
            raise ModelError("has been altered since it was exported")
        if sealed and card.payload != digest:
            raise ModelError("its content is not what its card was written for")
    except ValueError as error:
        raise ModelError(f"{path}: {one_line(str(error), 400)}") from error
    return ModelFile(path, kind, checksum, len(data), card, content)


def read_manifest(folder: Path) -> dict[str, str]:
    """Return the SHA-256 by file name that a folder's manifest lists; empty where there is none.

    Raises:
        ModelError: a line is not a checksum with a file's name.
    """
    path = folder / MANIFEST
    try:
        if not path.is_file():
            return {}
        lines = path.read_text("utf-8").splitlines()
    except (OSError, ValueError) as error:
        raise ModelError(f"{path}: {error}") from error
    listed: dict[str, str] = {}
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        match = _LISTED.fullmatch(line)
        if match is None:
            raise ModelError(f"{path}, line {number}: is no SHA-256 followed by the name of a file")
        listed[match[2]] = match[1]
    return listed


def manifest_text(listed: Mapping[str, str]) -> str:
    """Return the manifest that lists these files; ``sha256sum -c manifest`` checks them."""
    return "".join([f"{listed[name]}  {name}\n" for name in sorted(listed)])


def payload_of(members: Mapping[str, bytes]) -> str:
    """Return the SHA-256 of an archive's members, whatever their order [hex]."""
    digest = sha256()
    for name in sorted(members):
        for part in (name.encode(), members[name]):
            digest.update(len(part).to_bytes(8, "big"))
            digest.update(part)
    return digest.hexdigest()


def pack_archive(members: Mapping[str, bytes], card: str | None = None) -> bytes:
    """Pack an archive as torch reads it, the same bytes for the same members.

    A card makes it a model file: it is put in, and the whole is sealed.
    """
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for name in sorted(members):
            archive.writestr(zipfile.ZipInfo(f"model/{name}"), members[name])
        if card is not None:
            archive.writestr(zipfile.ZipInfo(f"model/{_CARD_MEMBER}"), card)
            archive.comment = bytes(_SEAL)
    data = buffer.getvalue()
    return data if card is None else data[:-_SEAL] + _seal_of(data[:-_SEAL])


def unpack_archive(data: bytes) -> dict[str, bytes]:
    """Return the members of an archive that torch wrote, without the folder that holds them.

    What only serves debugging is left out, such as where the network's source lay.

    Raises:
        ModelError: it is no such archive, damaged, or unpacks to too much.
    """
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            entries = archive.infolist()
            if len(entries) > _MAX_MEMBERS or sum([entry.file_size for entry in entries]) > MAX_MODEL_SIZE:
                raise ModelError("holds more than a model does")
            # Reading a member to its end compares its CRC.
            found = [(entry.filename, archive.read(entry)) for entry in entries]
    except ModelError:
        raise
    except Exception as error:
        # zipfile answers damage with a dozen kinds of exceptions, struct's and zlib's among them.
        # Some quote the file itself.
        found_wrong = f"{type(error).__name__}: {str(error)[:80]}"
        raise ModelError(f"is damaged or incomplete ({found_wrong}); copy or export it again") from error
    roots = {name.partition("/")[0] for name, _ in found}
    members = {name.partition("/")[2]: content for name, content in found}
    if len(roots) != 1 or not any(name.startswith("code/") for name in members):
        raise ModelError("is an archive, but not a TorchScript one")
    # Torch takes names that differ in case for the same, and of two the first or the last.
    if len({name.casefold() for name in members}) != len(found):
        raise ModelError("has two members of the same name in it")
    foreign = [name for name in members if not (_NEEDED.fullmatch(name) or _UNNEEDED.fullmatch(name))]
    if foreign:
        raise ModelError(f"has a member in it that torch does not write: {foreign[0][:80]!r}")
    if "data.pkl" not in members or len({"version", ".data/version"} & set(members)) != 1:
        raise ModelError("is an archive, but not a TorchScript one")
    return {name: content for name, content in members.items() if _NEEDED.fullmatch(name)}


def pack_onnx(content: bytes, card: str) -> bytes:
    """Make an ONNX file a model file: card and seal become its last metadata."""
    carded = content + _metadata(CARD, card.encode())
    unsealed = carded + _metadata("sha256", bytes(_SEAL))[:-_SEAL]
    return unsealed + _seal_of(unsealed)


def _state_of(path: Path) -> Hashable:
    """Return what differs between two states of a file; a new object if that is unknown."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    except (OSError, ValueError):
        return object()
    changed = max(status.st_mtime_ns, status.st_ctime_ns)
    if time.time_ns() - changed < _RECENT:
        return object()
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def _read(path: Path) -> bytes:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise ModelError(f"{path}: is no file")
        if status.st_size > MAX_MODEL_SIZE:
            raise ModelError(f"{path}: is larger than {MAX_MODEL_SIZE} bytes")
        with path.open("rb") as stream:
            data = stream.read(MAX_MODEL_SIZE + 1)
    except FileNotFoundError as error:
        raise ModelError(f"{path}: there is no such file") from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise ModelError(f"{path}: cannot be read: {reason}") from error
    if len(data) > MAX_MODEL_SIZE:
        raise ModelError(f"{path}: is larger than {MAX_MODEL_SIZE} bytes")
    if not data:
        raise ModelError(f"{path}: is empty")
    return data


def _split_onnx(data: bytes) -> tuple[bytes, bytes | None]:
    """Return what precedes the card, and the card, which has only the seal behind it."""
    last = list(fields(data))[-2:]
    if len(last) < 2 or last[0][0] != _METADATA:
        return data, None
    entries = [(number, content) for number, _, content in fields(last[0][2])]
    if len(entries) != 2 or entries[0] != (1, CARD.encode()) or entries[1][0] != 2:
        return data, None
    return data[: last[0][1]], entries[1][1]


def _metadata(key: str, value: bytes) -> bytes:
    return field(_METADATA, field(1, key.encode()) + field(2, value))


def _seal_of(data: bytes) -> bytes:
    return sha256(data).hexdigest().encode()


_NEEDED = re.compile(
    r"code/__torch__(/\w+)*\.py|(data|constants)\.pkl|(data|constants)/\d+|(\.data/)?version|byteorder"
    rf"|{re.escape(_CARD_MEMBER)}",
    re.ASCII,
)
"""The members of an archive that torch reads, and the card."""
_UNNEEDED = re.compile(
    r"code/__torch__(/\w+)*\.py\.debug_pkl|\.data/serialization_id|\.format_version|\.storage_alignment"
    r"|traced_inputs(\.pkl|/\d+)|extra/[\w.]+",
    re.ASCII,
)
"""Members that only serve debugging, or whoever saved the file; they are left out."""
_LISTED = re.compile(r"([0-9a-f]{64}) [ *]([^/\\\s][^/\\]*)")
