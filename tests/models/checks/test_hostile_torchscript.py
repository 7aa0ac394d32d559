"""A TorchScript file runs nothing while it is loaded, and takes no more than a network does."""

from __future__ import annotations

import io
import struct
import time
import warnings
import zipfile
from pathlib import Path

import pytest
import torch

from robobt.models.file import ModelError, unpack_archive
from robobt.models.policy import load_policy
from tests.models.made_models import go_to_ball_card, members_of, sealed

WRITES = """class Attack(Module):
  __parameters__ = []
  __buffers__ = []
  training : bool
  kept : Tensor
  def forward(self: __torch__.Attack,
    observation: Tensor) -> Tensor:
    return torch.tanh(torch.slice(observation, 1, 0, 3))
  def __getstate__(self: __torch__.Attack) -> bool:
    return True
  def __setstate__(self: __torch__.Attack,
    state: bool) -> NoneType:
    _0 = torch.from_file("VICTIM", True, 8, dtype=0)
    _1 = torch.fill_(_0, 65)
    self.kept = _1
    self.training = state
    return None
"""
_WRITING = """    _0 = torch.from_file("VICTIM", True, 8, dtype=0)
    _1 = torch.fill_(_0, 65)
    self.kept = _1
"""
LOOPS = WRITES.replace(_WRITING, "    while True:\n      self.training = state\n")
STATE = b"\x80\x02c__torch__\nAttack\nq\x00)\x81\x88b."


def archive(*members: tuple[str, bytes]) -> bytes:
    """An archive as torch writes it, with a card, whatever the names."""
    buffer = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w") as written:
        warnings.simplefilter("ignore")
        card = go_to_ball_card("attack").to_json().encode()
        others = [("constants.pkl", b"\x80\x02)."), ("version", b"3"), ("extra/card.json", card)]
        for name, content in (*members, *others):
            written.writestr(f"model/{name}", content)
    return buffer.getvalue()


def refused(path: Path, said: str = ".") -> None:
    before = time.process_time()
    with pytest.raises(ModelError, match=said) as caught:
        load_policy(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert len(str(caught.value).splitlines()) == 1
    assert time.process_time() - before < 5.0


def harmless(name: str = "Attack") -> bytes:
    lines = WRITES.split("  def __getstate__")[0].replace("Attack", name)
    return lines.encode()


NAMES = [
    ["code/__torch__.py"],
    ["code/__torch__.PY"],
    ["code/__torch__.Py"],
    ["code/__TORCH__.py"],
    ["Code/__torch__.py"],
    ["code/__torch__.py", "code/__torch__.PY"],
    ["code/__torch__.PY", "code/__torch__.py"],
    ["code/__torch__.py", "code/__torch__.py"],
    ["code/__torch__.py", "code/__torch__.py\0.txt"],
    ["code/__torch__.py", "code//__torch__.py"],
    ["code/__torch__.py", "code/./__torch__.py"],
    ["code/__torch__.py", "code/x/../__torch__.py"],
    ["code/__torch__.py", "../model/code/__torch__.py"],
    ["code/__torch__.py", "/model/code/__torch__.py"],
    ["code/__torch__.py", "code\\__torch__.py"],
    ["code/__torch__.py", "code/__torch__.py "],
    ["code/__torch__.py", "code/__torch__.pyc"],
    ["code/__torch__.py", "\u212aode/__torch__.py"],
    ["code/a.py", "code/__torch__.\u017fpy"],
]


@pytest.mark.parametrize("sources", NAMES, ids=[" and ".join(names) for names in NAMES])
def test_code_that_would_write_a_file_while_it_is_loaded_is_never_run(
    sources: list[str], tmp_path: Path
) -> None:
    victim = tmp_path / "victim"
    victim.write_bytes(b"precious")
    attack = WRITES.replace("VICTIM", str(victim)).encode()
    for harmful in range(len(sources)):
        codes = [(name, attack if place == harmful else harmless()) for place, name in enumerate(sources)]
        path = tmp_path / "attack.pt"
        path.write_bytes(archive(("data.pkl", STATE), *codes))
        refused(path)
        assert victim.read_bytes() == b"precious"


@pytest.mark.parametrize("name", ["code/__torch__.py", "code/__torch__.PY"])
def test_a_loop_without_end_is_never_run(name: str, tmp_path: Path) -> None:
    path = tmp_path / "attack.pt"
    path.write_bytes(archive(("data.pkl", STATE), (name, LOOPS.encode())))
    refused(path)


def test_torch_itself_would_have_run_it(tmp_path: Path) -> None:
    # Else the tests above could not fail.
    victim = tmp_path / "victim"
    victim.write_bytes(b"precious")
    attack = WRITES.replace("VICTIM", str(victim)).encode()
    data = archive(("data.pkl", STATE), ("code/__torch__.PY", attack))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.jit.load(io.BytesIO(data))
    assert victim.read_bytes() == b"AAAAAAAA"


@pytest.mark.integration
@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("bytecode.pkl", b"\x80\x02)."),
        ("code/notes.txt", b""),
        ("data.PKL", b""),
        ("constants/0x", b""),
        ("a", b""),
    ],
)
def test_a_member_that_torch_does_not_write_is_refused(name: str, content: bytes, tmp_path: Path) -> None:
    refused(sealed(tmp_path, members_of(tmp_path) | {name: content}), "torch does not write|same name")


