"""An ONNX file holds all its weights and plain operations, and takes no more than a network does."""

from __future__ import annotations

import resource
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from tests.models.made_models import onnx_model, sealed_onnx

PRODUCT = helper.make_node("MatMul", ["observation", "weights"], ["sum"])
SQUASH = helper.make_node("Tanh", ["sum"], ["output"])


def weights(value: float = 0.1) -> TensorProto:
    return numpy_helper.from_array(np.full((6, 3), value, dtype=np.float32), "weights")


def plain() -> onnx.ModelProto:
    return onnx_model([PRODUCT, SQUASH], [weights()])


def sparse(location: str | None = None) -> onnx.SparseTensorProto:
    values = helper.make_tensor("weights", TensorProto.FLOAT, [2], [0.1, 0.2])
    if location is not None:
        values.ClearField("float_data")
        values.data_location = TensorProto.EXTERNAL
        values.external_data.add(key="location", value=location)
    indices = helper.make_tensor("weights_indices", TensorProto.INT64, [2], [0, 4])
    return helper.make_sparse_tensor(values, indices, [6, 3])


def sparse_initializer(model: onnx.ModelProto, location: str | None) -> None:
    model.graph.sparse_initializer.append(sparse(location))
    del model.graph.initializer[:]


def sparse_value(model: onnx.ModelProto, location: str | None) -> None:
    node = helper.make_node("Constant", [], ["weights"])
    node.attribute.append(helper.make_attribute("sparse_value", sparse(location)))
    model.graph.node.insert(0, node)
    del model.graph.initializer[:]


def external(model: onnx.ModelProto, location: str | None) -> None:
    tensor = model.graph.initializer[0]
    tensor.ClearField("raw_data")
    tensor.data_location = TensorProto.EXTERNAL
    tensor.external_data.add(key="location", value=location or "")


def external_constant(model: onnx.ModelProto, location: str | None) -> None:
    external(model, location)
    node = helper.make_node("Constant", [], ["weights"])
    node.attribute.append(helper.make_attribute("value", model.graph.initializer[0]))
    model.graph.node.insert(0, node)
    del model.graph.initializer[:]


def unmarked(model: onnx.ModelProto, location: str | None) -> None:
    external(model, location)
    model.graph.initializer[0].ClearField("data_location")


@pytest.mark.parametrize(
    "location",
    ["/etc/hostname", "secret.bin", "../secret.bin", "./a/../secret.bin", "*/_ORT_MEM_ADDR_/*", None],
)
@pytest.mark.parametrize("where", [sparse_initializer, sparse_value, external, external_constant, unmarked])
def test_weights_from_elsewhere_are_refused(
    where: Callable[[onnx.ModelProto, str | None], None], location: str | None, tmp_path: Path
) -> None:
    (tmp_path / "secret.bin").write_bytes(bytes(72))
    model = plain()
    where(model, location)
    with pytest.raises(ModelError, match=r"another file|no network needs"):
        load_policy(sealed_onnx(tmp_path, model))


def test_the_plain_model_that_the_attacks_start_from_is_loaded(tmp_path: Path) -> None:
    assert load_policy(sealed_onnx(tmp_path, plain()))(np.zeros(6)).tolist() == [0.0] * 3


def graph_in_a_node(model: onnx.ModelProto) -> None:
    model.graph.node[0].attribute.append(helper.make_attribute("body", model.graph))


def function(model: onnx.ModelProto) -> None:
    opset = [helper.make_opsetid("", 17)]
    model.functions.append(helper.make_function("mine", "F", ["x"], ["y"], [SQUASH], opset))


def training(model: onnx.ModelProto) -> None:
    model.training_info.add()


def foreign_domain(model: onnx.ModelProto) -> None:
    model.graph.node[1].domain = "com.microsoft"


def texts(model: onnx.ModelProto) -> None:
    model.graph.initializer.append(helper.make_tensor("s", TensorProto.STRING, [1], [b"a"]))


def empty_but_large(model: onnx.ModelProto) -> None:
    tensor = model.graph.initializer[0]
    tensor.ClearField("raw_data")
    del tensor.dims[:]
    tensor.dims.extend([6, 10**10])


def short(model: onnx.ModelProto) -> None:
    model.graph.initializer[0].raw_data = model.graph.initializer[0].raw_data[:-4]


