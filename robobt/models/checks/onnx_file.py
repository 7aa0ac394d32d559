"""The look at an ONNX file before onnxruntime sees it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from robobt.models.file import ModelError
from robobt.models.protobuf import fields

if TYPE_CHECKING:
    import onnx

MAX_BYTES = 64 * 2**20
"""What all steps of a network may answer together, whatever runs it, for a small batch [bytes]."""

MAX_PRODUCTS = 10**10
"""How many multiplications all steps of a network may take together, for a small batch."""

_NODES = """
Abs Add And Atan BatchNormalization Cast Celu Clip Concat Constant ConstantOfShape Cos Div Dropout Elu Equal
Erf Exp Expand Flatten GRU Gather Gelu Gemm Greater GreaterOrEqual HardSigmoid HardSwish Identity LSTM
LayerNormalization LeakyRelu Less LessOrEqual Log LogSoftmax MatMul Max Mean Min Mish Mul Neg Not Or PRelu
Pow RNN Reciprocal ReduceL2 ReduceMax ReduceMean ReduceMin ReduceProd ReduceSum Relu Reshape Selu Shape
Sigmoid Sign Sin Slice Softmax Softplus Softsign Split Sqrt Squeeze Sub Sum Tan Tanh Transpose Unsqueeze
Where
"""
_OPERATIONS = frozenset(_NODES.split())

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

_MOST_FIELDS = 50_000
_LONGEST_NUMBERS = 2**20
_MOST_NODES = 2000
_ITEM_SIZES = {1: 4, 2: 1, 3: 1, 6: 4, 7: 8, 9: 1, 10: 2, 11: 8}
"""Bytes of an item by ONNX's number of the type: no texts, and nothing exotic."""


def check_onnx(content: bytes, batch: int, size: int) -> None:
    """Check that an ONNX file consists of plain operations, with bounded answers and all weights in it.

    ``content`` is the file without card and seal; it will be tried on ``batch`` observations of ``size``
    numbers.
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
        if len(model.graph.node) > _MOST_NODES:
            raise ModelError("holds more than a model does")
        _check_shapes(model, batch, size)
        _check_shapes(model, 1, size)
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
        if count > _MOST_FIELDS:
            raise ModelError("holds more than a model does")
        if known.message_type is not None:
            count = _check_fields(content, known.message_type, count)
        elif known.name.endswith("_data") and known.name != "raw_data" and len(content) > _LONGEST_NUMBERS:
            raise ModelError("holds more than a model does")
    return count


def _check_tensors(model: onnx.ModelProto) -> None:
    attributes = [field for node in model.graph.node for field in node.attribute]
    for tensor in [*model.graph.initializer, *[field.t for field in attributes if field.HasField("t")]]:
        item = _ITEM_SIZES.get(tensor.data_type)
        count = math.prod(tensor.dims)
        if item is None or any(size < 0 for size in tensor.dims):
            raise ModelError(f"has weights of a type that no network needs: {tensor.name[:80]}")
        listed = [*[len(tensor.float_data), len(tensor.int32_data)]]
        listed += [len(tensor.int64_data), len(tensor.double_data)]
        held = len(tensor.raw_data) // item if tensor.raw_data else sum(listed)
        if held != count or (tensor.raw_data and (any(listed) or len(tensor.raw_data) != count * item)):
            raise ModelError(f"has weights that are cut short: {tensor.name[:80]}")


def _check_shapes(model: onnx.ModelProto, batch: int, size: int) -> None:
    """Bound what the nodes answer to so many observations, by ONNX's own inference of shapes."""
    import onnx

    weights = {tensor.name for tensor in model.graph.initializer}
    given = [one for one in model.graph.input if one.name not in weights]
    if len(given) != 1:
        raise ModelError("does not take one array of single precision and answer one")
    trial = onnx.ModelProto()
    trial.CopyFrom(model)
    del trial.graph.value_info[:]
    for one in trial.graph.input:
        if one.name == given[0].name:
            one.CopyFrom(onnx.helper.make_tensor_value_info(one.name, onnx.TensorProto.FLOAT, [batch, size]))
    for one in trial.graph.output:
        one.type.tensor_type.ClearField("shape")
    try:
        told = onnx.shape_inference.infer_shapes(trial, strict_mode=True, data_prop=True).graph
    except Exception as error:
        raise ModelError(
            f"has shapes in it that do not fit: {str(error).strip().splitlines()[0][:200]}"
        ) from error
    shapes = {
        one.name: [
            dim.dim_value if dim.HasField("dim_value") else -1 for dim in one.type.tensor_type.shape.dim
        ]
        for one in [*told.input, *told.value_info, *told.output]
        if one.type.tensor_type.HasField("shape")
    }
    shapes |= {tensor.name: list(tensor.dims) for tensor in model.graph.initializer}
    taken = products = 0
    for node in told.node:
        longest = max([length for name in node.input for length in shapes.get(name, [])], default=1)
        for name in node.output:
            shape = shapes.get(name)
            if name and (shape is None or min(shape, default=0) < 0):
                raise ModelError(f"has a size in it that depends on more than its input: {name[:80]}")
            count = math.prod(shape or ())
            taken += 8 * count
            products += count * longest
    if taken > MAX_BYTES or products > MAX_PRODUCTS:
        raise ModelError("takes more memory or time than a model does")