CODE = [
    (
        "    return _1",
        "    _2 = ops.aten.from_file('/etc/hostname', True, 8)\n    return _1",
        "no network needs",
    ),
    ("    return _1", "    _2 = torch.from_file('/etc/hostname', True, 8)\n    return _1", "aten::from_file"),
    ("    return _1", "    _2 = torch.save(_1, '/tmp/x')\n    return _1", "aten::save"),
    ("    return _1", "    return (_1).from_file('x')", "no network needs"),
    ("    return _1", "    return _1.T", "no network needs"),
    ("    return _1", "    _2 = self.forward\n    return _1", "no network needs"),
    ("    return _1", "    return (self).forward(_1)", "calls itself"),
    ("    return _1", "    torch = self\n    return _1", "second meaning"),
    ("    return _1", "    self.training = True\n    return _1", "no network needs"),
    ("    return _1", "    return torch.tanh(lambda: 1)", "no network needs"),
    ("    return _1", "    return torch.tanh([x for x in [1]])", "no network needs"),
    ("    return _1", "    return torch.tanh(__torch__.torch.classes.mine.Thing())", "no network needs"),
    ("    return _1", "    with torch.no_grad():\n      pass\n    return _1", "no network needs"),
    ("    return _1", "    for i in range(1000000000000):\n      _2 = torch.tanh(_1)\n    return _1", "loop"),
    ("    return _1", "    print(_1)\n    return _1", "no network needs"),
    ("    return _1", "    return torch.zeros([9223372036854775808])", "no network needs"),
    ("    return _1", f"    return torch.tanh({'(' * 90}_1{')' * 90})", "."),
    ("    return _1", f"    return {'torch.tanh(' * 60}_1{')' * 60}", "nested|deep"),
    ("    return _1", f"    return torch.tanh({'-' * 15_000}1)", "damaged|deep"),
    ("    return _1", f"    return {'torch' + '.a' * 9000}(_1)", "damaged|deep"),
    ("    return _1", "    return torch.tanh(_1)  # \N{SNOWMAN}", "damaged|torch writes"),
    ("    training : bool\n", "    training : __torch__.torch.classes.mine.Thing\n", "no network needs"),
    ("class Attack(Module)", "class Attack(Interface)", "no network needs"),
    ("class Attack(Module)", "class Attack", "no network needs"),
    ("class Attack(Module)", "import os\nclass Attack(Module)", "no network needs"),
    ("class Attack(Module)", "x = torch.tanh(1)\nclass Attack(Module)", "no network needs"),
    ("class Attack(Module)", "@torch.jit.export\nclass Attack(Module)", "no network needs"),
]
PLAIN = """class Attack(Module):
  __parameters__ = []
  __buffers__ = []
  training : bool
  def forward(self: __torch__.Attack,
    observation: Tensor) -> Tensor:
    _1 = torch.tanh(torch.slice(observation, 1, 0, 3))
    return _1
"""
PLAIN_STATE = b"\x80\x02c__torch__\nAttack\n)\x81}X\x08\x00\x00\x00training\x89sb."


def plain(folder: Path, code: str, state: bytes = PLAIN_STATE) -> Path:
    members = {"data.pkl": state, "version": b"3", "code/__torch__.py": code.encode()}
    return sealed(folder, members | {"constants.pkl": b"\x80\x02)."})