def negative(model: onnx.ModelProto) -> None:
    model.graph.initializer[0].dims[0] = -6


def packed_numbers(model: onnx.ModelProto) -> None:
    model.graph.initializer.append(helper.make_tensor("many", TensorProto.INT64, [2**21], [0] * 2**21))


def many_nodes(model: onnx.ModelProto) -> None:
    model.graph.node.extend([onnx.NodeProto()] * 200_000)


def odd_names(model: onnx.ModelProto) -> None:
    model.graph.node[0].op_type = "two\nlines"


def loop(model: onnx.ModelProto) -> None:
    model.graph.node[0].op_type = "Loop"


@pytest.mark.integration
@pytest.mark.parametrize(
    "change",
    [
        graph_in_a_node,
        function,
        training,
        foreign_domain,
        texts,
        empty_but_large,
        short,
        negative,
        packed_numbers,
        many_nodes,
        loop,
        odd_names,
    ],
)
def test_what_no_network_needs_is_refused(change: Callable[[onnx.ModelProto], None], tmp_path: Path) -> None:
    model = plain()
    change(model)
    with pytest.raises(ModelError, match=r"crafted\.onnx: ") as caught:
        load_policy(sealed_onnx(tmp_path, model))
    assert "\n" not in str(caught.value)


def constant(name: str, values: list[int]) -> TensorProto:
    return numpy_helper.from_array(np.array(values, dtype=np.int64), name)


def doubled(axis: int, count: int = 40) -> onnx.ModelProto:
    nodes = [
        PRODUCT,
        *[helper.make_node("Concat", [f"x{i}"] * 2, [f"x{i + 1}"], axis=axis) for i in range(count)],
    ]
    nodes[0] = helper.make_node("MatMul", ["observation", "weights"], ["x0"])
    nodes.append(helper.make_node("ReduceMax", [f"x{count}"], ["m"], axes=[1], keepdims=1))
    nodes.append(helper.make_node("Mul", ["x0", "m"], ["sum"]))
    return onnx_model([*nodes, SQUASH], [weights()])


