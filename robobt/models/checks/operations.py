"""The operations of networks, by the formats' own names, and the look at a graph that torch has built."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from robobt.models.file import ModelError

if TYPE_CHECKING:
    from torch._C import Block, Graph, Node

_ARITHMETIC = """
abs acos add addcmul addmm amax amin arange argmax argmin asin atan atan2 batch_norm bmm cat ceil celu chunk
clamp clamp_max clamp_min clone concat contiguous cos cosh cumsum detach div dropout elu embedding eq erf
exp expand expand_as expm1 flatten floor floor_divide floordiv fmod full full_like gather ge gelu glu gru
gru_cell gt hardsigmoid hardswish hardtanh hypot index index_select layer_norm le leaky_relu lerp
linalg_vector_norm linear log log1p log_sigmoid log_softmax logical_and logical_not logical_or logsumexp
lstm lstm_cell lt matmul max maximum mean min minimum mish mm mul narrow ne neg new_full new_ones new_zeros
norm one_hot ones ones_like permute pow prelu prod reciprocal relu relu6 remainder repeat reshape rms_norm
rnn_relu rnn_tanh round rsqrt rsub select selu sigmoid sign silu sin sinh slice softmax softplus softsign
split sqrt square squeeze stack sub sum t tan tanh tensor to transpose trunc type_as unbind unsafe_chunk
unsafe_split unsqueeze view where zeros zeros_like
"""
_IN_PLACE = """
add_ celu_ clamp_ div_ dropout_ elu_ hardsigmoid_ hardswish_ hardtanh_ leaky_relu_ mish_ mul_ relu_ relu6_
selu_ sigmoid_ silu_ sub_ tanh_
"""
TRAPPING = frozenset({"div", "floor_divide", "floordiv", "fmod", "remainder"})
"""Operations that end the process where they divide an integer by 0, or the smallest one by -1."""

MOST_PIECES = 1000
"""Number of pieces into which an operation may split a tensor, because each piece takes memory."""

_SHAPES = "__contains__ __getitem__ __is__ __isnot__ __not__ dim len list size"

TORCH = frozenset([*_ARITHMETIC.split(), *_IN_PLACE.split(), *_SHAPES.split()])
"""What a TorchScript file may call of torch: nothing that reads, writes, draws or goes on without end."""

MAKE_TENSORS = frozenset({"arange", "full", "ones", "zeros"})
"""Operations that answer a tensor though they are given none."""

ABOUT_TENSORS = frozenset(_SHAPES.split())
"""Operations that may answer a number though they are given a tensor."""

_LANGUAGE = """
CallMethod Constant GetAttr ListConstruct ListUnpack NumToTensor TupleConstruct TupleIndex TupleUnpack device
dtype
"""
_PLAIN = frozenset([f"aten::{name}" for name in TORCH] + [f"prim::{name}" for name in _LANGUAGE.split()])
_COMPLAINTS = frozenset({"aten::format", "prim::RaiseException", "prim::Uninitialized"})
_FOR_TRAINING = "aten::Bool aten::Float aten::Int prim::If prim::Loop prim::unchecked_cast"
_AT_LOAD = _PLAIN | _COMPLAINTS | set(_FOR_TRAINING.split())
_HARMLESS = """
aten::__contains__ aten::__not__ aten::dim aten::eq aten::ge aten::gt aten::le aten::list aten::lt aten::ne
aten::size aten::squeeze aten::unsqueeze prim::Constant prim::If prim::ListConstruct prim::TupleConstruct
"""
_IN_BRANCH = _COMPLAINTS | set(_HARMLESS.split())
_MAKE_LISTS = """
aten::chunk aten::format aten::list aten::size aten::split aten::unbind aten::unsafe_chunk aten::unsafe_split
prim::Constant prim::GetAttr prim::If prim::ListConstruct prim::Loop prim::TupleUnpack prim::Uninitialized
prim::unchecked_cast
"""
_LIST_OPERATIONS = frozenset(_MAKE_LISTS.split())
"""Operations that may answer a list or a text; of others two doubled forty times would fill the memory."""
_MOST_OPERATIONS = 1000


def check_loaded(graph: Graph) -> None:
    """Check a graph as torch has loaded it, with the branches for training in it."""
    _check([node.kind() for node in nodes_of(graph)], _AT_LOAD)
    for node in nodes_of(graph):
        answers = {value.type().kind() for value in node.outputs()}
        if answers & {"ListType", "StringType", "DictType"} and node.kind() not in _LIST_OPERATIONS:
            raise ModelError(f"does more than arithmetic: lists or texts are made by {node.kind()}")


def check_frozen(graph: Graph) -> list[Any]:
    """Check a frozen graph, and return the tensors that are constants in it.

    What runs must not depend on more than the number of observations: of branches, only those may
    be left that complain of a shape or add an axis to it, so that whatever has run once within
    bounds does so again.
    """
    nodes = list(graph.nodes())
    if len(nodes) > _MOST_OPERATIONS:
        raise ModelError(f"takes more than {_MOST_OPERATIONS} operations")
    _check([node.kind() for node in nodes], _PLAIN | {"prim::If"} | _COMPLAINTS)
    inside = [node.kind() for outer in nodes for block in outer.blocks() for node in nodes_of(block)]
    _check(inside, _IN_BRANCH)
    values = [node.output() for node in nodes if node.kind() == "prim::Constant"]
    return [value.toIValue() for value in values if value.type().kind() == "TensorType"]


def _check(kinds: Iterable[str], allowed: frozenset[str]) -> None:
    foreign = sorted(set(kinds) - allowed)
    if foreign:
        raise ModelError(f"does more than arithmetic: {', '.join(foreign)}")


def nodes_of(block: Graph | Block) -> Iterator[Node]:
    """Yield the nodes of a graph, those in its branches included."""
    for node in block.nodes():
        yield node
        for inner in node.blocks():
            yield from nodes_of(inner)