def test_the_plain_module_that_the_attacks_start_from_is_loaded(tmp_path: Path) -> None:
    assert load_policy(plain(tmp_path, PLAIN))([0.0] * 6).tolist() == [0.0] * 3


@pytest.mark.parametrize(("old", "new", "said"), CODE, ids=[f"{new.strip()[:50]}" for _, new, _ in CODE])
def test_code_that_no_network_needs_is_refused(old: str, new: str, said: str, tmp_path: Path) -> None:
    old, new = old.replace("    training", "  training"), new.replace("    training", "  training")
    assert old in PLAIN
    path = plain(tmp_path, PLAIN.replace(old, new))
    if "(((" in new:
        # Python takes no more than 200 parentheses, and torch is given none of these.
        load_policy(path)
        return
    refused(path, said)


def many(lines: list[str], measure: str = "sum") -> str:
    """The module with more lines, of which the last is used, else torch would leave them all out."""
    body = "".join([f"    {line}\n" for line in lines])
    used = f"torch.{measure}({lines[-1].split(' = ')[0]})"
    return PLAIN.replace(
        "    return _1\n", f"    x0 = _1\n{body}    return torch.mul(_1, torch.mul({used}, 0))\n"
    )


BOMBS = {
    "doubled by cat": many([f"x{i + 1} = torch.cat([x{i}, x{i}], 1)" for i in range(40)]),
    "of constants": many(
        ["k0 = torch.zeros([1024])", *[f"k{i + 1} = torch.cat([k{i}, k{i}])" for i in range(30)]]
    ),
    "zeros": many(["x1 = torch.zeros([1000000, 1000000])"]),
    "zeros for one batch only": PLAIN.replace(
        "    return _1\n",
        "    if torch.eq(torch.size(observation, 0), 17):\n"
        "      y = torch.add(_1, torch.zeros([100000, 1, 3]))\n"
        "    else:\n      y = _1\n    return y\n",
    ),
    "zeros as many as an observation says": many(
        ["x1 = torch.zeros([int(torch.select(torch.select(_1, 0, 0), 0, 0))])"]
    ),
    "outer products": many(
        [
            line
            for i in range(6)
            for line in (
                f"y{i} = torch.matmul(torch.reshape(x{i}, [-1, 1]), torch.reshape(x{i}, [1, -1]))",
                f"x{i + 1} = torch.unsqueeze(y{i}, 0)",
            )
        ]
    ),
    "expanded": many(["x1 = torch.mul(torch.expand(torch.zeros([1]), [100000, 100000]), 2)"]),
    "pieces": many(["x1 = torch.expand(torch.zeros([1]), [10000000])", "l = torch.unbind(x1)", "x2 = l[0]"]),
    "work in place": many(
        [f"x1 = torch.add(torch.zeros({[2] * 20}), torch.sum(observation))", *["x2 = torch.tanh_(x1)"] * 900]
    ),
    "a product of integers": many(
        [
            "x1 = torch.to(torch.add(torch.zeros([900, 900]), torch.sum(observation)), 4)",
            "x2 = torch.to(torch.matmul(x1, x1), 6)",
        ]
    ),
    "a range": many(["x1 = torch.arange(100000000000)"]),
    "as many classes as an observation says": many(["x1 = torch.one_hot(torch.to(_1, 4), -1)"]),
    "a tensor in a complaint": PLAIN.replace(
        "    return _1\n",
        "    if torch.eq(torch.dim(observation), 3):\n"
        '      ops.prim.RaiseException(torch.format("{}", torch.zeros([2000, 2000])), "e")\n'
        "    else:\n      pass\n    return _1\n",
    ),
    "lists": many(["x1 = [1, 2]", *[f"x{i + 1} = torch.add(x{i}, x{i})" for i in range(1, 40)]], "len"),
    "repeated lists": many(["x1 = torch.mul([1], 1000000000000)"], "len"),
    "texts": many(
        ['x1 = "aaaa"', *[f'x{i + 1} = torch.format("{{}}{{}}", x{i}, x{i})' for i in range(1, 40)]]
    ),
    "added texts": many(['x1 = "aaaa"', *[f"x{i + 1} = torch.add(x{i}, x{i})" for i in range(1, 40)]], "len"),
    "literal texts": many(
        [f"x{i + 1} = torch.add({f'x{i}' if i else repr('a')}, 'a')" for i in range(9)], "len"
    ),
    "calls": "class Attack(Module):\n  __parameters__ = []\n  __buffers__ = []\n  training : bool\n"
    + "".join(
        [
            f"  def {'forward' if i == 0 else f'f{i}'}(self: __torch__.Attack,\n    x: Tensor) -> Tensor:\n"
            f"    return (self).f{i + 1}((self).f{i + 1}(x, ), )\n"
            for i in range(40)
        ]
    )
    + "  def f40(self: __torch__.Attack,\n    x: Tensor) -> Tensor:\n    return torch.tanh(x)\n",
}


