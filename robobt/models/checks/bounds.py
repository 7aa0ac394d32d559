"""Bounds on a network's work, computed with tensors that have a shape but no memory."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import torch
from torch import Tensor
from torch.utils._python_dispatch import TorchDispatchMode
from torch.utils._pytree import tree_leaves, tree_map

from robobt.models.checks.limits import ELEMENT, MAX_OUTPUT_BYTES, OTHER_TYPE, RECURRENT_GATES, largest_work
from robobt.models.checks.operations import MOST_PIECES, TRAPPING
from robobt.models.file import ModelError

_BROADCAST = frozenset({getattr(torch.ops.aten, name).Tensor for name in ("add", "sub", "mul", "div")})
_SAME_SHAPE = frozenset({getattr(torch.ops.aten, name).default for name in ("tanh", "relu", "sigmoid")})


def usual_answer(func: torch._ops.OpOverload, args: Sequence[object]) -> Tensor | None:
    """Return the answer of a usual operation as a tensor without memory.

    Args:
        func: the operation.
        args: its arguments; what is given by name changes no size.

    Returns:
        The answer, or None where torch has to say what it would be.
    """
    tensors = [one for one in args if isinstance(one, Tensor)]
    if not tensors or any(one.dtype != torch.float32 or one.device.type != "cpu" for one in tensors):
        return None
    shapes = [tuple(one.shape) for one in tensors]
    first, *others = shapes
    if func in _SAME_SHAPE:
        return torch.empty(first, device="meta")
    if func in _BROADCAST and len(others) == 1 and first[-len(others[0]) :] == others[0]:
        return torch.empty(first, device="meta")
    if func is torch.ops.aten.layer_norm.default and args[1] == [*first[-1:]]:
        return torch.empty(first, device="meta") if all(other == first[-1:] for other in others) else None
    if func is torch.ops.aten.linear.default:
        weights, *bias = others
        if len(weights) == 2 and first[-1:] == weights[1:] and all(one == weights[:1] for one in bias):
            return torch.empty((*first[:-1], weights[0]), device="meta")
    return None


_CONTRACTIONS = frozenset({"mm", "addmm", "bmm", "baddbmm", "addmv", "mv", "dot", "linear", "matmul"})


class Bounds(TorchDispatchMode):  # type: ignore[no-untyped-call]
    """Within it torch runs nothing that would take more memory or time than a network of ours, or trap.

    Each operation is first tried on tensors without memory, which says how large its answers would be
    and of which type. Processors trap where an integer is divided by 0, or the smallest one by -1.

    Leaving it raises the first error of an operation: torch replaces errors from within by its own,
    or goes on.
    """

    def __init__(self, batch: int, constants: Collection[Tensor] | None = None) -> None:
        """Bound one run on ``batch`` observations.

        Args:
            batch: how many observations it is given.
            constants: tensors that hold the same numbers in every run; None where all do.
        """
        super().__init__()  # type: ignore[no-untyped-call]
        self._failure: Exception | None = None
        self._constants = None if constants is None else {one.data_ptr() for one in constants}
        self._largest_work = largest_work(batch)
        self._bytes = 0
        self._work = 0
        self._changes = False
        self._divides = False

    @classmethod
    def _should_skip_dynamo(cls) -> bool:
        # Torch would import its compiler, which takes over a second, to keep it off what it never compiles.
        return False

    def __torch_dispatch__(
        self,
        func: torch._ops.OpOverload,
        types: Sequence[type],
        args: Sequence[object] = (),
        kwargs: Mapping[str, object] | None = None,
    ) -> object:
        del types
        given = dict(kwargs or {})
        try:
            if torch.Tag.data_dependent_output not in func.tags:
                self._check(func, args, given)
            return func(*args, **given)
        except Exception as error:
            self._failure = self._failure or error
            raise

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: Any) -> None:
        super().__exit__(kind, error, trace)  # type: ignore[no-untyped-call]
        if self._failure is not None:
            raise self._failure

    def _check(self, func: torch._ops.OpOverload, args: Sequence[object], kwargs: dict[str, object]) -> None:
        name = func._schema.name.removeprefix("aten::")
        named = dict(zip([each.name for each in func._schema.arguments], args, strict=False)) | kwargs
        if _pieces(name, named) > MOST_PIECES:
            raise ModelError(f"aten::{name} would cut a tensor into more than {MOST_PIECES} pieces")
        tensors = [one for one in tree_leaves((args, kwargs)) if isinstance(one, Tensor)]
        usual = usual_answer(func, args)
        found = _tried(func, tensors, args, kwargs) if usual is None else [usual]
        if name.rstrip("_") in TRAPPING and not any(one.is_floating_point() for one in found):
            self._check_division(name, named["self"], named["other"])
        self._changes |= func._schema.is_mutable
        if self._changes and self._divides:
            raise ModelError("divides integers by a tensor, and changes a tensor in place")
        self._work += _work(name, tensors, found)
        if all(each.alias_info is None for each in func._schema.returns):
            self._bytes += sum([math.prod(one.shape) * one.element_size() for one in found])
        if self._bytes > MAX_OUTPUT_BYTES or self._work > self._largest_work:
            raise ModelError(f"takes more memory or time than a model does, at aten::{name}")

    def _check_division(self, name: str, divided: Any, divisor: Any) -> None:
        if isinstance(divisor, Tensor) and self._constants is not None:
            if divisor.data_ptr() not in self._constants:
                raise ModelError(
                    f"aten::{name} divides integers by a tensor that may hold 0; "
                    "divide by a constant, or divide floating-point numbers"
                )
            self._divides = True
        # Torch converts both to one type before it divides: 2**32 - 1 is -1 among 32-bit integers.
        converted = torch.as_tensor(divisor).to(torch.result_type(divided, divisor))
        if bool(((converted == 0) | (converted == -1)).any()):
            raise ModelError(f"aten::{name} divides integers by 0 or -1")


def _tried(
    func: torch._ops.OpOverload, tensors: Sequence[Tensor], args: Sequence[object], kwargs: dict[str, object]
) -> list[Tensor]:
    """Return what an operation answers to tensors without memory."""
    without = tree_map(_without_memory, kwargs)
    if not tensors or "device" in kwargs:
        without["device"] = torch.device("meta")
    answers = tree_leaves(func(*tree_map(_without_memory, args), **without))
    return [one for one in answers if isinstance(one, Tensor)]


def _pieces(name: str, named: Mapping[str, object]) -> int:
    whole, axis = named.get("self"), named.get("dim", 0)
    if not isinstance(whole, Tensor) or not isinstance(axis, int) or not -whole.dim() <= axis < whole.dim():
        return 0
    match name, named:
        case "unbind", _:
            return whole.shape[axis]
        case "split" | "unsafe_split", {"split_size": int(length)}:
            return whole.shape[axis] // max(length, 1)
        case "chunk" | "unsafe_chunk", {"chunks": int(count)}:
            return min(whole.shape[axis], count)
    return 0


def _work(name: str, tensors: Sequence[Tensor], found: Sequence[Tensor]) -> int:
    """Return how long an operation takes, in multiplications of a product of matrices."""
    taken, made = sum([one.numel() for one in tensors]), sum([one.numel() for one in found])
    steps = 0
    if "rnn" in name:
        steps = RECURRENT_GATES * made * max([size for one in tensors for size in one.shape], default=1)
    elif name in _CONTRACTIONS:
        # The axis that both factors have is no longer than the longest of either.
        factors = tensors[-2:] if "add" in name else tensors[:2]
        steps = made * min([max(one.shape, default=1) for one in factors], default=1)
        if any(one.dtype != torch.float32 for one in factors):
            steps *= OTHER_TYPE
    return steps + ELEMENT * max(taken if name not in _CONTRACTIONS else 0, made)


def _without_memory(value: object) -> object:
    if isinstance(value, Tensor):
        return torch.empty_strided(value.shape, value.stride(), dtype=value.dtype, device="meta")
    return torch.device("meta") if isinstance(value, torch.device) else value
