"""Networks of the usual parts are loaded, whichever way torch wrote them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from robobt.models.export import export_model
from robobt.models.policy import load_policy
from tests.models.made_models import go_to_ball_card

pytestmark = pytest.mark.integration


class Recurrent(nn.Module):
    """One step of a recurrent layer, with a buffer."""

    def __init__(self, layer: nn.Module) -> None:
        super().__init__()
        self.layer = layer
        self.norm = nn.LayerNorm(8)
        self.last = nn.Linear(8, 3)
        self.register_buffer("scale", torch.full((6,), 0.5))

    def forward(self, observation: Tensor) -> Tensor:
        hidden, _ = self.layer((observation * self.scale).unsqueeze(1))
        return torch.tanh(self.last(self.norm(hidden[:, -1])))


class Cell(nn.Module):
    """A cell that starts from nothing."""

    def __init__(self) -> None:
        super().__init__()
        self.cell = nn.GRUCell(6, 8)
        self.last = nn.Linear(8, 3)

    def forward(self, observation: Tensor) -> Tensor:
        return torch.tanh(self.last(self.cell(observation)))


class Residual(nn.Module):
    """A list of layers, a method, a branch on a shape, attributes of all sorts."""

    __constants__ = ("factor",)

    def __init__(self) -> None:
        super().__init__()
        self.factor = 0.5
        self.steps = 3
        self.names = ["a", "b"]
        self.sizes = {"a": 1.0}
        self.shift: Tensor | None = None
        self.layers = nn.ModuleList([nn.Linear(6, 6) for _ in range(3)])
        self.head = nn.Sequential(nn.Linear(6, 3), nn.Tanh())

    def scaled(self, observation: Tensor, also: bool = True) -> Tensor:
        return observation * self.factor if also else observation

    def forward(self, observation: Tensor) -> Tensor:
        for layer in self.layers:
            observation = nn.functional.elu(layer(observation)) + observation
        if observation.dim() != 2:
            raise ValueError("takes a batch of observations")
        shift = self.shift
        if shift is not None:
            observation = observation + shift
        low, high = self.scaled(observation).chunk(2, 1)
        return self.head(torch.cat([low, high], 1)).clamp(-1.0, float("inf"))


def layers() -> nn.Module:
    return nn.Sequential(
        nn.Linear(6, 8),
        nn.BatchNorm1d(8),
        nn.ReLU(),
        nn.LayerNorm(8),
        nn.Dropout(0.1),
        nn.GELU(),
        nn.SiLU(),
        nn.LeakyReLU(),
        nn.ELU(inplace=True),
        nn.Mish(),
        nn.Hardtanh(),
        nn.Softplus(),
        nn.PReLU(),
        nn.Linear(8, 3),
        nn.Softsign(),
    )


MODULES: dict[str, Callable[[], nn.Module]] = {
    "layers": layers,
    "gru": lambda: Recurrent(nn.GRU(6, 8, 2, batch_first=True)),
    "lstm": lambda: Recurrent(nn.LSTM(6, 8, batch_first=True)),
    "rnn": lambda: Recurrent(nn.RNN(6, 8, batch_first=True)),
    "cell": Cell,
    "residual": Residual,
}


def traced(module: nn.Module) -> torch.jit.ScriptModule:
    return torch.jit.trace(module, torch.zeros(2, 6), check_trace=False)  # type: ignore[no-any-return]


@pytest.mark.parametrize("name", MODULES)
@pytest.mark.parametrize("style", ["script", "trace", "frozen script", "frozen trace", "in training"])
def test_a_module_of_the_usual_parts_is_loaded(name: str, style: str, tmp_path: Path) -> None:
    torch.manual_seed(1)
    module, path = MODULES[name]().eval(), tmp_path / "own.pt"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        inputs = np.random.default_rng(3).normal(size=(9, 6)).astype(np.float32)
        with torch.no_grad():
            wanted = module(torch.from_numpy(inputs)).numpy()
        if style == "in training":
            module.train()
        written = traced(module) if "trace" in style else torch.jit.script(module)
        if "frozen" in style:
            written = torch.jit.freeze(written)
        extra = {"card.json": go_to_ball_card("own").to_json(), "notes.txt": "mine"}
        torch.jit.save(written, path, _extra_files=extra)
    np.testing.assert_allclose(load_policy(path)(inputs), wanted, atol=1e-6)


@pytest.mark.parametrize("name", [name for name in MODULES if name != "residual"])
def test_a_module_of_the_usual_parts_is_exported(name: str, tmp_path: Path) -> None:
    torch.manual_seed(1)
    module = MODULES[name]().eval()
    files = export_model(module, go_to_ball_card("own"), tmp_path, ("torchscript", "onnx"))
    assert [load_policy(path).path for path in files] == list(files)


def test_a_network_as_large_as_a_file_may_be_is_loaded(tmp_path: Path) -> None:
    module = nn.Sequential(
        nn.Linear(6, 1900), nn.ReLU(), nn.Linear(1900, 1900), nn.Linear(1900, 3), nn.Tanh()
    )
    path = tmp_path / "own.pt"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.jit.save(
            torch.jit.script(module), path, _extra_files={"card.json": go_to_ball_card("own").to_json()}
        )
    assert path.stat().st_size > 14e6
    assert load_policy(path)(np.zeros(6)).shape == (3,)
