"""Hostile model files by the thousand: each is loaded or refused in time, and nothing else happens."""

from __future__ import annotations

import os
import random
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

from robobt.models import policy
from robobt.models.checks.onnx_file import _OPERATIONS
from robobt.models.checks.operations import TORCH
from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from tests.campaign import count
from tests.models.checks.test_hostile_torchscript import BOMBS, CODE, PICKLES, PLAIN, PLAIN_STATE, plain
from tests.models.made_models import members_of, onnx_model, sealed, sealed_onnx

pytestmark = pytest.mark.slow


@contextmanager
def nothing_happens(folder: Path) -> Iterator[Path]:
    """Check that a file stays as it is, none is added and the memory stays bounded."""
    victim = folder / "victim"
    victim.write_bytes(b"precious" * 8)
    here = set(os.listdir())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield victim
    assert victim.read_bytes() == b"precious" * 8
    assert set(os.listdir()) == here
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 400_000


def loaded(path: Path) -> bool:
    """Whether it is; anything but a policy or a refusal, within 10 s, is an error."""
    policy._LOADED.clear()
    begun = time.process_time()
    said = ""
    try:
        load_policy(path)
    except ModelError as error:
        said = str(error)
    assert time.process_time() - begun < 10.0
    assert "\n" not in said
    return not said


_FOREIGN = """
from_file fill_ save load copy_ set_ resize_ rand randn tensor arange full repeat tile outer eval exec
"""
_PRIM = "RaiseException NumToTensor device dtype Print Import data rpc_async tolist unchecked_unwrap"
FOREIGN, PRIM = _FOREIGN.split(), _PRIM.split()


class Grammar:
    """Writes modules in torch's dialect: what a network may do, and what it may not."""

    def __init__(self, rng: random.Random, victim: Path) -> None:
        self.rng, self.victim = rng, victim
        self.names = ["observation"]

    def expression(self, depth: int = 0) -> str:
        rng = self.rng
        kind = rng.randrange(9 if depth < 4 else 2)
        if kind == 0:
            return rng.choice(self.names)
        if kind == 1:
            return rng.choice(
                ["0", "1", "-1", "3", "10000000", "0.5", "None", "True", "[1]", f'"{self.victim}"']
            )
        inner = ", ".join([self.expression(depth + 1) for _ in range(rng.randrange(1, 4))])
        if kind == 2:
            return f"[{inner}]"
        if kind == 3 and rng.random() < 0.5:
            return f"({self.expression(depth + 1)}).{rng.choice(FOREIGN)}({inner})"
        if kind == 4 and rng.random() < 0.5:
            return f"ops.{rng.choice(['prim', 'aten', 'mine'])}.{rng.choice(PRIM)}({inner})"
        if kind == 5 and rng.random() < 0.3:
            return f"torch.{rng.choice(FOREIGN)}({inner})"
        if kind == 6 and rng.random() < 0.3:
            return f"(self).{rng.choice(['forward', 'other', 'training'])}({inner})"
        return f"torch.{rng.choice(sorted(TORCH))}({inner})"

    def lines(self, indent: str, depth: int = 0) -> list[str]:
        rng, found = self.rng, []
        for _ in range(rng.randrange(1, 6)):
            kind = rng.randrange(12)
            if kind == 0 and depth < 2:
                found += [f"{indent}if {self.expression(3)}:", *self.lines(indent + "  ", depth + 1)]
                found += [f"{indent}else:", f"{indent}  pass"]
            elif kind == 1 and depth < 2:
                head = rng.choice(
                    ["while True:", "for i in range(1000000000):", "for i in range(torch.len([1])):"]
                )
                found += [indent + head, *self.lines(indent + "  ", depth + 1)]
            elif kind == 2 and rng.random() < 0.3:
                found.append(f"{indent}self.training = {self.expression(3)}")
            else:
                name = f"x{len(self.names)}"
                found.append(f"{indent}{name} = {self.expression()}")
                self.names.append(name)
        return found

    def module(self) -> str:
        rng = self.rng
        body = "\n".join(self.lines("    "))
        code = PLAIN.replace("    return _1\n", f"{body}\n    return _1\n")
        if rng.random() < 0.5:
            used = f"torch.mul(torch.sum({self.names[-1]}), 0)"
            code = code.replace("    return _1\n", f"    return torch.add(_1, {used})\n")
        if rng.random() < 0.4:
            name = rng.choice(["__setstate__", "__init__", "other", "__getstate__", "__del__", "__len__"])
            self.names = ["observation"]
            body = "\n".join(self.lines("    "))
            head = f"  def {name}(self: __torch__.Attack, observation: Tensor) -> Tensor:\n"
            code += f"{head}{body}\n    return observation\n"
        for old, new, _ in rng.sample(CODE, rng.choice([0, 0, 1])):
            code = code.replace(old, new, 1)
        return rng.choice(list(BOMBS.values())) if rng.random() < 0.05 else code


