"""The look at an ONNX file before onnxruntime sees it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from robobt.models.checks.limits import (
    ELEMENT,
    LARGEST_BATCH,
    MAX_OUTPUT_BYTES,
    OTHER_TYPE,
    RECURRENT_GATES,
    largest_work,
)
from robobt.models.file import ModelError
from robobt.models.protobuf import fields

if TYPE_CHECKING:
    import onnx

_NODE_TYPES = """
Abs Add And ArgMax ArgMin Atan BatchNormalization Cast Ceil Celu Clip Concat Constant ConstantOfShape Cos Div
Dropout Elu Equal Erf Exp Expand Flatten Floor GRU Gather GatherElements Gelu Gemm Greater GreaterOrEqual
HardSigmoid HardSwish Identity LSTM LayerNormalization LeakyRelu Less LessOrEqual Log LogSoftmax MatMul Max
Mean Min Mish Mod Mul Neg Not Or PRelu Pow RNN Reciprocal ReduceL2 ReduceMax ReduceMean ReduceMin ReduceProd
ReduceSum Relu Reshape Round Selu Shape Sigmoid Sign Sin Slice Softmax Softplus Softsign Split Sqrt Squeeze
Sub Sum Tan Tanh Tile Transpose Unsqueeze Where Xor
"""
_OPERATIONS = frozenset(_NODE_TYPES.split())

_FIELDS: Mapping[str, frozenset[str]] = {
    message: frozenset(names.split())
    for message, names in {
        "ModelProto": "ir_version producer_name producer_version domain model_version doc_string graph "
        "opset_import metadata_props",
        "OperatorSetIdProto": "domain version",
        "StringStringEntryProto": "key value",
        "GraphProto": "node name initializer doc_string input output value_info metadata_props",
        "NodeProto": "input output name op_type domain attribute doc_string overload metadata_props",
        "AttributeProto": "name type doc_string f i s t floats ints strings",
        "TensorProto": "dims data_type name doc_string float_data int32_data int64_data double_data raw_data",
        "ValueInfoProto": "name type doc_string metadata_props",
        "TypeProto": "tensor_type denotation",
        "Tensor": "elem_type shape",
        "TensorShapeProto": "dim",
        "Dimension": "dim_value dim_param denotation",
    }.items()
}
"""What the parts of an ONNX file may hold: weights lie in them, as dense tensors, and no graph in a graph."""

_MOST_FILE_FIELDS = 50_000
_LONGEST_NUMBERS = 2**20
_MOST_GRAPH_NODES = 2000
_MOST_ENTRIES = 300_000
"""Entries of all vectors that nodes take and answer, biases among them."""
_ONNX_ITEM_SIZES = {1: 4, 2: 1, 3: 1, 6: 4, 7: 8, 9: 1, 10: 2, 11: 8}
"""Bytes of an item by ONNX's number of the type: no texts, and nothing exotic."""


_ONNX_FLOAT = 1
_FLOATS = frozenset({1, 10, 11})
"""ONNX's numbers of the types that are no integers."""

_DIVISIONS = frozenset({"Div", "Mod"})
_RECURRENT = frozenset({"GRU", "LSTM", "RNN"})


def check_onnx(content: bytes, size: int) -> None:
    """Check that an ONNX file consists of plain operations, with bounded answers and all weights in it.

    ``content`` is the file without card and seal; it is run on one observation of ``size`` numbers, or
    :data:`~robobt.models.checks.limits.LARGEST_BATCH`.
    """
    import onnx

    try:
        _check_fields(content, onnx.ModelProto.DESCRIPTOR, 0)
        model = onnx.load_from_string(content)
        _check_tensors(model)
        foreign = {
            node.op_type
            for node in model.graph.node
            if node.domain not in ("", "ai.onnx") or node.op_type not in _OPERATIONS
        }
        if foreign:
            raise ModelError(f"does more than arithmetic: {', '.join(sorted(foreign))}")
        if len(model.graph.node) > _MOST_GRAPH_NODES:
            raise ModelError("holds more than a model does")
        for batch in (LARGEST_BATCH, 1):
            _check_shapes(model, batch, size)
    except ModelError:
        raise
    except Exception as error:
        raise ModelError(f"is no intact ONNX file ({type(error).__name__})") from error


