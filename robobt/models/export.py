"""Write a trained network as a model file that :func:`robobt.models.policy.load_policy` loads."""

from __future__ import annotations

import copy
import inspect
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from hashlib import sha256
from io import BytesIO
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from robobt.config.atomic import replacing
from robobt.config.errors import naming
from robobt.models.card import MAX_CARD_SIZE, Measured, ModelCard
from robobt.models.file import (
    MANIFEST,
    SUFFIXES,
    Format,
    ModelError,
    ModelFile,
    manifest_text,
    pack_archive,
    pack_onnx,
    payload_of,
    read_manifest,
    read_model_file,
    unpack_archive,
)
from robobt.models.policy import load_policy, quiet

MAX_EXPORT_SIZE = 2**20
"""A skill's network is small; a file longer than this is a mistake [bytes]."""

EXPORT_TOLERANCE = 1e-5
"""Largest difference of any output between a TorchScript file and its network.

Sums in single precision in another order differ by up to 3e-6 in a network over 21 robots.
"""

_ONNX_ROUNDING = 1e-5
"""Largest difference for ONNX, as a share of the largest output."""
_COMPARED_INPUTS = 1000
_MANGLED = re.compile(rb"\.___torch_mangle_\d+")


def export_model(
    module: nn.Module,
    card: ModelCard,
    folder: Path,
    formats: Sequence[Format] = ("torchscript",),
    force: bool = False,
) -> tuple[Path, ...]:
    """Write ``module`` as ``NAME.pt`` or ``NAME.onnx``, NAME being the card's, and enter it in the manifest.

    The module takes float32 (batch, ``card.observation.size``), the raw
    observation in SI units, and answers (batch, ``len(card.outputs)``): actions in
    [-1, 1], or probabilities. Each file is loaded again before it takes its place,
    and its answers to 1000 random inputs are compared with the module's: to 1e-5, in
    ONNX of the largest answer, because they may add up in another order. The same
    module and card give the same file.

    Args:
        module: the network, which stays unchanged; a copy is put into evaluation mode.
        card: its card, without ``payload``, which is filled in here.
        folder: folder to write to; made when it is missing.
        formats: "torchscript", "onnx" or both.
        force: whether files that are there already may be replaced.

    Returns:
        The files, in the order of ``formats``.

    Raises:
        ModelError: a file is there already, the module does not fit its card, its outputs leave
            their range, it is larger than 1 MB, or the file's outputs would differ from its own.
            If one of two formats fails, the other is still written.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    listed = read_manifest(folder)
    module = _copy(module)
    files = [folder / f"{card.name}{SUFFIXES[format_]}" for format_ in formats]
    for path in files:
        refuse_to_replace(path, force)
    problems: list[ModelError] = []
    written: list[Path] = []
    for format_, path in zip(formats, files, strict=True):
        try:
            data = _data(module, card, format_, path)
            with _written(path, data) as temporary:
                _compare(module, card, format_, temporary, path)
        except ModelError as error:
            problems.append(error)
            continue
        written.append(path)
        listed[path.name] = sha256(data).hexdigest()
        with _written(folder / MANIFEST, manifest_text(listed).encode()):
            pass
    if problems:
        told = f"; written all the same: {', '.join(map(str, written))}" if written else ""
        raise ModelError(f"{problems[0]}{told}") from problems[0]
    return tuple(files)


def read_amendable(path: Path) -> ModelFile:
    """Read a model to whose card figures can be added; call this before long work as well.

    Args:
        path: the model's file.

    Raises:
        ModelError: the file cannot be read, or is no TorchScript model.
    """
    file = read_model_file(path)
    if file.format != "torchscript":
        raise ModelError(f"{path}: figures are added to TorchScript models only")
    return file


def add_figures(path: Path, figures: Mapping[str, Measured]) -> None:
    """Add figures to those on the card of a TorchScript model, and enter the file again in the manifest.

    Args:
        path: the model's file.
        figures: by name; one that the card has is replaced.

    Raises:
        ModelError: it is no TorchScript model, or the card grows too long.
    """
    file = read_amendable(path)
    card = file.card.model_copy(update={"held_out": {**file.card.held_out, **figures}})
    text = card.to_json()
    if len(text) > MAX_CARD_SIZE:
        raise ModelError(f"{path}: its card would be {len(text)} bytes, more than {MAX_CARD_SIZE}")
    data = pack_archive(unpack_archive(file.content), text)
    listed = {**read_manifest(path.parent), path.name: sha256(data).hexdigest()}
    for written, content in ((path, data), (path.parent / MANIFEST, manifest_text(listed).encode())):
        with _written(written, content):
            pass


def refuse_to_replace(path: Path, force: bool) -> None:
    """Refuse to replace an existing model without ``force``; call this before long work as well.

    Raises:
        ModelError: the file is there.
    """
    if path.exists() and not force:
        raise ModelError(f"{path}: is there already; force replaces it (--force), or choose another name")


def _data(module: nn.Module, card: ModelCard, format_: Format, path: Path) -> bytes:
    try:
        data = _torchscript(module, card) if format_ == "torchscript" else _onnx(module, card)
    except (RuntimeError, TypeError) as error:
        reason = next(iter(str(error).strip().splitlines()), type(error).__name__)
        raise ModelError(f"{path}: torch cannot export the network: {reason}") from error
    if len(data) > MAX_EXPORT_SIZE:
        raise ModelError(f"{path}: would be {len(data)} bytes, more than {MAX_EXPORT_SIZE}")
    return data


def _copy(module: nn.Module) -> nn.Module:
    if not isinstance(module, torch.jit.ScriptModule):
        return copy.deepcopy(module).cpu().eval()
    # A deep copy of these has tensors that torch warns of.
    buffer = BytesIO()
    with quiet():
        torch.jit.save(module, buffer)
        buffer.seek(0)
        loaded: nn.Module = torch.jit.load(buffer, map_location="cpu")  # type: ignore[no-untyped-call]
    return loaded.eval()


def _torchscript(module: nn.Module, card: ModelCard) -> bytes:
    buffer = BytesIO()
    with quiet():
        scripted = module if isinstance(module, torch.jit.ScriptModule) else _traced(module, card)
        torch.jit.save(torch.jit.freeze(scripted), buffer)
    members = unpack_archive(buffer.getvalue())
    # Torch numbers what it traces by what else the process has traced.
    if len([name for name in members if name.startswith("code/")]) == 1:
        members = {
            re.sub(r"/___torch_mangle_\d+", "", name): _MANGLED.sub(b"", content)
            if name.endswith((".py", ".pkl"))
            else content
            for name, content in members.items()
        }
    return pack_archive(members, card.model_copy(update={"payload": payload_of(members)}).to_json())


def _traced(module: nn.Module, card: ModelCard) -> torch.jit.ScriptModule:
    example = torch.from_numpy(_inputs(card, 2))
    traced = torch.jit.trace(module, example, check_trace=False)  # type: ignore[no-untyped-call]
    assert isinstance(traced, torch.jit.ScriptModule)
    return traced


def _onnx(module: nn.Module, card: ModelCard) -> bytes:
    import onnx

    buffer = BytesIO()
    options: dict[str, object] = {
        "input_names": ["observation"],
        "output_names": ["output"],
        "dynamic_axes": {"observation": {0: "batch"}, "output": {0: "batch"}},
        "opset_version": 17,
    }
    # The exporter that is torch's default from 2.9 on needs a package of its own.
    if "dynamo" in inspect.signature(torch.onnx.export).parameters:
        options["dynamo"] = False
    with quiet():
        torch.onnx.export(module, (torch.from_numpy(_inputs(card, 2)),), buffer, **options)  # type: ignore[arg-type]
    model = onnx.load_from_string(buffer.getvalue())
    del model.metadata_props[:]
    for node in model.graph.node:
        node.doc_string = ""
        del node.metadata_props[:]
    content = model.SerializeToString(deterministic=True)
    text = card.model_copy(update={"payload": sha256(content).hexdigest()}).to_json()
    return pack_onnx(content, text)


def _compare(module: nn.Module, card: ModelCard, format_: Format, written: Path, path: Path) -> None:
    try:
        policy = load_policy(written)
    except ModelError as error:
        raise ModelError(str(error).replace(str(written), str(path))) from error
    inputs = torch.from_numpy(_inputs(card, _COMPARED_INPUTS))
    with torch.no_grad():
        expected: Tensor = module(inputs)
    # Another runtime adds up in another order.
    allowed = EXPORT_TOLERANCE if format_ == "torchscript" else _ONNX_ROUNDING * float(expected.abs().max())
    off = float(np.abs(policy(inputs.numpy()) - expected.numpy()).max())
    if not off <= allowed:
        raise ModelError(f"{path}: the file's answers are {off:.2g} off those of the network")


def _inputs(card: ModelCard, count: int) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    return np.random.default_rng(0).normal(0.0, 2.0, (count, card.observation.size)).astype(np.float32)


@contextmanager
def _written(path: Path, data: bytes) -> Iterator[Path]:
    """Write the data beside the file; it takes its place unless something is raised."""
    with replacing(path) as temporary:
        with naming(path):
            temporary.write_bytes(data)
        yield temporary
