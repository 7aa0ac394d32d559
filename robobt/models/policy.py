"""Trained models as functions of arrays. Only here a skill meets torch, and only when it loads a model."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.models.card import ModelCard
from robobt.models.checks import check_code, check_onnx, check_operations
from robobt.models.file import (
    Format,
    ModelError,
    ModelFile,
    find_model,
    read_model_file,
    unpack_archive,
)
from robobt.world.features import ObservationSpec

Floats = NDArray[np.float32]

_MOST_LOADED = 100
_PROBES = 64
_ORDER = 1e-3
"""How far the order of summation may move an output in single precision."""
_SLACK = 1e-4
"""How far an output may lie outside its range for the rounding of single precision."""


class Network(Protocol):
    """What a format's loader returns."""

    def batch(self, inputs: Floats) -> Floats:
        """(n, size) -> (n, outputs), in single precision."""

    def single(self) -> Callable[[ArrayLike], list[float]]:
        """A function of one observation, with memory of its own: not for two threads at once."""


class Policy:
    """A loaded model: a function of arrays, and the card that says what they mean.

    Attributes:
        card: what the model says about itself.
        path: the file it was loaded from.
        sha256: of that file.
        network: what runs it.
    """

    def __init__(self, file: ModelFile, network: Network) -> None:
        self.card = file.card
        self.path = file.path
        self.sha256 = file.sha256
        self.network = network

    def __call__(self, inputs: ArrayLike) -> NDArray[np.float64]:
        """What the model answers.

        Args:
            inputs: (size,) or (n, size), in SI units.

        Returns:
            (outputs,) or (n, outputs).

        Raises:
            ValueError: the inputs have another shape.
        """
        given = np.asarray(inputs, dtype=np.float32)
        size = self.card.observation.size
        if given.ndim not in (1, 2) or given.shape[-1] != size:
            raise ValueError(f"{self.card.name} takes ({size},) or (n, {size}), not {given.shape}")
        if not len(given):
            return np.zeros((0, len(self.card.outputs)))
        answers = self.network.batch(np.ascontiguousarray(given.reshape(-1, size)))
        return answers.astype(np.float64).reshape(*given.shape[:-1], len(self.card.outputs))

    def single(self) -> Callable[[ArrayLike], list[float]]:
        """A quick function of one observation, for one robot's control loop.

        It does not check what it is given. Each one has memory of its own.
        """
        return self.network.single()


def load_policy(
    name_or_path: str | Path, *, skill: str | None = None, observation: ObservationSpec | None = None
) -> Policy:
    """Load a model: a shipped one by its name, any other by its path.

    Before it is run: size, archive, checksums, card, and that it consists of nothing
    but arithmetic (:mod:`~robobt.models.checks`). Then it is tried on zeros and on
    random inputs: it has to answer finite numbers of its card's shape and range, the
    same each time, and for a batch what it answers one by one. The same file is
    loaded once per process. From then on torch computes on one thread in this process.

    Args:
        skill: what it shall be used for; None for anything.
        observation: what it shall be given; None for anything.

    Raises:
        ModelError: it cannot be used; the message names the file and says why.
    """
    path = find_model(name_or_path)
    file = read_model_file(path)
    card = file.card
    problem = card.observation.problem()
    if skill is not None and card.skill != skill:
        problem = f"is a model for {card.skill}, not for {skill}"
    elif observation is not None and card.observation.name != observation.name:
        problem = f"takes the observation {card.observation.name!r}, not {observation.name!r}"
    if problem is not None:
        raise ModelError(f"{path}: {problem}")
    key = (path.resolve(), file.sha256)
    if key not in _LOADED:
        try:
            network = LOADERS[file.format](file)
            _probe(network, card)
        except ModelError as error:
            raise ModelError(f"{path}: {error}") from error
        if len(_LOADED) >= _MOST_LOADED:
            del _LOADED[next(iter(_LOADED))]
        _LOADED[key] = Policy(file, network)
    return _LOADED[key]


def bare_module(policy: Policy) -> Callable[[], object]:
    """A call of a policy's frozen module on a tensor of one observation, and nothing else: to measure by.

    Raises:
        ModelError: the policy is no TorchScript one.
    """
    network = policy.network
    if not isinstance(network, _TorchScript):
        raise ModelError(f"{policy.path}: is no TorchScript file")
    return network.bare()


