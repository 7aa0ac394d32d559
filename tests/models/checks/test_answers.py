"""The size of usual answers is known without torch's own functions, which import its compiler."""

from __future__ import annotations

import pytest
import torch

from robobt.models.checks import bounds
from robobt.models.checks.bounds import usual_answer
from robobt.models.policy import load_policy

ATEN = torch.ops.aten


def full(*shape: int) -> torch.Tensor:
    return torch.full(shape, 0.5)


USUAL = [
    (ATEN.tanh.default, (full(2, 3),)),
    (ATEN.relu.default, (full(4),)),
    (ATEN.sigmoid.default, (full(1, 2, 3),)),
    (ATEN.mul.Tensor, (full(2, 3), full(3))),
    (ATEN.add.Tensor, (full(2, 3), full(2, 3))),
    (ATEN.linear.default, (full(5, 3), full(4, 3), full(4))),
    (ATEN.linear.default, (full(2, 5, 3), full(4, 3))),
    (ATEN.linear.default, (full(3), full(4, 3), full(4))),
    (ATEN.layer_norm.default, (full(5, 3), [3], full(3), full(3))),
]

UNUSUAL = [
    (ATEN.tanh.default, (full(2).double(),)),
    (ATEN.cat.default, ([full(2), full(3)],)),
    (ATEN.mul.Tensor, (full(2, 3), full(2, 1))),
    (ATEN.mul.Tensor, (full(3), full(2, 3))),
    (ATEN.mul.Tensor, (full(3), torch.tensor(2.0))),
    (ATEN.mul.Tensor, (full(3), torch.ones(3, dtype=torch.int64))),
    (ATEN.linear.default, (full(5, 3), full(4, 2))),
    (ATEN.linear.default, (full(5, 3), full(4, 3), full(1))),
    (ATEN.linear.default, (full(5, 3), full(3))),
    (ATEN.layer_norm.default, (full(5, 3), [5, 3])),
    (ATEN.layer_norm.default, (full(5, 3), [3], full(1, 3))),
]


@pytest.mark.parametrize(("func", "args"), USUAL, ids=lambda it: getattr(it, "name", lambda: None)())
def test_a_usual_answer_is_as_large_as_torchs(func: torch._ops.OpOverload, args: tuple[object, ...]) -> None:
    answer, real = usual_answer(func, args), func(*args)
    assert answer is not None
    assert (answer.shape, answer.dtype, answer.device.type) == (real.shape, real.dtype, "meta")


@pytest.mark.parametrize(("func", "args"), UNUSUAL, ids=lambda it: getattr(it, "name", lambda: None)())
def test_all_else_is_left_to_torch(func: torch._ops.OpOverload, args: tuple[object, ...]) -> None:
    assert usual_answer(func, args) is None


@pytest.mark.parametrize(
    "name", ["duel_ppo", "go_to_ball_ddpg", "score_on_goalkeeper_robust", "shoot_robust"]
)
def test_a_policy_that_ships_is_loaded_without_torchs_compiler(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def tried(func: torch._ops.OpOverload, *_: object) -> list[torch.Tensor]:
        raise AssertionError(f"torch is asked about {func}")

    monkeypatch.setattr(bounds, "_tried", tried)
    load_policy(name)
    assert not hasattr(bounds.Bounds.__torch_dispatch__, "__wrapped__")