def doubled_constants() -> onnx.ModelProto:
    nodes = [helper.make_node("Concat", [f"c{i}"] * 2, [f"c{i + 1}"], axis=0) for i in range(40)]
    nodes.append(helper.make_node("ReduceMax", ["c40"], ["m"], keepdims=1))
    nodes += [
        PRODUCT,
        helper.make_node("Mul", ["sum", "m"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    return onnx_model(nodes, [weights(), numpy_helper.from_array(np.ones((64, 64), np.float32), "c0")])


def expanded() -> onnx.ModelProto:
    nodes = [
        PRODUCT,
        helper.make_node("Expand", ["one", "shape"], ["large"]),
        helper.make_node("ReduceMax", ["large"], ["m"], keepdims=0),
        helper.make_node("Mul", ["sum", "m"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    one = numpy_helper.from_array(np.ones((1, 1), np.float32), "one")
    return onnx_model(nodes, [weights(), one, constant("shape", [100_000, 100_000])])


def as_an_observation_says() -> onnx.ModelProto:
    nodes = [
        PRODUCT,
        helper.make_node("ReduceMax", ["observation"], ["top"], keepdims=0),
        helper.make_node("Cast", ["top"], ["count"], to=TensorProto.INT64),
        helper.make_node("Unsqueeze", ["count", "first"], ["shape"]),
        helper.make_node("ConstantOfShape", ["shape"], ["large"]),
        helper.make_node("ReduceSum", ["large"], ["m"], keepdims=0),
        helper.make_node("Mul", ["sum", "m"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    return onnx_model(nodes, [weights(), constant("first", [0])])


def product_of_integers() -> onnx.ModelProto:
    nodes = [
        PRODUCT,
        helper.make_node("Expand", ["one", "shape"], ["large"]),
        helper.make_node("MatMul", ["large", "large"], ["larger"]),
        helper.make_node("Cast", ["larger"], ["numbers"], to=TensorProto.FLOAT),
        helper.make_node("ReduceMax", ["numbers"], ["m"], keepdims=0),
        helper.make_node("Mul", ["sum", "m"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    return onnx_model(nodes, [weights(), constant("one", [1]), constant("shape", [900, 900])])


def long_vector(calculated: bool) -> onnx.ModelProto:
    nodes = [
        PRODUCT,
        helper.make_node("Shape", ["observation"], ["size"]),
        helper.make_node("Gather", ["size", "first"], ["count"]),
        helper.make_node("Mul", ["count", "times"], ["calculated"]),
        helper.make_node("Expand", ["one", "calculated" if calculated else "times"], ["long"]),
        helper.make_node("Cast", ["long"], ["numbers"], to=TensorProto.INT64),
        helper.make_node("Cast", ["numbers"], ["back"], to=TensorProto.FLOAT),
        helper.make_node("ReduceMax", ["back"], ["m"], keepdims=0),
        helper.make_node("Mul", ["sum", "m"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    one = numpy_helper.from_array(np.ones(1, np.float32), "one")
    return onnx_model(nodes, [weights(), one, constant("first", [1]), constant("times", [10_000_000])])


BOMBS = {
    "a long vector": lambda: long_vector(False),
    "a long vector of a calculated size": lambda: long_vector(True),
    "a product of integers": product_of_integers,
    "doubled columns": lambda: doubled(1),
    "doubled rows": lambda: doubled(0),
    "doubled constants": doubled_constants,
    "expanded": expanded,
    "as large as an observation says": as_an_observation_says,
}


@pytest.mark.parametrize("what", BOMBS)
def test_a_network_that_would_fill_the_memory_is_refused(what: str, tmp_path: Path) -> None:
    unit = 1 if sys.platform == "darwin" else 1024
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    with pytest.raises(ModelError, match=r"memory or time|depends on more|shapes in it|longer vectors"):
        load_policy(sealed_onnx(tmp_path, BOMBS[what]()))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit - before < 200e6


def divided(kind: str, divisor: int | None, to: int) -> onnx.ModelProto:
    """The plain model with a division of integers that adds nothing; None: by what an observation says."""
    far = numpy_helper.from_array(np.array(9.0, dtype=np.float32), "far")
    numbers = numpy_helper.from_array(
        np.array(divisor or 0, dtype=helper.tensor_dtype_to_np_dtype(to)), "divisor" if divisor else "nought"
    )
    nodes = [
        PRODUCT,
        helper.make_node("Cast", ["observation"], ["integers"], to=to),
        helper.make_node("Greater", ["observation", "far"], ["beyond"]),
        helper.make_node("Cast", ["beyond"], ["unusual"], to=to),
        helper.make_node(kind, ["integers", "divisor" if divisor else "unusual"], ["quotient"]),
        helper.make_node("ReduceMax", ["quotient"], ["most"], keepdims=0),
        helper.make_node("Cast", ["most"], ["m"], to=TensorProto.FLOAT),
        helper.make_node("Clip", ["m", "zero", "zero"], ["none"]),
        helper.make_node("Add", ["sum", "none"], ["z"]),
        helper.make_node("Tanh", ["z"], ["output"]),
    ]
    zero = numpy_helper.from_array(np.array(0.0, dtype=np.float32), "zero")
    return onnx_model(nodes, [weights(), zero, far, numbers])


@pytest.mark.parametrize("to", [TensorProto.INT64, TensorProto.INT32])
@pytest.mark.parametrize("divisor", [-1, None])
@pytest.mark.parametrize("kind", ["Div", "Mod"])
def test_a_division_of_integers_that_may_end_the_process_is_refused(
    kind: str, divisor: int | None, to: int, tmp_path: Path
) -> None:
    with pytest.raises(ModelError, match=f"divides integers by what may be 0 or -1, at {kind} quotient"):
        load_policy(sealed_onnx(tmp_path, divided(kind, divisor, to)))


@pytest.mark.parametrize("kind", ["Div", "Mod"])
def test_a_division_of_integers_by_a_constant_is_loaded(kind: str, tmp_path: Path) -> None:
    loaded = load_policy(sealed_onnx(tmp_path, divided(kind, 2, TensorProto.INT64)))
    for value in (0.0, 9.5, 1e9, -np.inf, np.nan):
        loaded(np.full((3, 6), value))


def test_a_divisor_of_zeros_is_refused(tmp_path: Path) -> None:
    model = divided("Div", 2, TensorProto.INT64)
    model.graph.initializer[-1].CopyFrom(constant("divisor", [1, 2, 3, 0, 1, 1]))
    with pytest.raises(ModelError, match="divides integers"):
        load_policy(sealed_onnx(tmp_path, model))