def test_torchscript_files_from_a_grammar(tmp_path: Path) -> None:
    rng, accepted = random.Random(11), 0
    with nothing_happens(tmp_path) as victim:
        for _ in range(count(3000)):
            state = PLAIN_STATE if rng.random() < 0.8 else rng.choice(list(PICKLES.values()))
            accepted += loaded(plain(tmp_path, Grammar(rng, victim).module(), state))
    print(f"{accepted} of {count(3000)} were loaded")


def random_onnx(rng: random.Random, victim: Path) -> onnx.ModelProto:
    """A graph of plain and foreign nodes, with shapes, constants and places of weights that make no sense."""
    foreign = [
        "Loop",
        "If",
        "Scan",
        "RandomUniform",
        "Range",
        "Tile",
        "Pad",
        "Resize",
        "NonZero",
        "StringSplit",
    ]
    nodes = [helper.make_node("MatMul", ["observation", "weights"], ["sum"])]
    names = ["observation", "weights", "shape", "sum"]
    for place in range(rng.randrange(12)):
        kind = rng.choice(foreign) if rng.random() < 0.05 else rng.choice(sorted(_OPERATIONS))
        inputs = [rng.choice(names) for _ in range(rng.randrange(1, 4))]
        node = helper.make_node(kind, inputs, [f"y{place}"])
        if rng.random() < 0.5:
            value = rng.choice([0, 1, -1, 10**9, 0.5, [1, 2], [10**9], "tanh", weights_of(rng, victim)])
            key = rng.choice(
                ["axis", "axes", "value", "to", "perm", "keepdims", "hidden_size", "sparse_value"]
            )
            node.attribute.append(helper.make_attribute(key, value))
        nodes.append(node)
        names.append(f"y{place}")
    nodes.append(helper.make_node("Tanh", [rng.choice([names[-1], "sum"])], ["output"]))
    shape = numpy_helper.from_array(
        np.array(rng.choice([[3], [-1, 3], [10**6, 10**6]]), dtype=np.int64), "shape"
    )
    model = onnx_model(nodes, [weights_of(rng, victim), shape])
    if rng.random() < 0.1:
        model.graph.sparse_initializer.add()
    return model


def weights_of(rng: random.Random, victim: Path) -> TensorProto:
    tensor = numpy_helper.from_array(np.full((6, 3), 0.1, dtype=np.float32), "weights")
    if rng.random() < 0.1:
        tensor.ClearField("raw_data")
        tensor.data_location = rng.choice([TensorProto.EXTERNAL, TensorProto.DEFAULT])
        tensor.external_data.add(key="location", value=rng.choice([str(victim), "victim", "../victim"]))
    if rng.random() < 0.1:
        tensor.dims[rng.randrange(2)] = rng.choice([0, -1, 10**12, 7])
    return tensor


def test_onnx_files_from_a_grammar(tmp_path: Path) -> None:
    rng, accepted = random.Random(12), 0
    with nothing_happens(tmp_path) as victim:
        for _ in range(count(2000)):
            accepted += loaded(sealed_onnx(tmp_path, random_onnx(rng, victim)))
    print(f"{accepted} of {count(2000)} were loaded")


def mutated(members: dict[str, bytes], rng: random.Random) -> dict[str, bytes]:
    """The members with a few of their bytes, names and lengths changed."""
    changed = dict(members)
    for _ in range(rng.randrange(1, 4)):
        name = rng.choice(list(changed))
        data = bytearray(changed[name])
        kind = rng.randrange(6)
        place = rng.randrange(len(data) + 1)
        if kind == 0 and data:
            data[place % len(data)] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[place:place] = rng.randbytes(rng.randrange(1, 20))
        elif kind == 2:
            del data[place : place + rng.randrange(1, 20)]
        elif kind == 3:
            data[place:place] = data[: rng.randrange(1, 60)]
        elif kind == 4:
            other = rng.choice(
                [name.upper(), f"{name}x", name.replace("/", "//"), f"extra/{name}", "bytecode.pkl"]
            )
            changed[other] = changed.pop(name)
            continue
        else:
            digits = [at for at, byte in enumerate(data) if 48 <= byte < 58]
            if digits:
                data[rng.choice(digits)] = rng.choice(b"0123456789")
        changed[name] = bytes(data)
    return changed


def test_mutated_archives(tmp_path: Path) -> None:
    rng, accepted = random.Random(13), 0
    starts = [
        members_of(tmp_path),
        {"data.pkl": PLAIN_STATE, "version": b"3", "code/__torch__.py": PLAIN.encode()},
    ]
    starts[1]["constants.pkl"] = b"\x80\x02)."
    with nothing_happens(tmp_path):
        for _ in range(count(100_000)):
            accepted += loaded(sealed(tmp_path, mutated(rng.choice(starts), rng)))
    print(f"{accepted} of {count(100_000)} were loaded")
