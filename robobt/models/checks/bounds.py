"""Bounds on what a network may take, found out with tensors that have a shape and no memory."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import torch
from torch import Tensor
from torch.utils._python_dispatch import TorchDispatchMode
from torch.utils._pytree import tree_leaves, tree_map

from robobt.models.checks.onnx_file import MAX_BYTES, MAX_PRODUCTS
from robobt.models.file import ModelError


class Bounds(TorchDispatchMode):  # type: ignore[no-untyped-call]
    """Within it torch runs nothing that would take more memory or time than a network of ours.

    Each operation is first tried on tensors without memory, which says how large its answers would be.
    """

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._bytes = 0
        self._products = 0

    def __torch_dispatch__(
        self,
        func: torch._ops.OpOverload,
        types: Sequence[type],
        args: Sequence[object] = (),
        kwargs: Mapping[str, object] | None = None,
    ) -> object:
        del types
        given = dict(kwargs or {})
        if torch.Tag.data_dependent_output not in func.tags:
            self._add(func, args, given)
        return func(*args, **given)

    def _add(self, func: torch._ops.OpOverload, args: Sequence[object], kwargs: dict[str, object]) -> None:
        tensors = [one for one in tree_leaves((args, kwargs)) if isinstance(one, Tensor)]
        without = tree_map(_without_memory, kwargs)
        if not tensors or "device" in kwargs:
            without["device"] = torch.device("meta")
        answers = tree_leaves(func(*tree_map(_without_memory, args), **without))
        found = [one for one in answers if isinstance(one, Tensor)]
        longest = max([size for one in tensors for size in one.shape], default=1)
        self._products += sum([one.numel() for one in found]) * longest
        if all(each.alias_info is None for each in func._schema.returns):
            self._bytes += sum([math.prod(one.shape) * one.element_size() for one in found])
        if self._bytes > MAX_BYTES or self._products > MAX_PRODUCTS:
            raise ModelError("takes more memory or time than a model does")


def _without_memory(value: object) -> object:
    if isinstance(value, Tensor):
        return torch.empty_strided(value.shape, value.stride(), dtype=value.dtype, device="meta")
    return torch.device("meta") if isinstance(value, torch.device) else value
