"""All checks of a TorchScript network, in the order in which they make it safe to go on."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from typing import TYPE_CHECKING, Any

import torch
from torch import Tensor

from robobt.models.checks.bounds import Bounds
from robobt.models.checks.limits import LARGEST_BATCH
from robobt.models.checks.operations import TRAPPING, check_frozen, check_loaded, nodes_of
from robobt.models.file import ModelError

if TYPE_CHECKING:
    from torch._C import Node, Value

_CODES: Mapping[str, frozenset[object]] = {
    "dtype": frozenset({None, 0, 1, 2, 3, 4, 5, 6, 7, 11, 15}),
    "layout": frozenset({None, 0}),
    "memory_format": frozenset({None, 0, 1}),
    "pin_memory": frozenset({None, False}),
}
"""Torch's numbers of real types, dense layouts and memory orders, which torch does not check."""

_UNKNOWN = object()


def check_arguments(module: Any) -> None:
    """Check the arguments of a loaded module's operations that are not tensors.

    Args:
        module: the module as torch holds it, of which torch's annotations do not tell all.

    Raises:
        ModelError: an integer is divided by what may be 0 or -1, which ends the process; a type or layout
            is none of torch's; or a tensor is to be printed, which takes as long as it is large.
    """
    from torch._C import parse_schema

    def known(value: Value) -> object:
        """Return a value that is constant in every run."""
        node = value.node()
        match node.kind():
            case "prim::Constant":
                return value.toIValue()
            case "prim::GetAttr":
                return owner(node.input()).getattr(node.s("name"))
            case "prim::unchecked_cast":
                return known(node.input())
        return _UNKNOWN

    def owner(value: Value) -> Any:
        node = value.node()
        return owner(node.input()).getattr(node.s("name")) if node.kind() == "prim::GetAttr" else module

    for node in nodes_of(module._get_method("forward").inlined_graph):
        kind = node.kind()
        if kind == "aten::format":
            if any("Tensor" in value.type().annotation_str for value in node.inputs()):
                raise ModelError(f"prints a tensor{_place(node)}")
            continue
        if not kind.startswith("aten::") or node.schema() == "(no schema)":
            continue
        schema = parse_schema(node.schema())
        given = dict(zip([each.name for each in schema.arguments], node.inputs(), strict=True))
        for name, codes in _CODES.items():
            if name not in given or given[name].node().kind() == "prim::dtype":
                continue
            if known(given[name]) not in codes:
                raise ModelError(f"{kind} is given a {name} that no network needs{_place(node)}")
        classes = known(given["num_classes"]) if "num_classes" in given else 1
        if not isinstance(classes, int) or classes < 1:
            raise ModelError(f"{kind} answers as much as an observation says{_place(node)}")
        if schema.overload_name in ("prim_Device", "prim_dtype") and known([*node.inputs()][1]) is None:
            # Torch would look for what it is to convert to without end.
            raise ModelError(f"{kind} is not given what to convert to{_place(node)}")
        if kind.removeprefix("aten::") in TRAPPING and _answers_integer(node):
            divisor = known([*node.inputs()][1])
            if not isinstance(divisor, int) or divisor in (0, -1):
                raise ModelError(f"{kind} divides an integer by what may be 0 or -1{_place(node)}")


def _answers_integer(node: Node) -> bool:
    return node.output().type().kind() in ("IntType", "NumberType")


def _place(node: Node) -> str:
    """Return where in the file an operation is, as far as torch knows."""
    lines = [line.strip() for line in str(node.sourceRange()).splitlines()]
    for number, line in enumerate(lines):
        if line.startswith("~") and number:
            return f": {lines[number - 1][:80]}"
    return ""


def load_frozen(archive: bytes) -> tuple[Any, list[Tensor]]:
    """Load an archive whose source has been checked, and check what torch made of it.

    Returns:
        The frozen module, and the tensors that are constants in it.
    """
    loaded = torch.jit.load(BytesIO(archive), map_location="cpu")  # type: ignore[no-untyped-call]
    loaded.eval()
    check_loaded(loaded.inlined_graph)
    check_arguments(loaded._c)
    # Freezing runs whatever does not depend on the input.
    with Bounds(LARGEST_BATCH):
        module = torch.jit.freeze(loaded)
    return module, check_frozen(module.inlined_graph)


def run_bounded(module: Any, constants: list[Tensor], size: int) -> None:
    """Run a frozen module within bounds, for each number of observations that it will be given."""
    with torch.inference_mode():
        for count in (LARGEST_BATCH, 1):
            observations = torch.zeros(count, size)
            with Bounds(count, constants):
                module(observations)