@pytest.mark.parametrize("what", BOMBS)
def test_a_network_that_would_fill_the_memory_is_refused(what: str, tmp_path: Path) -> None:
    refused(plain(tmp_path, BOMBS[what]))


def nested(count: int) -> bytes:
    return b"\x80\x02c__torch__\nAttack\n)\x81}X\x08\x00\x00\x00training)" + b"\x85" * count + b"sb."


PICKLES = {
    "deep tuples": nested(300_000),
    "tuples of 45": nested(45),
    "a list in itself": b"\x80\x02c__torch__\nAttack\n)\x81}X\x08\x00\x00\x00training]q\x00h\x00asb.",
    "doubled tuples": b"\x80\x02)" + b"".join([b"q%ch%c\x86" % (i, i) for i in range(60)]) + b".",
    "a memory of 10^8": b"\x80\x02)r" + struct.pack("<I", 10**8) + b".",
    "a memory that is empty": b"\x80\x02h\x05.",
    "a large number": b"\x80\x02c__torch__\nAttack\n)\x81}X\x08\x00\x00\x00training\x8a\x09"
    + bytes(8)
    + b"\x01sb.",
    "a number for a truth value": PLAIN_STATE.replace(b"\x89s", b"K\x01s"),
    "another class": PLAIN_STATE.replace(b"Attack", b"Other"),
    "an attribute too few": b"\x80\x02c__torch__\nAttack\n)\x81}b.",
    "an attribute too many": PLAIN_STATE.replace(b"\x89s", b"\x89sX\x01\x00\x00\x00a\x89s"),
    "a bare name": b"\x80\x02ctorch\nFloatStorage\n.",
    "a name of two lines": PLAIN_STATE.replace(b"Attack", b"At\rtack"),
    "two values": b"\x80\x02NN.",
    "something behind": PLAIN_STATE + PLAIN_STATE,
    "a mark": b"\x80\x02(.",
    "many operations": b"\x80\x02" + b"N0" * 100_000 + b"N.",
}


@pytest.mark.integration
@pytest.mark.parametrize("what", PICKLES)
def test_a_pickle_that_torch_would_not_write_is_refused(what: str, tmp_path: Path) -> None:
    refused(plain(tmp_path, PLAIN, PICKLES[what]))


def test_a_tensor_larger_than_its_weights_is_refused(tmp_path: Path) -> None:
    members = members_of(tmp_path)
    pickle = members["constants.pkl"]
    for old, new in ((b"K\x10K\x06\x86", b"K\x10K\x07\x86"), (b"K\x10K\x06", b"J\xff\xff\xff\x7fK\x06")):
        changed = pickle.replace(old, new)
        if changed == pickle:
            changed = pickle.replace(b"K\x10K\x06", b"K\xf0K\x06")
        assert changed != pickle
        refused(
            sealed(tmp_path, members | {"constants.pkl": changed}),
            "larger than its weights|damaged|than a model",
        )


def test_torch_reads_what_was_understood_and_not_the_files_own_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[bytes] = []
    original = torch.jit.load

    def load(stream: io.BytesIO, **options: object) -> object:
        seen.append(stream.getvalue())
        return original(stream, **options)

    monkeypatch.setattr(torch.jit, "load", load)
    load_policy(plain(tmp_path, PLAIN.replace("    return _1", "    # a remark\n    return (_1)")))
    (source,) = [text for name, text in unpack_archive(seen[0]).items() if name.startswith("code/")]
    assert b"remark" not in source
    assert b"return _1\n" in source