def _check_fields(data: bytes, message: Any, before: int) -> int:
    """Look through a message without making it, which takes many times its own size; return what it holds."""
    allowed = _FIELDS[message.name]
    count = before
    for number, _, content in fields(data):
        known = message.fields_by_number.get(number)
        count += 1
        if known is None or known.name not in allowed:
            if known is not None and known.name in ("external_data", "data_location"):
                raise ModelError("keeps its weights in another file")
            name = f"field {number}" if known is None else known.name
            raise ModelError(f"has {name} of ONNX's {message.name} in it, which no network needs")
        if count > _MOST_FILE_FIELDS:
            raise ModelError("holds more than a model does")
        if known.message_type is not None:
            count = _check_fields(content, known.message_type, count)
        elif known.name.endswith("_data") and known.name != "raw_data" and len(content) > _LONGEST_NUMBERS:
            raise ModelError("holds more than a model does")
    return count


def _check_tensors(model: onnx.ModelProto) -> None:
    attributes = [field for node in model.graph.node for field in node.attribute]
    for tensor in [*model.graph.initializer, *[field.t for field in attributes if field.HasField("t")]]:
        item = _ONNX_ITEM_SIZES.get(tensor.data_type)
        count = math.prod(tensor.dims)
        if item is None or any(size < 0 for size in tensor.dims):
            raise ModelError(f"has weights of a type that no network needs: {tensor.name[:80]}")
        listed = [*[len(tensor.float_data), len(tensor.int32_data)]]
        listed += [len(tensor.int64_data), len(tensor.double_data)]
        held = len(tensor.raw_data) // item if tensor.raw_data else sum(listed)
        if held != count or (tensor.raw_data and (any(listed) or len(tensor.raw_data) != count * item)):
            raise ModelError(f"has weights that are cut short: {tensor.name[:80]}")


def _check_shapes(model: onnx.ModelProto, batch: int, size: int) -> None:
    """Bound the nodes' outputs for this many observations, by ONNX's inference of shapes."""
    weights = {tensor.name for tensor in model.graph.initializer}
    given = [one for one in model.graph.input if one.name not in weights]
    if len(given) != 1:
        raise ModelError("does not take one array of single precision and answer one")
    types, shapes = _inferred(model, given[0].name, [batch, size])
    taken = work = 0
    for node in model.graph.node:
        for name in node.output:
            shape = shapes.get(name)
            if name and (shape is None or min(shape, default=0) < 0):
                raise ModelError(f"has a size in it that depends on more than its input: {name[:80]}")
            if name and types.get(name) not in _ONNX_ITEM_SIZES:
                raise ModelError(f"has values of a type that no network needs: {name[:80]}")
            taken += 8 * math.prod(shape or ())
        work += _work(node, shapes, types)
    if taken > MAX_OUTPUT_BYTES or work > largest_work(batch):
        raise ModelError("takes more memory or time than a model does")
    _check_divisions(model.graph, types)


_Types = dict[str, int]
_Shapes = dict[str, list[int]]


