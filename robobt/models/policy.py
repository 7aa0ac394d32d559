"""Trained models as functions of arrays; the one place where a skill meets torch."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.config.errors import one_line
from robobt.models.card import Kind, ModelCard
from robobt.models.checks.limits import LARGEST_BATCH
from robobt.models.checks.onnx_file import check_onnx
from robobt.models.checks.source import checked_members
from robobt.models.file import (
    Format,
    ModelError,
    ModelFile,
    pack_archive,
    unpack_archive,
)
from robobt.models.find import read_fitting_model
from robobt.world.features import ObservationSpec

if TYPE_CHECKING:
    from torch import Tensor

Floats = NDArray[np.float32]

_MOST_LOADED = 100
_ORDER = 1e-3
"""How far the order of summation may move an output in single precision."""
_OUTPUT_ROUNDING = 1e-4
"""How far an output may lie outside its range for the rounding of single precision."""


class Network(Protocol):
    """A loaded network, whatever its format."""

    def batch(self, inputs: Floats) -> Floats:
        """Map (n, size) to (n, outputs), in single precision."""

    def single(self) -> Callable[[ArrayLike], list[float]]:
        """Return a function of one observation; it has memory of its own, so it is not for two threads."""


class Policy:
    """A loaded model: a function of arrays, and the card that describes them."""

    def __init__(self, file: ModelFile, network: Network) -> None:
        self.card = file.card
        self.path = file.path
        self.sha256 = file.sha256
        self.network = network

    def __call__(self, inputs: ArrayLike) -> NDArray[np.float64]:
        """Return the outputs for an observation (size,) or for many (n, size) in SI units, shaped like them.

        Raises:
            ValueError: the inputs have the wrong shape.
            ModelError: the network fails on them; the message names the file and says why.
        """
        given = np.asarray(inputs, dtype=np.float32)
        size = self.card.observation.size
        if given.ndim not in (1, 2) or given.shape[-1] != size:
            raise ValueError(f"{self.card.name} takes ({size},) or (n, {size}), not {given.shape}")
        if not len(given):
            return np.zeros((0, len(self.card.outputs)))
        rows = np.ascontiguousarray(given.reshape(-1, size))
        with _telling(f"{self.path}: fails on an observation"):
            answers = self.network.batch(rows) if len(rows) == 1 else self._in_batches(rows)
        return answers.astype(np.float64).reshape(*given.shape[:-1], len(self.card.outputs))

    def _in_batches(self, rows: Floats) -> Floats:
        # What a network takes may depend on how many observations there are: it was tried on these.
        missing = -len(rows) % LARGEST_BATCH
        filled = np.concatenate([rows, np.repeat(rows[-1:], missing, axis=0)])
        answers = [
            self.network.batch(filled[at : at + LARGEST_BATCH]) for at in range(0, len(filled), LARGEST_BATCH)
        ]
        return np.concatenate(answers)[: len(rows)]

    def single(self) -> Callable[[ArrayLike], list[float]]:
        """Return a quick function of one observation, for one robot's control loop.

        It does not check its input, and has memory of its own. It raises a ModelError where the network
        fails on an observation.
        """
        infer = self.network.single()

        def told(observation: ArrayLike) -> list[float]:
            try:
                return infer(observation)
            except Exception as error:
                raise ModelError(f"{self.path}: fails on an observation: {_first_line(error)}") from error

        return told


def load_policy(
    model: str | Path | ModelFile,
    *,
    kind: Kind | None = None,
    skill: str | None = None,
    observation: ObservationSpec | None = None,
) -> Policy:
    """Load a model: a shipped one by its name, any other by its path, or a file that has been read.

    Before it runs, size, archive, checksums and card are checked, and that it consists of arithmetic only
    (:mod:`~robobt.models.checks`). Then it is run on zeros and random inputs: its outputs must be finite, of
    its card's shape and range, repeatable, and the same for a batch as one by one. A file is loaded once per
    process. Each call runs on one thread; torch's settings stay unchanged.

    Args:
        model: name of a shipped model, the path of a file, or what :func:`read_fitting_model` returned, with
            which the use has been checked.
        kind: required kind; None for any.
        skill: skill that will use it; None for any.
        observation: observation that it will be given; None for any.

    Raises:
        ModelError: it cannot be used; the message names the file and says why.
    """
    file = model
    if not isinstance(file, ModelFile):
        file = read_fitting_model(file, kind=kind, skill=skill, observation=observation)
    path, card = file.path, file.card
    key = (path.resolve(), file.sha256)
    if key not in _LOADED:
        try:
            network = LOADERS[file.format](file)
            _probe(network, card)
        except ModelError as error:
            raise ModelError(f"{path}: {one_line(str(error), 400)}") from error
        if len(_LOADED) >= _MOST_LOADED:
            del _LOADED[next(iter(_LOADED))]
        _LOADED[key] = Policy(file, network)
    return _LOADED[key]


def bare_module(policy: Policy) -> Callable[[], object]:
    """Return a call of the frozen module on a tensor of one observation, the yardstick of benchmarks."""
    network = policy.network
    if not isinstance(network, _TorchScript):
        raise ModelError(f"{policy.path}: is no TorchScript file")
    return network.bare()


class _TorchScript:
    """A frozen TorchScript module."""

    def __init__(self, file: ModelFile) -> None:
        # MKL, which multiplies torch's matrices, adds in an order that suits the processor unless this names
        # the order that all processors can. It looks once, before its first product.
        os.environ.setdefault("MKL_CBWR", "COMPATIBLE")
        with _telling("needs torch to run (pip install torch)"):
            import torch

        from robobt.models.checks.torchscript import load_frozen, run_bounded

        archive = pack_archive(checked_members(unpack_archive(file.content)))
        size = file.card.observation.size
        with quiet():
            with _telling("torch cannot load it"):
                module, constants = load_frozen(archive)
            with _telling(f"fails on an observation of {size} entries"):
                run_bounded(module, constants, size)
        self.module = module
        self._torch = torch
        # Of constants without gradients none is computed, in whatever mode: the mode is not entered for each
        # observation, which takes a sixth of a small network's time.
        self._differentiates = any(constant.requires_grad for constant in constants)
        self._size = size
        # Without Module.__call__, which looks for hooks that a frozen module cannot have.
        self._forward: Callable[[Tensor], Tensor] = module.forward

    def batch(self, inputs: Floats) -> Floats:
        with self._torch.inference_mode():
            answer = self._on_one_thread(self._torch.from_numpy(inputs))
        if not isinstance(answer, self._torch.Tensor):
            raise ModelError("answers no tensor")
        return np.asarray(answer.numpy(), dtype=np.float32)

    def single(self) -> Callable[[ArrayLike], list[float]]:
        buffer = np.zeros((1, self._size), dtype=np.float32)
        tensor = self._torch.from_numpy(buffer)
        forward, threads, no_gradient = (
            self._forward,
            self._torch.get_num_threads,
            self._torch.inference_mode(),
        )

        def infer(observation: ArrayLike) -> list[float]:
            buffer[0] = observation
            answer = forward(tensor) if threads() == 1 else self._on_one_thread(tensor)
            return answer.tolist()[0]  # type: ignore[no-any-return]

        def infer_without_gradient(observation: ArrayLike) -> list[float]:
            with no_gradient:
                return infer(observation)

        return infer_without_gradient if self._differentiates else infer

    def _on_one_thread(self, inputs: Tensor) -> Tensor:
        # On networks this small, threads wait for each other. The setting is the process's: restore it.
        threads = self._torch.get_num_threads()
        if threads == 1:
            return self._forward(inputs)
        self._torch.set_num_threads(1)
        try:
            return self._forward(inputs)
        finally:
            self._torch.set_num_threads(threads)

    def bare(self) -> Callable[[], object]:
        module, tensor = self.module, self._torch.zeros(1, self._size)
        return lambda: module(tensor)


class _Onnx:
    """A session of onnxruntime on one thread."""

    def __init__(self, file: ModelFile) -> None:
        check_onnx(file.content, file.card.observation.size)
        with _telling('needs onnxruntime to run (pip install "robobt[onnx]")'):
            import onnxruntime  # type: ignore[import-untyped]

        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.log_severity_level = 4
        with _telling("onnxruntime cannot load it"):
            self._session = onnxruntime.InferenceSession(
                file.content, options, providers=["CPUExecutionProvider"]
            )
        inputs, outputs = self._session.get_inputs(), self._session.get_outputs()
        if len(inputs) != 1 or len(outputs) != 1 or inputs[0].type != "tensor(float)":
            raise ModelError("does not take one array of single precision and answer one")
        self._input, self._output = inputs[0].name, [outputs[0].name]
        self._size = file.card.observation.size

    def batch(self, inputs: Floats) -> Floats:
        return np.asarray(self._session.run(self._output, {self._input: inputs})[0], dtype=np.float32)

    def single(self) -> Callable[[ArrayLike], list[float]]:
        buffer = np.zeros((1, self._size), dtype=np.float32)
        run, outputs, inputs = self._session.run, self._output, {self._input: buffer}

        def infer(observation: ArrayLike) -> list[float]:
            buffer[0] = observation
            return run(outputs, inputs)[0].tolist()[0]  # type: ignore[no-any-return]

        return infer


LOADERS: Mapping[Format, Callable[[ModelFile], Network]] = {"torchscript": _TorchScript, "onnx": _Onnx}
"""Loaders by format; they raise :class:`ModelError` without the file's name."""

