"""Model files full of integers, divisions, shifts, shapes and loops, the same for the same seed."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from tests.models.checks.test_hostile_torchscript import PLAIN, plain
from tests.models.made_models import onnx_model, sealed_onnx

SMALL = [1, 2, 3, 4, 6]
LARGE = [
    0,
    0,
    -1,
    -1,
    -1,
    -1,
    -2,
    7,
    64,
    1000,
    10**5,
    10**7,
    10**9,
    2**31 - 1,
    -(2**31),
    2**63 - 1,
    -(2**63) + 1,
]

FOREIGN = ["from_file", "fill_", "save", "load", "copy_", "set_", "resize_", "rand", "tensor", "tile", "eval"]


def torchscript_file(folder: Path, seed: int) -> Path:
    """A file in TorchScript."""
    return plain(folder, _Script(random.Random(seed)).module())


def onnx_file(folder: Path, seed: int) -> Path:
    """A file in ONNX."""
    return sealed_onnx(folder, _Graph(random.Random(seed)).model())


class _Script:
    """Writes one module, with names by the types of what they stand for."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.names = {"float": ["observation"], "int": ["i0"], "size": ["n0"]}
        self.lines = ["i0 = torch.to(observation, 4)", "n0 = torch.size(observation, 1)"]
        self.made = 0

    def module(self) -> str:
        for _ in range(self.rng.randrange(1, 7)):
            self.rng.choice(_STATEMENTS)(self)
        used = ["_1"]
        for kind in ("float", "int"):
            for name in self.names[kind][-2:]:
                # An output of zeros, whatever the numbers are.
                told = f"torch.gt(torch.sum(torch.to({name}, 6)), 1.)"
                used.append(f"torch.mul(torch.to({told}, 6), 0.)")
        answer = used[0]
        for one in used[1:]:
            answer = f"torch.add({answer}, {one})"
        for name in self.names["size"][1:]:
            answer = f"torch.add({answer}, torch.mul({name}, 0))"
        body = "\n".join([f"    {line}" for line in self.lines])
        return PLAIN.replace("    return _1\n", f"{body}\n    return {answer}\n")

    def number(self) -> int:
        return self.rng.choice(SMALL if self.rng.random() < 0.75 else LARGE)

    def pick(self, kind: str) -> str:
        return self.rng.choice(self.names[kind][-3:])

    def size(self) -> str:
        return self.pick("size") if self.rng.random() < 0.4 else str(self.number())

    def new(self, kind: str, expression: str) -> None:
        self.made += 1
        name = f"v{self.made}"
        self.lines.append(f"{name} = {expression}")
        self.names[kind].append(name)

    def arithmetic(self) -> None:
        kind = self.rng.choice(["float", "int"])
        operation = self.rng.choice(["add", "sub", "mul", "maximum", "minimum", "pow", "tanh", "abs", "neg"])
        operands = (
            [self.pick(kind)] if operation in ("tanh", "abs", "neg") else [self.pick(kind) for _ in "ab"]
        )
        made = "float" if operation == "tanh" else kind
        self.new(made, f"torch.{operation}({', '.join(operands)})")

    def cast(self) -> None:
        if self.rng.random() < 0.1:
            self.new("int", f"torch.to({self.pick('float')}, {self.number()})")
            return
        bound = self.rng.choice(["1.", "9.", "1000."])
        self.new(
            "int",
            self.rng.choice(
                [
                    f"torch.to({self.pick('float')}, {self.rng.choice([0, 1, 2, 3, 4])})",
                    f"torch.to(torch.gt({self.pick('float')}, {bound}), {self.rng.choice([3, 4])})",
                    f"torch.argmax({self.pick('float')}, 1, True)",
                ]
            ),
        )

    def division(self) -> None:
        kind = self.rng.choice(["int", "int", "float"])
        far = f"torch.to(torch.gt(observation, {self.rng.choice(['9.', '1e8'])}), {self.rng.choice([3, 4])})"
        divisor = self.rng.choice(
            [
                self.pick("int"),
                f"torch.sub({far}, 1)",
                f"torch.sub(1, torch.mul({far}, {self.rng.choice([1, 2])}))",
                f"torch.full([1], {self.number()}, dtype={self.rng.choice([3, 4])})",
                self.size(),
                *[str(self.number())] * 4,
            ]
        )
        operation = self.rng.choice(["remainder", "fmod", "floor_divide", "div", "div", "div"])
        mode = ""
        if operation == "div":
            mode = f', rounding_mode="{self.rng.choice(["floor", "trunc", "trunc"])}"'
        self.new(kind, f"torch.{operation}({self.pick(kind)}, {divisor}{mode})")

    def shift(self) -> None:
        operation = self.rng.choice(
            ["__lshift__", "__rshift__", "bitwise_left_shift", "bitwise_and", "pow", "mul"]
        )
        self.new("int", f"torch.{operation}({self.pick('int')}, {self.size()})")

    def size_arithmetic(self) -> None:
        self.new(
            "size",
            self.rng.choice(
                [
                    f"torch.size({self.pick('float')}, {self.rng.choice([0, 1, -1])})",
                    f"torch.size({self.pick('float')})[{self.rng.choice([0, 1, -1, 5])}]",
                    f"torch.mul({self.size()}, {self.size()})",
                    f"torch.sub({self.size()}, {self.number()})",
                    f"torch.add({self.size()}, {self.size()})",
                    f"torch.floordiv({self.pick('size')}, {self.size()})",
                    f"torch.remainder({self.size()}, {self.size()})",
                    f"torch.remainder({self.number()}, torch.sub({self.size()}, {self.number()}))",
                    f"torch.pow({self.size()}, {self.size()})",
                    f"torch.len({self.pick('float')})",
                ]
            ),
        )

    def shape(self) -> None:
        a, b, x = self.size(), self.size(), self.pick("float")
        self.new(
            "float",
            self.rng.choice(
                [
                    f"torch.zeros([{a}, {b}])",
                    f"torch.ones([{a}], dtype={self.rng.choice([6, 6, 7, self.number()])})",
                    f"torch.full([{a}, 1], {b})",
                    f"torch.arange({a})",
                    f"torch.arange({a}, {b}, {self.size()}, dtype=6)",
                    f"torch.expand(torch.zeros([1]), [{a}, {b}])",
                    f"torch.repeat({x}, [{a}, {b}])",
                    f"torch.new_zeros({x}, [{a}, {b}])",
                    f"torch.reshape({x}, [{a}, -1])",
                    f"torch.reshape({x}, [torch.size({x}, 0), -1])",
                    f"torch.slice({x}, 1, {a}, {b}, {self.number()})",
                    f"torch.narrow({x}, 1, {a}, {b})",
                    f"torch.cat([{x}, {x}], {self.rng.choice([0, 1])})",
                    f"torch.transpose({x}, 0, 1)",
                    f"torch.matmul(torch.transpose({x}, 0, 1), {x})",
                    f"torch.cumsum({x}, 1)",
                    f"torch.unsqueeze({x}, {self.rng.choice([0, 1, 2])})",
                ]
            ),
        )

    def pieces(self) -> None:
        self.made += 1
        x = self.rng.choice([self.pick("float"), f"torch.expand(torch.zeros([1]), [{self.size()}])"])
        cut = self.rng.choice(
            [
                f"torch.split({x}, {self.size()}, {self.rng.choice([0, -1])})",
                f"torch.chunk({x}, {self.size()}, {self.rng.choice([0, -1])})",
                f"torch.unbind({x}, {self.rng.choice([0, -1])})",
            ]
        )
        self.lines.append(f"l{self.made} = {cut}")
        self.new("float", f"l{self.made}[0]")

    def indices(self) -> None:
        x, i = self.pick("float"), self.pick("int")
        self.new(
            "float",
            self.rng.choice(
                [
                    f"torch.gather({x}, 1, {i})",
                    f"torch.index({x}, annotate(List[Optional[Tensor]], [torch.slice({i}, 0, 0, 1)]))",
                    f"torch.to(torch.one_hot({i}, {self.number()}), 6)",
                    f"torch.embedding(torch.ones([{self.size()}, 2]), {i})",
                    f"torch.index_select({x}, 1, torch.arange({self.size()}))",
                    f"torch.where(torch.gt({x}, 9.), {x}, {x})",
                ]
            ),
        )

    def loop(self) -> None:
        x, count = self.pick("float"), self.size()
        self.made += 1
        head = self.rng.choice(
            [
                f"for k{self.made} in range({count}):",
                f"for k{self.made} in range(torch.len(torch.size({x}))):",
                f"for k{self.made} in range(torch.len(torch.expand(torch.zeros([1]), [{count}]))):",
                "while True:",
            ]
        )
        name = f"w{self.made}"
        self.lines += [f"{name} = torch.tanh({x})", head, f"  {name} = torch.add({name}, {name})"]
        self.names["float"].append(name)

    def in_place(self) -> None:
        name = self.pick("float")
        if name == "observation":
            return
        operation = self.rng.choice(["tanh_", "sigmoid_", "relu_"])
        self.lines += [f"_i{self.made} = torch.{operation}({name})"] * self.rng.choice([1, 1, 2, 30])

    def recurrent(self) -> None:
        x, hidden = f"torch.unsqueeze({self.pick('float')}, 1)", self.size()
        weights = f"[torch.ones([{3 * self.number()}, 6]), torch.ones([{3 * self.number()}, {hidden}])]"
        state = f"torch.zeros([1, torch.size(observation, 0), {hidden}])"
        self.made += 1
        layers = self.rng.choice([1, 1, self.number()])
        call = f"torch.gru({x}, {state}, {weights}, False, {layers}, 0., False, False, True)"
        self.lines.append(f"g{self.made}, h{self.made} = {call}")
        self.names["float"].append(f"g{self.made}")

    def norm(self) -> None:
        x = self.pick("float")
        self.new(
            "float",
            self.rng.choice(
                [
                    f"torch.batch_norm({x}, None, None, None, None, True, 0.1, 1e-5, False)",
                    f"torch.layer_norm({x}, [{self.size()}], None, None, 1e-5)",
                    f"torch.softmax({x}, {self.rng.choice([0, 1, -1, 5])})",
                    f"torch.mean({x}, [{self.rng.choice([0, 1, 3])}], True)",
                    f"torch.amax({x}, [1], True)",
                ]
            ),
        )

    def foreign(self) -> None:
        """What no network needs, as the reading and writing of files."""
        self.new("float", f"torch.{self.rng.choice(FOREIGN)}({self.pick('float')}, {self.size()})")

    def complaint(self) -> None:
        told = self.rng.choice([self.pick("size"), self.pick("size"), self.pick("float")])
        self.lines += [
            f"if torch.eq(torch.size(observation, 0), {self.number()}):",
            f'  ops.prim.RaiseException(torch.format("{{}}", {told}), "builtins.ValueError")',
            "else:",
            "  pass",
        ]