class _TorchScript:
    """A frozen TorchScript module."""

    def __init__(self, file: ModelFile) -> None:
        try:
            import torch
        except ImportError as error:
            raise ModelError(f"needs torch to run: {_first_line(error)}") from error

        members = unpack_archive(file.content)
        check_code(members)
        if torch.get_num_threads() != 1:
            torch.set_num_threads(1)
        with _quiet():
            try:
                loaded = torch.jit.load(BytesIO(file.content), map_location="cpu")  # type: ignore[no-untyped-call]
                loaded.eval()
                # Freezing runs whatever does not depend on the input.
                check_operations(loaded.inlined_graph, {"prim::If", "aten::dropout"})
                module = torch.jit.freeze(loaded)
                check_operations(module.inlined_graph)
            except ModelError:
                raise
            except Exception as error:
                raise ModelError(f"torch cannot load it: {_first_line(error)}") from error
        self.module = module
        self._torch = torch
        self._size = file.card.observation.size
        # Without Module.__call__, which looks for hooks that a frozen module cannot have.
        self._forward: Callable[[Any], Any] = module.forward

    def batch(self, inputs: Floats) -> Floats:
        with self._torch.inference_mode():
            answer = self._forward(self._torch.from_numpy(inputs))
        if not isinstance(answer, self._torch.Tensor):
            raise ModelError("answers no tensor")
        return np.asarray(answer.numpy(), dtype=np.float32)

    def single(self) -> Callable[[ArrayLike], list[float]]:
        buffer = np.zeros((1, self._size), dtype=np.float32)
        tensor = self._torch.from_numpy(buffer)
        forward, no_gradient = self._forward, self._torch.inference_mode()

        def infer(observation: ArrayLike) -> list[float]:
            buffer[0] = observation
            with no_gradient:
                return forward(tensor).tolist()[0]  # type: ignore[no-any-return]

        return infer

    def bare(self) -> Callable[[], object]:
        module, tensor = self.module, self._torch.zeros(1, self._size)
        return lambda: module(tensor)


class _Onnx:
    """A session of onnxruntime on one thread."""

    def __init__(self, file: ModelFile) -> None:
        check_onnx(file.content)
        try:
            import onnxruntime  # type: ignore[import-untyped]
        except ImportError as error:
            raise ModelError(f"needs onnxruntime to run: {_first_line(error)}") from error

        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.log_severity_level = 4
        try:
            self._session = onnxruntime.InferenceSession(
                file.content, options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:
            raise ModelError(f"onnxruntime cannot load it: {_first_line(error)}") from error
        inputs, outputs = self._session.get_inputs(), self._session.get_outputs()
        if len(inputs) != 1 or len(outputs) != 1 or inputs[0].type != "tensor(float)":
            raise ModelError("does not take one array of single precision and answer one")
        self._input, self._output = inputs[0].name, [outputs[0].name]
        self._size = file.card.observation.size

    def batch(self, inputs: Floats) -> Floats:
        return np.asarray(self._session.run(self._output, {self._input: inputs})[0], dtype=np.float32)

    def single(self) -> Callable[[ArrayLike], list[float]]:
        buffer = np.zeros((1, self._size), dtype=np.float32)
        run, wanted, given = self._session.run, self._output, {self._input: buffer}

        def infer(observation: ArrayLike) -> list[float]:
            buffer[0] = observation
            return run(wanted, given)[0].tolist()[0]  # type: ignore[no-any-return]

        return infer


LOADERS: Mapping[Format, Callable[[ModelFile], Network]] = {"torchscript": _TorchScript, "onnx": _Onnx}
"""What makes a file of each format a function. They raise :class:`ModelError` without the file's name."""

_LOADED: dict[tuple[Path, str], Policy] = {}


def _probe(network: Network, card: ModelCard) -> None:
    """Try the network on zeros and on inputs of the size of those on a field."""
    size, outputs = card.observation.size, len(card.outputs)
    inputs = np.random.default_rng(0).normal(0.0, 2.0, (_PROBES, size)).astype(np.float32)
    inputs[0] = 0.0
    low, high = card.output_range
    try:
        first, again = network.batch(inputs), network.batch(inputs)
        if first.shape != (_PROBES, outputs):
            raise ModelError(f"answers {first.shape} to {inputs.shape}, not ({_PROBES}, {outputs})")
        one = network.single()
        singles = np.array([one(row.tolist()) for row in inputs])
    except ModelError:
        raise
    except Exception as error:
        raise ModelError(f"fails on an observation of {size} entries: {_first_line(error)}") from error
    if not np.isfinite(first).all():
        raise ModelError("answers what is no finite number")
    if first.min() < low - _SLACK or first.max() > high + _SLACK:
        raise ModelError(f"answers {first.min():.3g} to {first.max():.3g}, not within [{low:g}, {high:g}]")
    if not np.array_equal(first, again):
        raise ModelError("does not answer the same twice")
    if singles.shape != first.shape or not np.allclose(singles, first, rtol=0.0, atol=_ORDER):
        raise ModelError("answers other than one by one when asked in a batch")


def _first_line(error: Exception) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return f"{type(error).__name__}: {lines[0][:200]}" if lines else type(error).__name__


@contextmanager
def _quiet() -> Iterator[None]:
    """Whoever plays with a model cannot do anything about TorchScript being deprecated upstream."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
