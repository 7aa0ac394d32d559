"""The size of what the usual operations of networks answer, without torch's own functions for that.

Those import torch's compiler, which takes longer than all else that loading a policy does.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

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
        return _without_memory(first)
    if func in _BROADCAST and len(others) == 1 and first[-len(others[0]) :] == others[0]:
        return _without_memory(first)
    if func is torch.ops.aten.layer_norm.default and args[1] == [*first[-1:]]:
        return _without_memory(first) if all(other == first[-1:] for other in others) else None
    if func is torch.ops.aten.linear.default:
        weights, *bias = others
        if len(weights) == 2 and first[-1:] == weights[1:] and all(one == weights[:1] for one in bias):
            return _without_memory((*first[:-1], weights[0]))
    return None


def _without_memory(shape: tuple[int, ...]) -> Tensor:
    return torch.empty(shape, device="meta")
