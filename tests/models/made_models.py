"""Small networks with cards, as model files."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import onnx
import pytest
import torch
from onnx import TensorProto, helper
from torch import Tensor, nn

from robobt.models import export, policy
from robobt.models.actions import GO_TO_BALL_ACTION, SCORE_ACTION, SHOOT_ACTION
from robobt.models.card import ModelCard, ObservationCard, OutputEntry, action_outputs
from robobt.models.export import export_model
from robobt.models.file import Format, pack_archive, pack_onnx, payload_of, unpack_archive
from robobt.models.policy import load_policy
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS
from robobt.world.features import GO_TO_BALL, SHOOT
from robobt.world.scoring import SCORE_ON_GOALKEEPER
from robobt.world.team_view import team_view


def go_to_ball_card(name: str = "small", **changes: Any) -> ModelCard:
    fields: dict[str, Any] = {
        "kind": "policy",
        "name": name,
        "skill": "GoToBall",
        "observation": ObservationCard.of(GO_TO_BALL),
        "outputs": action_outputs(GO_TO_BALL_ACTION),
        "action": GO_TO_BALL_ACTION,
        "period": 0.03,
    }
    return ModelCard(**(fields | changes))


def shoot_card(name: str = "small_shot", **changes: Any) -> ModelCard:
    fields: dict[str, Any] = {
        "skill": "Shoot",
        "observation": ObservationCard.of(SHOOT),
        "outputs": action_outputs(SHOOT_ACTION),
        "action": SHOOT_ACTION,
    }
    return go_to_ball_card(name, **(fields | changes))


def score_card(name: str = "small_score", **changes: Any) -> ModelCard:
    fields: dict[str, Any] = {
        "skill": "Score",
        "observation": ObservationCard.of(SCORE_ON_GOALKEEPER),
        "outputs": action_outputs(SCORE_ACTION),
        "action": SCORE_ACTION,
    }
    return go_to_ball_card(name, **(fields | changes))


def team_card(skill: str, mates: int, opponents: int, **changes: Any) -> ModelCard:
    fields = {"skill": skill, "observation": ObservationCard.of(team_view(mates, opponents)), "period": 0.06}
    return score_card(**({"name": "small_team"} | fields | changes))


def among_robots_card(**changes: Any) -> ModelCard:
    fields = {"observation": ObservationCard.of(GO_TO_BALL_AMONG_ROBOTS), "period": 0.06}
    return go_to_ball_card(**({"name": "small_way"} | fields | changes))


def predictor_card(name: str = "predictor") -> ModelCard:
    return ModelCard(
        kind="shot_predictor",
        name=name,
        skill="SelectShot",
        observation=ObservationCard(name="mine", version=1, size=2, features=("angle [rad]", "distance [m]")),
        outputs=(OutputEntry(name="probability"),),
    )


def network(inputs: int = 6, outputs: int = 3, seed: int = 0) -> nn.Module:
    """A small random policy."""
    generator = torch.Generator().manual_seed(seed)
    layers = nn.Sequential(nn.Linear(inputs, 16), nn.ReLU(), nn.Linear(16, outputs), nn.Tanh())
    with torch.no_grad():
        for parameter in layers.parameters():
            parameter.copy_(torch.randn(parameter.shape, generator=generator) * 0.3)
    return layers


class Straight(nn.Module):
    """Drives straight at the ball, whatever the heading."""

    def forward(self, observation: Tensor) -> Tensor:
        sine, cosine = observation[:, 0:1], observation[:, 1:2]
        return torch.clamp(torch.cat([cosine, sine, 2.0 * sine], 1), -1.0, 1.0)


class Onward(nn.Module):
    """Drives at the ball, whoever is in the way, and turns the other way round."""

    def forward(self, observation: Tensor) -> Tensor:
        return torch.clamp(torch.cat([observation[:, :2], -observation[:, 1:2]], 1), -1.0, 1.0)


class Aimed(nn.Module):
    """Turns towards the goal and kicks when it lies ahead; the posts' angles are entries 6 to 9."""

    def forward(self, observation: Tensor) -> Tensor:
        aside = observation[:, 6:7] + observation[:, 8:9]
        ahead = observation[:, 7:8] + observation[:, 9:10]
        turn = torch.clamp(0.3 * torch.atan2(aside, ahead), -0.25, 0.25)
        between = torch.minimum(observation[:, 6:7], -observation[:, 8:9])
        return torch.cat([turn, torch.clamp(20.0 * torch.minimum(between, ahead) - 0.2, -1.0, 1.0)], 1)