def _inferred(model: onnx.ModelProto, given: str, shape: list[int]) -> tuple[_Types, _Shapes]:
    """Return the types and shapes of all values, as far as they do not depend on what is observed.

    Some shapes follow from numbers that the graph calculates. ONNX finds these out as well, but makes
    room for as many as a vector has entries: so it does as far as the vectors are known, and further.
    """
    import onnx

    trial = onnx.ModelProto()
    trial.CopyFrom(model)
    del trial.graph.value_info[:], trial.graph.output[:]
    for one in trial.graph.input:
        if one.name == given:
            one.CopyFrom(onnx.helper.make_tensor_value_info(given, onnx.TensorProto.FLOAT, shape))
    nodes = list(model.graph.node)
    types, shapes = _infer(trial, calculate=False)
    done = -1
    while done < len(nodes):
        known = _known(nodes, shapes)
        if known <= done:
            raise ModelError(
                f"has a size in it that depends on more than its input: {nodes[known].input[0][:80]}"
            )
        done = known
        vectors = [shapes.get(name, []) for node in nodes[:done] for name in [*node.input, *node.output]]
        if sum([sum(each) for each in vectors if len(each) == 1]) > _MOST_ENTRIES:
            raise ModelError("has longer vectors in it than a network needs")
        del trial.graph.node[:]
        trial.graph.node.extend(nodes[:done])
        more = _infer(trial, calculate=True)
        types |= more[0]
        shapes |= more[1]
    return types, shapes


def _known(nodes: Sequence[onnx.NodeProto], shapes: _Shapes) -> int:
    """Return how many nodes, from the first on, take nothing whose shape is unknown."""
    for place, node in enumerate(nodes):
        if any(name and min(shapes.get(name, [-1]), default=0) < 0 for name in node.input):
            return place
    return len(nodes)


def _infer(model: onnx.ModelProto, calculate: bool) -> tuple[_Types, _Shapes]:
    import onnx

    try:
        told = onnx.shape_inference.infer_shapes(model, strict_mode=True, data_prop=calculate).graph
    except Exception as error:
        raise ModelError(
            f"has shapes in it that do not fit: {str(error).strip().splitlines()[0][:200]}"
        ) from error
    values = [*told.input, *told.value_info, *told.output]
    types = {one.name: one.type.tensor_type.elem_type for one in values}
    shapes = {
        one.name: [
            dim.dim_value if dim.HasField("dim_value") else -1 for dim in one.type.tensor_type.shape.dim
        ]
        for one in values
        if one.type.tensor_type.HasField("shape")
    }
    for tensor in model.graph.initializer:
        types[tensor.name], shapes[tensor.name] = tensor.data_type, list(tensor.dims)
    return types, shapes


def _work(node: onnx.NodeProto, shapes: Mapping[str, list[int]], types: Mapping[str, int]) -> int:
    """Return how long a node takes, in multiplications of a product of matrices."""
    taken = [shapes.get(name, []) for name in node.input]
    made = sum([math.prod(shapes.get(name, [])) for name in node.output])
    if node.op_type in _RECURRENT:
        return RECURRENT_GATES * made * max([length for shape in taken for length in shape], default=1)
    if node.op_type not in ("Gemm", "MatMul"):
        return ELEMENT * max(sum([math.prod(shape) for shape in taken]), made)
    # The axis that both factors have is no longer than the longest of either.
    steps = made * min([max(shape, default=1) for shape in taken[:2]], default=1)
    return ELEMENT * made + (steps if types.get(node.input[0]) == _ONNX_FLOAT else OTHER_TYPE * steps)


def _check_divisions(graph: onnx.GraphProto, types: Mapping[str, int]) -> None:
    """Refuse to divide integers by what may be 0 or -1, which ends the process."""
    from onnx import numpy_helper

    known = {tensor.name: tensor for tensor in graph.initializer}
    known |= {
        node.output[0]: field.t
        for node in graph.node
        for field in node.attribute
        if node.op_type == "Constant" and field.name == "value"
    }
    for node in graph.node:
        if node.op_type not in _DIVISIONS or types.get(node.output[0]) in _FLOATS:
            continue
        divisor = known.get(node.input[1])
        if divisor is None or np.isin(numpy_helper.to_array(divisor), (0, -1)).any():
            where = f"{node.op_type} {node.name or node.output[0]}"
            raise ModelError(f"divides integers by what may be 0 or -1, at {where[:80]}")
