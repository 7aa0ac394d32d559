"""No integer that a TorchScript file divides, shifts or names a type by ends the process."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from tests.models.checks.test_hostile_torchscript import PLAIN, PLAIN_STATE, many, plain, refused
from tests.models.made_models import sealed

# What an observation makes of these is 0 where none of its entries is above 9, as all that loading tries.
UNUSUAL = "u = torch.to(torch.gt(observation, 9.), 3)"
INTEGERS = "i = torch.to(observation, 3)"


def with_number(*lines: str) -> str:
    """The plain module with its answer multiplied by 1, whatever the number in the last line is."""
    last = lines[-1].split(" = ")[0]
    body = "".join([f"    {line}\n" for line in lines])
    return PLAIN.replace(
        "    return _1\n", f"{body}    return torch.mul(_1, torch.add(torch.mul({last}, 0), 1))\n"
    )


NUMBERS = {
    "by 0": ["n = torch.remainder(5, 0)"],
    "by 0, rounded down": ["n = torch.floordiv(5, 0)"],
    "the smallest by -1": ["m = torch.sub(-9223372036854775807, 1)", "n = torch.remainder(m, -1)"],
    "by a difference of constants": ["m = torch.sub(1, 1)", "n = torch.floordiv(5, m)"],
    "by what a name stands for": ["m = 0", "n = torch.remainder(5, m)"],
    "by an entry of a list": ["m = [1, 0]", "n = torch.remainder(5, m[1])"],
    "by a keyword": ["n = torch.remainder(5, other=0)"],
    "by the number of observations but 17": [
        "m = torch.sub(torch.size(observation, 0), 17)",
        "n = torch.remainder(5, m)",
    ],
    "by the number of axes but 2": ["m = torch.sub(torch.dim(observation), 2)", "n = torch.floordiv(5, m)"],
    "by a tensor's only entry": ["m = int(torch.zeros([]))", "n = torch.remainder(5, m)"],
    "by less than nothing": ["n = torch.remainder(5, -inf)"],
    "of what may be no integer": ["m = torch.add(5, 0.5)", "n = torch.remainder(m, 0)"],
}


@pytest.mark.parametrize("what", NUMBERS)
def test_a_division_of_numbers_that_may_end_the_process_is_refused(what: str, tmp_path: Path) -> None:
    refused(
        plain(tmp_path, with_number(*NUMBERS[what])), "divides an integer by what may be 0 or -1: .*torch"
    )


@pytest.mark.parametrize("heads", [0, -1])
def test_a_division_by_an_attribute_that_may_end_the_process_is_refused(heads: int, tmp_path: Path) -> None:
    refused(plain(tmp_path, *by_attribute(heads)), "divides an integer by what may be 0 or -1: .*torch")


def test_a_division_by_an_attribute_is_loaded(tmp_path: Path) -> None:
    assert load_policy(plain(tmp_path, *by_attribute(2)))([0.0] * 6).tolist() == [0.0] * 3


def by_attribute(heads: int) -> tuple[str, bytes]:
    code = with_number("h = self.heads", "n = torch.floordiv(torch.size(observation, 1), h)")
    code = code.replace("  training : bool\n", "  training : bool\n  heads : int\n")
    number = b"K%c" % heads if heads >= 0 else b"J\xff\xff\xff\xff"
    state = b"\x80\x02c__torch__\nAttack\n)\x81}(X\x08\x00\x00\x00training\x89X\x05\x00\x00\x00heads" + number
    return code, state + b"ub."


def test_a_number_among_the_constants_is_refused(tmp_path: Path) -> None:
    # Torch would divide by it while it reads the code.
    code = with_number("n = torch.remainder(5, CONSTANTS.c0)").encode()
    members = {"data.pkl": PLAIN_STATE, "version": b"3", "code/__torch__.py": code}
    refused(sealed(tmp_path, members | {"constants.pkl": b"\x80\x02K\x00\x85."}), "numbers in constants")


TENSORS = {
    "div": 'torch.div(i, {}, rounding_mode="trunc")',
    "div rounded down": 'torch.div(i, {}, rounding_mode="floor")',
    "remainder": "torch.remainder(i, {})",
    "fmod": "torch.fmod(i, {})",
    "floor_divide": "torch.floor_divide(i, {})",
}


@pytest.mark.parametrize("kind", TENSORS)
@pytest.mark.parametrize(
    "divisor",
    ["torch.sub(u, 1)", "torch.sub(1, torch.mul(u, 2))", "-1", "0", "torch.full([6], -1, dtype=3)", "u"],
)
def test_a_division_of_tensors_that_may_end_the_process_is_refused(
    kind: str, divisor: str, tmp_path: Path
) -> None:
    lines = [UNUSUAL, INTEGERS, f"x1 = torch.to({TENSORS[kind].format(divisor)}, 6)"]
    refused(plain(tmp_path, many(lines)), "divides integers by")


@pytest.mark.parametrize("kind", TENSORS)
@pytest.mark.parametrize(
    ("type_", "divisor"),
    [
        (3, "4294967295"),
        (3, "-4294967297"),
        (3, "8589934592"),
        (3, "torch.full([], 4294967295, dtype=4)"),
        (3, "torch.select(torch.full([2], 4294967295, dtype=4), 0, 1)"),
        (2, "65535"),
        (1, "256"),
        (1, "torch.full([], 65535, dtype=3)"),
        (0, "256"),
    ],
)
def test_a_division_by_what_becomes_0_or_minus_1_in_the_type_divided_in_is_refused(
    kind: str, type_: int, divisor: str, tmp_path: Path
) -> None:
    integers = f"i = torch.to(observation, {type_})"
    lines = [integers, f"x1 = torch.to({TENSORS[kind].format(divisor)}, 6)"]
    refused(plain(tmp_path, many(lines)), "divides integers by 0 or -1")


@pytest.mark.parametrize("kind", TENSORS)
def test_a_division_of_one_number_by_what_becomes_minus_1_is_refused(kind: str, tmp_path: Path) -> None:
    number = "i = torch.to(torch.sum(observation), 3)"
    lines = [number, f"x1 = torch.to({TENSORS[kind].format('4294967295')}, 6)"]
    refused(plain(tmp_path, many(lines)), "divides integers by 0 or -1")


@pytest.mark.parametrize("kind", TENSORS)
def test_a_division_by_what_is_minus_1_in_a_narrower_type_alone_is_loaded(kind: str, tmp_path: Path) -> None:
    lines = [
        "i = torch.to(observation, 3)",
        f"x1 = torch.to({TENSORS[kind].format('torch.full([6], 4294967295, dtype=4)')}, 6)",
    ]
    load_policy(plain(tmp_path, many(lines)))


def test_a_constant_divisor_that_is_changed_in_place_is_refused(tmp_path: Path) -> None:
    lines = [
        UNUSUAL,
        INTEGERS,
        "c = torch.full([6], 1, dtype=3)",
        "_2 = torch.sub_(c, torch.select(u, 0, 0))",
        'x1 = torch.to(torch.div(i, c, rounding_mode="trunc"), 6)',
    ]
    refused(plain(tmp_path, many(lines)), "divides integers by")


@pytest.mark.parametrize("kind", TENSORS)
@pytest.mark.parametrize(
    "divisor", ["2", "-2", "7", "torch.full([6], 3, dtype=3)", "torch.size(observation, 1)"]
)
def test_a_division_of_tensors_by_a_constant_answers_whatever_is_observed(
    kind: str, divisor: str, tmp_path: Path
) -> None:
    used = f"torch.gt(torch.sum({TENSORS[kind].format(divisor)}), 1)"
    code = PLAIN.replace(
        "    return _1\n", f"    {INTEGERS}\n    return torch.add(_1, torch.mul(torch.to({used}, 6), 0.))\n"
    )
    loaded = load_policy(plain(tmp_path, code))
    for value in (0.0, 9.5, 1e9, -np.inf, np.nan, 2.0**31, -(2.0**63)):
        loaded(np.full((3, 6), value))


@pytest.mark.parametrize(
    "line",
    [
        "x1 = torch.to(observation, 99)",
        "x1 = torch.zeros([3], dtype=99)",
        "x1 = torch.to(torch.to(observation, 9), 6)",
        "x1 = torch.zeros([3], dtype=6, layout=1)",
        "x1 = torch.contiguous(observation, memory_format=77)",
        "x1 = torch.to(observation, torch.add(torch.size(observation, 0), 6))",
    ],
)
def test_a_type_or_layout_that_no_network_needs_is_refused(line: str, tmp_path: Path) -> None:
    refused(plain(tmp_path, many([line])), "that no network needs: x1 = ")


def test_a_conversion_to_nothing_is_refused(tmp_path: Path) -> None:
    refused(plain(tmp_path, many(["x1 = torch.to(observation, None, False, True)"])), "torch.to")


@pytest.mark.parametrize("kind", ["__lshift__", "__rshift__", "bitwise_left_shift", "bitwise_right_shift"])
def test_a_shift_is_refused(kind: str, tmp_path: Path) -> None:
    lines = [INTEGERS, f"x1 = torch.to(torch.{kind}(i, 70), 6)"]
    refused(plain(tmp_path, many(lines)), f"more than arithmetic: aten::{kind}")


def test_what_a_network_takes_does_not_depend_on_how_many_observations_it_is_given(tmp_path: Path) -> None:
    # As large as a file says for any number of observations but 1 and 64.
    code = PLAIN.replace(
        "    return _1\n",
        "    n = torch.size(observation, 0)\n"
        "    m = torch.mul(torch.mul(torch.sub(n, 1), torch.sub(64, n)), 100000000)\n"
        "    x = torch.sum(torch.zeros([m]))\n"
        "    return torch.add(_1, x)\n",
    )
    loaded = load_policy(plain(tmp_path, code))
    for count in (1, 2, 30, 63, 64, 65, 200):
        assert loaded(np.zeros((count, 6))).tolist() == [[0.0] * 3] * count


def test_what_fails_on_an_unusual_observation_is_an_error_that_names_the_file(tmp_path: Path) -> None:
    lines = [
        "u = torch.to(torch.gt(observation, 90.), 4)",
        "x1 = torch.gather(observation, 1, torch.mul(u, 9))",
    ]
    path = plain(tmp_path, many(lines))
    loaded = load_policy(path)
    assert loaded(np.zeros(6)).tolist() == [0.0] * 3
    for ask in (loaded, loaded.single()):
        with pytest.raises(ModelError, match=r"crafted\.pt: fails on an observation: .*out of bounds"):
            ask(np.full(6, 100.0))