_STATEMENTS: list[Callable[[_Script], None]] = [
    _Script.arithmetic, _Script.arithmetic, _Script.cast, _Script.cast, _Script.division, _Script.division,
    _Script.shift, _Script.size_arithmetic, _Script.size_arithmetic, _Script.shape, _Script.shape,
    _Script.pieces, _Script.indices, _Script.loop, _Script.in_place, _Script.recurrent, _Script.norm,
    _Script.complaint, _Script.foreign,
]  # fmt: skip


class _Graph:
    """Builds one graph, with names by the types of what they stand for."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.nodes: list[onnx.NodeProto] = []
        self.weights = [numpy_helper.from_array(np.full((6, 3), 0.1, dtype=np.float32), "weights")]
        self.names = {"float": ["observation"], "int": [], "size": []}
        self.node("MatMul", ["observation", "weights"], "sum")
        self.node("Tanh", ["sum"], "act")
        self.node("Cast", ["observation"], "i0", to=TensorProto.INT64)
        self.node("Shape", ["observation"], "n0")
        self.names["int"].append("i0")
        self.names["size"].append("n0")

    def model(self) -> onnx.ModelProto:
        for _ in range(self.rng.randrange(1, 7)):
            self.rng.choice(_PARTS)(self)
        answer, one, zero = "act", self.constant(1.0, np.float32), self.constant(0.0, np.float32)
        used = [name for kind in ("float", "int", "size") for name in self.names[kind][-2:]]
        for place, name in enumerate(used):
            # An output of zeros, whatever the numbers are.
            self.node("Cast", [name], f"u{place}", to=TensorProto.FLOAT)
            self.node("ReduceSum", [f"u{place}"], f"s{place}", keepdims=0)
            self.node("Greater", [f"s{place}", one], f"g{place}")
            self.node("Where", [f"g{place}", zero, zero], f"z{place}")
            self.node("Add", [answer, f"z{place}"], f"a{place}")
            answer = f"a{place}"
        self.node("Identity", [answer], "output")
        return onnx_model(self.nodes, self.weights)

    def node(self, kind: str, inputs: list[str], output: str, **attributes: object) -> None:
        self.nodes.append(helper.make_node(kind, inputs, [output], **attributes))

    def constant(self, value: object, kind: type = np.int64) -> str:
        name = f"c{len(self.weights)}"
        self.weights.append(numpy_helper.from_array(np.array(value, dtype=kind), name))
        return name

    def number(self) -> int:
        return self.rng.choice(SMALL if self.rng.random() < 0.75 else LARGE)

    def pick(self, kind: str) -> str:
        return self.rng.choice(self.names[kind][-3:])

    def new(self, made: str, kind: str, inputs: list[str], **attributes: object) -> None:
        name = f"v{len(self.nodes)}"
        self.node(kind, inputs, name, **attributes)
        self.names[made].append(name)

    def arithmetic(self) -> None:
        made = self.rng.choice(["float", "int", "size"])
        kind = self.rng.choice(["Add", "Sub", "Mul", "Pow", "Max", "Min"])
        self.new(made, kind, [self.pick(made), self.rng.choice([self.pick(made), self.like(made)])])

    def like(self, made: str) -> str:
        return self.constant(self.number(), np.float32 if made == "float" else np.int64)

    def cast(self) -> None:
        to = 7 if self.rng.random() < 0.85 else self.rng.choice([2, 3, 6, 6, 8, 9, 10, 99])
        self.new("int", "Cast", [self.pick("float")], to=to)

    def threshold(self) -> None:
        bound = self.constant(self.rng.choice([1.0, 9.0, 1000.0]), np.float32)
        self.node("Greater", [self.pick("float"), bound], f"t{len(self.nodes)}")
        self.new("int", "Cast", [self.nodes[-1].output[0]], to=TensorProto.INT64)

    def division(self) -> None:
        made = self.rng.choice(["int", "int", "size", "float"])
        kind = self.rng.choice(["Div", "Div", "Mod"])
        attributes = {"fmod": 1} if kind == "Mod" and made == "float" else {}
        divisor = self.like(made) if self.rng.random() < 0.7 else self.pick(made)
        if made == "int" and self.rng.random() < 0.3:
            self.threshold()
            # 1 for ordinary observations, 0 or -1 for some.
            twice = self.constant(self.rng.choice([1, 2]))
            self.node("Mul", [self.pick("int"), twice], f"t{len(self.nodes)}")
            self.node("Sub", [self.constant(1), self.nodes[-1].output[0]], f"t{len(self.nodes)}")
            divisor = self.nodes[-1].output[0]
        self.new(made, kind, [self.pick(made), divisor], **attributes)

    def shift(self) -> None:
        kind = self.rng.choice(["BitShift", "BitwiseAnd", "Mul", "Pow"])
        attributes = {"direction": "LEFT"} if kind == "BitShift" else {}
        self.new("int", kind, [self.pick("int"), self.like("int")], **attributes)

    def size(self) -> str:
        """The name of a shape."""
        if self.rng.random() < 0.5:
            return self.constant([self.number() for _ in range(self.rng.choice([1, 2, 2, 3]))])
        return self.pick("size")

    def shape(self) -> None:
        kind = self.rng.choice(["ConstantOfShape", "Expand", "Reshape", "Tile", "Resize", "Range", "Pad"])
        x = self.pick("float")
        if kind == "ConstantOfShape":
            self.new("float", kind, [self.size()])
        elif kind == "Range":
            inputs = [self.constant(self.number()) for _ in "abc"]
            self.new("int", kind, inputs)
        elif kind == "Expand":
            one = self.constant([1.0], np.float32)
            self.new("float", kind, [self.rng.choice([x, one]), self.size()])
        else:
            self.new("float", kind, [x, self.size()])

    def rearranged(self) -> None:
        x = self.pick("float")
        kind = self.rng.choice(["Transpose", "Concat", "Flatten", "Unsqueeze", "Slice", "Split", "Shape"])
        if kind == "Slice":
            inputs = [self.constant([self.number()]) for _ in range(4)]
            inputs[2] = self.constant([1])
            self.new("float", kind, [x, *inputs])
        elif kind == "Concat":
            self.new("float", kind, [x, x], axis=self.rng.choice([0, 1, -1, 7]))
        elif kind == "Unsqueeze":
            self.new("float", kind, [x, self.constant([self.number()])])
        elif kind == "Split":
            self.new("float", kind, [x, self.constant([self.number()])], axis=1)
        elif kind == "Shape":
            self.new("size", kind, [x])
        else:
            self.new("float", kind, [x])

    def reduced(self) -> None:
        kind = self.rng.choice(["ReduceMean", "ReduceMax", "ReduceProd", "ArgMax", "Softmax"])
        made = self.rng.choice(["float", "int"])
        answered = "int" if kind == "ArgMax" else made
        axis = self.rng.choice([0, 1, 1, -1, 5])
        attributes = {"axes": [axis]} if kind.startswith("Reduce") else {"axis": axis}
        self.new(answered, kind, [self.pick(made)], **attributes)

    def product(self) -> None:
        x = self.pick(self.rng.choice(["float", "int"]))
        self.node("Transpose", [x], f"t{len(self.nodes)}")
        self.new("float", "MatMul", [self.nodes[-1].output[0], x])

    def indices(self) -> None:
        kind = self.rng.choice(["Gather", "GatherElements"])
        self.new("float", kind, [self.pick("float"), self.pick("int")], axis=1)

    def loop(self) -> None:
        if self.rng.random() < 0.6:
            return
        body = helper.make_graph([helper.make_node("Identity", ["a"], ["b"])], "body", [], [])
        count, going = self.constant(self.number()), self.constant(True, np.bool_)
        self.new("float", "Loop", [count, going, self.pick("float")], body=body)

    def recurrent(self) -> None:
        hidden = self.rng.choice([1, 2, 3, abs(self.number()) % 50])
        self.node("Unsqueeze", ["observation", self.constant([0])], f"t{len(self.nodes)}")
        x = self.nodes[-1].output[0]
        w = self.constant(np.full((1, 3 * hidden, 6), 0.1), np.float32)
        r = self.constant(np.full((1, 3 * hidden, hidden), 0.1), np.float32)
        stated = hidden if self.rng.random() < 0.7 else self.number()
        self.new("float", "GRU", [x, w, r], hidden_size=stated)


_PARTS: list[Callable[[_Graph], None]] = [
    _Graph.arithmetic, _Graph.arithmetic, _Graph.cast, _Graph.threshold, _Graph.division, _Graph.division,
    _Graph.shift, _Graph.shape, _Graph.shape, _Graph.rearranged, _Graph.rearranged, _Graph.reduced,
    _Graph.product, _Graph.indices, _Graph.loop, _Graph.recurrent,
]  # fmt: skip