_LOADED: dict[tuple[Path, str], Policy] = {}


def _probe(network: Network, card: ModelCard) -> None:
    """Try the network on zeros and on inputs of the size of those on a field."""
    size, outputs = card.observation.size, len(card.outputs)
    inputs = np.random.default_rng(0).normal(0.0, 2.0, (LARGEST_BATCH, size)).astype(np.float32)
    inputs[0] = 0.0
    low, high = card.output_range
    with _telling(f"fails on an observation of {size} entries"):
        first, again = network.batch(inputs), network.batch(inputs)
        if first.shape != (LARGEST_BATCH, outputs):
            raise ModelError(f"answers {first.shape} to {inputs.shape}, not ({LARGEST_BATCH}, {outputs})")
        one = network.single()
        singles = np.array([one(row.tolist()) for row in inputs])
    if not np.isfinite(first).all():
        raise ModelError("answers what is no finite number")
    if first.min() < low - _OUTPUT_ROUNDING or first.max() > high + _OUTPUT_ROUNDING:
        raise ModelError(f"answers {first.min():.3g} to {first.max():.3g}, not within [{low:g}, {high:g}]")
    if not np.array_equal(first, again):
        raise ModelError("does not answer the same twice")
    if singles.shape != first.shape or not np.allclose(singles, first, rtol=0.0, atol=_ORDER):
        raise ModelError("answers other than one by one when asked in a batch")


def _first_line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if not lines:
        return type(error).__name__
    # The interpreter begins with where it failed, and ends with why.
    said = lines[-1] if "TorchScript interpreter" in lines[0] else lines[0]
    return f"{type(error).__name__}: {said[:200]}"


@contextmanager
def _telling(what: str) -> Iterator[None]:
    """Raise a ModelError that says so for whatever else is raised."""
    try:
        yield
    except ModelError:
        raise
    except Exception as error:
        raise ModelError(f"{what}: {_first_line(error)}") from error


@contextmanager
def quiet() -> Iterator[None]:
    """Silence warnings, because a user cannot change TorchScript's deprecation."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