class Passing(nn.Module):
    """Drives at the ball, and kicks where the goalkeeper stands to the left of the heading."""

    def forward(self, observation: Tensor) -> Tensor:
        drive = torch.clamp(observation[:, 3:5], -1.0, 1.0)
        return torch.cat([drive, 0.0 * drive[:, :1], torch.tanh(5.0 * observation[:, 14:15])], 1)


class Faulty(nn.Module):
    """A policy that goes wrong where an entry is above ``far``: by itself the ball's distance, 20 m."""

    def __init__(self, wrong: str, far: float = 20.0, entry: int = 2, outputs: int = 3) -> None:
        super().__init__()
        self.entry = entry
        self.outputs = outputs
        self.wrong = wrong
        self.far = far

    def forward(self, observation: Tensor) -> Tensor:
        action = torch.tanh(observation[:, : self.outputs])
        beyond = self.far - observation[:, self.entry : self.entry + 1]
        if self.wrong == "nan":
            return action + 0.0 * torch.log(beyond)
        return action - 5.0 * torch.clamp(beyond, max=0.0)


def write_model(
    folder: Path,
    module: nn.Module | None = None,
    card: ModelCard | None = None,
    formats: Sequence[Format] = ("torchscript",),
    probed: bool = True,
) -> Path:
    """A model file; a small random Go-To-Ball policy unless told otherwise.

    Args:
        probed: whether a policy that answers wrongly near at hand is refused, as it always is.
    """
    if not probed:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(policy, "_probe", lambda *_: None)
            patch.setattr(export, "_compare", lambda *_: None)
            path = write_model(folder, module, card, formats)
            load_policy(path)
            return path
    module = network() if module is None else module
    card = go_to_ball_card() if card is None else card
    return export_model(module, card, folder, formats, force=True)[0]


def sealed(folder: Path, members: dict[str, bytes]) -> Path:
    """A crafted archive whose card and seal are in order."""
    card = go_to_ball_card("crafted", payload=payload_of(members))
    path = folder / "crafted.pt"
    path.write_bytes(pack_archive(members, card.to_json()))
    return path


def members_of(folder: Path) -> dict[str, bytes]:
    """The members of a small policy, without its card."""
    members = unpack_archive(write_model(folder).read_bytes())
    del members["extra/card.json"]
    return members


def onnx_file(folder: Path, *nodes: onnx.NodeProto, external: bool = False) -> Path:
    """An ONNX file of these nodes, from "observation" to "output"; there are "weights" of 6 by 3."""
    weights = helper.make_tensor("weights", TensorProto.FLOAT, [6, 3], [0.1] * 18)
    if external:
        weights.ClearField("float_data")
        weights.data_location = TensorProto.EXTERNAL
        weights.external_data.add(key="location", value="/etc/hostname")
    return sealed_onnx(folder, onnx_model(nodes, [weights]))


def onnx_model(nodes: Sequence[onnx.NodeProto], weights: Sequence[onnx.TensorProto]) -> onnx.ModelProto:
    given = helper.make_tensor_value_info("observation", TensorProto.FLOAT, ["batch", 6])
    told = helper.make_tensor_value_info("output", TensorProto.FLOAT, ["batch", 3])
    graph = helper.make_graph(list(nodes), "crafted", [given], [told], list(weights))
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)


def sealed_onnx(folder: Path, model: onnx.ModelProto) -> Path:
    """A crafted ONNX file whose card and seal are in order."""
    content = model.SerializeToString()
    card = go_to_ball_card("crafted", payload=sha256(content).hexdigest())
    path = folder / "crafted.onnx"
    path.write_bytes(pack_onnx(content, card.to_json()))
    return path
