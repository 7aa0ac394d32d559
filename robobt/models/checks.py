"""What a model may consist of: plain arithmetic, looked over before torch or onnxruntime see it."""

from __future__ import annotations

import ast
import pickle
import pickletools
import re
from collections.abc import Iterable, Mapping, Set
from io import BytesIO, StringIO
from typing import Protocol, TypeAlias

from robobt.models.file import Format, ModelError

_TORCH = """
abs add add_ addmm atan2 cat clamp clamp_ concat contiguous cos detach div div_ elu eq exp flatten ge
gelu gt hardtanh hardtanh_ hypot layer_norm le leaky_relu linear log log1p log_softmax logical_and
logical_not logical_or lt matmul max maximum mean min minimum mm mul mul_ ne neg permute pow reciprocal relu
relu6 relu_ reshape rsqrt rsub select sigmoid sigmoid_ sign silu sin slice softmax softplus sqrt square
squeeze stack sub sub_ sum t tanh tanh_ to transpose unsqueeze view where
"""
_LANGUAGE = "CallMethod Constant GetAttr ListConstruct ListUnpack NumToTensor TupleConstruct TupleUnpack"
_ONNX = """
Abs Add And Cast Clip Concat Constant Cos Div Elu Equal Erf Exp Flatten Gather Gelu Gemm Greater
GreaterOrEqual Identity LayerNormalization LeakyRelu Less LessOrEqual Log LogSoftmax MatMul Max Mean Min Mul
Neg Not Or Pow Reciprocal ReduceMax ReduceMean ReduceMin ReduceSum Relu Reshape Sigmoid Sign Sin Slice
Softmax Softplus Sqrt Squeeze Sub Sum Tanh Transpose Unsqueeze Where
"""

OPERATIONS: Mapping[Format, frozenset[str]] = {
    "torchscript": frozenset(
        [f"aten::{name}" for name in _TORCH.split()] + [f"prim::{name}" for name in _LANGUAGE.split()]
    ),
    "onnx": frozenset(_ONNX.split()),
}
"""What a model may do: the operations of feed-forward networks, by the formats' own names."""


class Node(Protocol):
    """A node of a TorchScript graph."""

    def kind(self) -> str:
        """Return the operation's name."""

    def blocks(self) -> Iterable[Graph]:
        """Return the blocks inside it."""


class Graph(Protocol):
    """A TorchScript graph, or a block of one."""

    def nodes(self) -> Iterable[Node]:
        """Return its nodes."""


def check_operations(graph: Graph, also: Set[str] = frozenset()) -> None:
    """Check that a TorchScript graph consists of nothing but :data:`OPERATIONS` and those in ``also``.

    Raises:
        ModelError: it does more than that.
    """
    foreign = _kinds(graph) - OPERATIONS["torchscript"] - also
    if foreign:
        raise ModelError(f"does more than arithmetic: {', '.join(sorted(foreign))}")


def _kinds(block: Graph) -> set[str]:
    kinds: set[str] = set()
    for node in block.nodes():
        kinds.add(node.kind())
        for inner in node.blocks():
            kinds |= _kinds(inner)
    return kinds


def check_code(members: Mapping[str, bytes]) -> None:
    """Look over what torch would read and run, with Python's own parsers, which do neither.

    Torch's archive holds a restricted dialect of Python and pickles of its own. What
    they may not hold is what could keep the process busy, run while being loaded, or
    have torch read past the end of the weights.

    Args:
        members: the archive's content by name.

    Raises:
        ModelError: they hold something of the kind, or are damaged.
    """
    for name, content in members.items():
        try:
            if name.endswith(".py"):
                _check_source(content.decode())
            elif name.endswith(".pkl"):
                # Follows the stack, which torch's own reader takes on trust.
                pickletools.dis(content, out=StringIO())
                _Reader(content, name.removesuffix(".pkl"), members).load()
        except ModelError:
            raise
        except Exception as error:
            raise ModelError(f"{name} in it is damaged ({type(error).__name__})") from error


def _check_source(text: str) -> None:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.While | ast.For):
            raise ModelError("has a loop in it; a policy is a plain network")
        if isinstance(node, ast.FunctionDef) and node.name.startswith("__") and not _is_length(node):
            raise ModelError(f"has a function {node.name} in it, which would run while it is loaded")


def _is_length(function: ast.FunctionDef) -> bool:
    """Return whether it is what torch writes for every ``nn.Sequential``: its number of layers."""
    match function.name, function.body:
        case "__len__", [ast.Return(ast.Constant(int()))]:
            return True
    return False


class _Reader(pickle.Unpickler):
    """Reads a pickle into things that do nothing, and refuses names that no network needs."""

    def __init__(self, content: bytes, folder: str, members: Mapping[str, bytes]) -> None:
        super().__init__(BytesIO(content))
        self._folder = folder
        self._members = members

    def find_class(self, module: str, name: str) -> type[_Thing]:
        if not _NAMES.fullmatch(f"{module} {name}"):
            raise ModelError(f"names {module} {name} in it, which no network needs")
        return type(name, (_Thing,), {})

    def persistent_load(self, pid: _Storage) -> object:
        kind, storage, key, _, count = pid
        size = _ITEM_SIZES[storage.__name__] * count
        if kind != "storage" or len(self._members[f"{self._folder}/{key}"]) != size:
            raise ModelError(f"{self._folder}/{key} in it is cut short")
        return _Thing()


_Storage: TypeAlias = tuple[str, type, str, str, int]
"""What torch writes in place of a tensor's storage: "storage", its class, key, device and count."""


class _Thing:
    """Stands for whatever a pickle makes."""

    def __init__(self, *_: object) -> None:
        pass

    def __setstate__(self, _: object) -> None:
        pass


_NAMES = re.compile(
    r"__torch__[.\w]* \w+|torch\._utils _rebuild_\w+|torch \w+Storage|torch\.jit\._pickle \w+"
    r"|collections OrderedDict"
)
_ITEM_SIZES = {"BoolStorage": 1, "ByteStorage": 1, "DoubleStorage": 8, "FloatStorage": 4, "HalfStorage": 2}
_ITEM_SIZES |= {"BFloat16Storage": 2, "CharStorage": 1, "IntStorage": 4, "LongStorage": 8, "ShortStorage": 2}


def check_onnx(content: bytes) -> None:
    """Check that an ONNX file consists of nothing but :data:`OPERATIONS`, with the weights in it.

    Raises:
        ModelError: it does not, or is damaged.
    """
    import onnx

    try:
        model = onnx.load_from_string(content)
    except Exception as error:
        raise ModelError(f"is no intact ONNX file ({type(error).__name__})") from error
    foreign = {
        node.op_type
        for node in model.graph.node
        if node.domain not in ("", "ai.onnx") or node.op_type not in OPERATIONS["onnx"]
    }
    if foreign or model.functions:
        raise ModelError(f"does more than arithmetic: {', '.join(sorted(foreign)) or 'functions'}")
    tensors = [
        *model.graph.initializer,
        *[field.t for node in model.graph.node for field in node.attribute if field.HasField("t")],
    ]
    if any(tensor.data_location == onnx.TensorProto.EXTERNAL for tensor in tensors):
        raise ModelError("keeps its weights in another file")
