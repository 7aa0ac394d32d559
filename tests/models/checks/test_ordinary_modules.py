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


class Normalised(nn.Module):
    """Observations brought to mean 0 and variance 1, and cut, as Stable-Baselines3 does."""

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(6))
        self.register_buffer("variance", torch.ones(6))
        self.actor = nn.Sequential(nn.Flatten(), nn.Linear(6, 8), nn.Tanh(), nn.Linear(8, 3))

    def forward(self, observation: Tensor) -> Tensor:
        normal = (observation - self.mean) / torch.sqrt(self.variance + 1e-8)
        return torch.clip(self.actor(normal.clamp(-10.0, 10.0).float()), -1.0, 1.0)


class Shapes(nn.Module):
    """Sizes read off the observation, and calculated with."""

    def __init__(self) -> None:
        super().__init__()
        self.heads = 2
        self.last = nn.Linear(6, 3)

    def forward(self, observation: Tensor) -> Tensor:
        count, size = observation.shape
        assert size == 6
        heads = observation.view(observation.shape[0], self.heads, size // self.heads).transpose(1, 2)
        return torch.tanh(self.last(heads.reshape(count, -1) * torch.arange(observation.shape[1]).float()))


class Bins(nn.Module):
    """Entries of the observation as integers, divided, and numbers between 0 and 3 for angles."""

    def __init__(self) -> None:
        super().__init__()
        self.last = nn.Linear(6, 3)

    def forward(self, observation: Tensor) -> Tensor:
        bins = torch.floor(observation[:, :1] * 2.0).to(torch.int64).clamp(-5, 5)
        halves = torch.div(bins, 2, rounding_mode="floor") + bins % 4 + bins // 3
        angles = (observation + torch.pi) % (2.0 * torch.pi) - torch.remainder(observation, 0.5)
        return torch.tanh(self.last(angles) + halves.float() + torch.fmod(observation[:, :1], 3.0))


class Chosen(nn.Module):
    """The action of the highest value, out of a table."""

    def __init__(self) -> None:
        super().__init__()
        self.values = nn.Linear(6, 3)
        self.actions = nn.Embedding(3, 3)
        self.register_buffer("table", torch.eye(3))

    def forward(self, observation: Tensor) -> Tensor:
        values = self.values(observation)
        best = values.argmax(1)
        highest = values.gather(1, best.unsqueeze(1))
        one_hot = nn.functional.one_hot(best, 3).float()
        equal = (best.unsqueeze(1) == torch.arange(3)).float()
        return torch.tanh(self.actions(best) + self.table[best] + one_hot + equal + highest)


class Pieces(nn.Module):
    """Split, cut, stacked, repeated and chosen from."""

    def forward(self, observation: Tensor) -> Tensor:
        low, high = observation.chunk(2, 1)
        first, second = torch.split(observation, 3, dim=1)
        stacked = torch.stack([observation[:, 0], observation[:, 2], observation[:, 5]], dim=1)
        repeated = observation[:, :1].repeat(1, 3) + torch.full((3,), 0.5) + observation.new_zeros(3)
        return torch.tanh(
            torch.where(low > high, first * stacked, second) + observation[:, [0, 2, 4]] + repeated
        )


class Attention(nn.Module):
    """Attention over three things of two entries each."""

    def __init__(self) -> None:
        super().__init__()
        self.query, self.key, self.value = nn.Linear(2, 8), nn.Linear(2, 8), nn.Linear(2, 8)
        self.last = nn.Linear(8, 3)

    def forward(self, observation: Tensor) -> Tensor:
        things = observation.view(observation.size(0), 3, 2)
        weights = torch.softmax(self.query(things) @ self.key(things).transpose(1, 2) / 8**0.5, -1)
        return torch.tanh(self.last((weights @ self.value(things)).mean(1)))


class Started(nn.Module):
    """A recurrent layer whose state starts from zeros of the batch's size."""

    def __init__(self) -> None:
        super().__init__()
        self.layer = nn.LSTM(2, 8, batch_first=True)
        self.last = nn.Linear(8, 3)

    def forward(self, observation: Tensor) -> Tensor:
        state = torch.zeros(1, observation.shape[0], 8)
        hidden, _ = self.layer(observation.view(-1, 3, 2), (state, state))
        return torch.tanh(self.last(hidden[:, -1, :]))


def deep() -> nn.Module:
    parts = [part for _ in range(9) for part in (nn.Linear(8, 8), nn.BatchNorm1d(8), nn.ReLU())]
    return nn.Sequential(nn.Linear(6, 8), *parts, nn.Linear(8, 3), nn.Tanh())


MODULES: dict[str, Callable[[], nn.Module]] = {
    "layers": layers,
    "gru": lambda: Recurrent(nn.GRU(6, 8, 2, batch_first=True)),
    "lstm": lambda: Recurrent(nn.LSTM(6, 8, batch_first=True)),
    "rnn": lambda: Recurrent(nn.RNN(6, 8, batch_first=True)),
    "cell": Cell,
    "residual": Residual,
    "normalised": Normalised,
    "shapes": Shapes,
    "bins": Bins,
    "chosen": Chosen,
    "pieces": Pieces,
    "attention": Attention,
    "started": Started,
    "deep": deep,
}

STYLES = ["script", "trace", "frozen script", "frozen trace", "in training"]
# A trace makes tensors of sizes that are divided, and numbers of them again.
SAVED = [(name, style) for name in MODULES for style in STYLES if (name, style[-5:]) != ("shapes", "trace")]
EXPORTED = sorted(set(MODULES) - {"residual", "shapes", "bins", "chosen", "pieces"})


def traced(module: nn.Module) -> torch.jit.ScriptModule:
    return torch.jit.trace(module, torch.zeros(2, 6), check_trace=False)  # type: ignore[no-any-return]


@pytest.mark.parametrize(("name", "style"), SAVED)
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


@pytest.mark.parametrize("name", EXPORTED)
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
