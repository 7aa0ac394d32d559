"""What is exported answers what the network answers, is the same every time, and replaces nothing in vain."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from robobt.learning.agents.networks import Actor
from robobt.models import export
from robobt.models.card import Measured
from robobt.models.export import add_figures, export_model
from robobt.models.file import MANIFEST, Format, ModelError, read_manifest, read_model_file
from robobt.models.find import list_models
from robobt.models.policy import Policy, load_policy
from tests.models.made_models import go_to_ball_card, network, predictor_card

SCALE = (1.0, 1.0, 3.0, 1.5, 1.5, 1.4)


@pytest.mark.integration
@pytest.mark.parametrize(("layer_norm", "vectors"), [(False, ()), (True, ()), (False, (0, 3))])
@pytest.mark.parametrize("format_", ["torchscript", "onnx"])
def test_file_and_network_agree_on_random_inputs(
    tmp_path: Path, format_: Format, layer_norm: bool, vectors: tuple[int, ...]
) -> None:
    generator = torch.Generator().manual_seed(3)
    actor = Actor(SCALE, 3, (256, 256), layer_norm, generator, vectors=vectors)
    (path,) = export_model(actor, go_to_ball_card(), tmp_path, (format_,))
    loaded = load_policy(path)
    inputs = np.random.default_rng(9).normal(0.0, 2.0, (1000, 6)).astype(np.float32)
    with torch.no_grad():
        wanted = actor(torch.from_numpy(inputs)).numpy()
        alone = actor(torch.from_numpy(inputs[:1])).numpy()[0]
    np.testing.assert_allclose(loaded(inputs), wanted, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(loaded.single()(inputs[0]), alone, rtol=0.0, atol=1e-6)
    assert path.stat().st_size < export.MAX_EXPORT_SIZE


def test_the_scaling_of_observations_is_in_the_file(tmp_path: Path) -> None:
    plain, scaled = Actor((1.0,) * 6, 3, (16,)), Actor(SCALE, 3, (16,))
    scaled.body.load_state_dict(plain.body.state_dict())
    raw = np.array([0.1, 0.2, 3.0, 0.3, -0.3, 0.7])
    answer = load_policy(export_model(scaled, go_to_ball_card("scaled"), tmp_path)[0])(raw)
    unscaled = load_policy(export_model(plain, go_to_ball_card("plain"), tmp_path)[0])
    np.testing.assert_allclose(answer, unscaled(raw / SCALE), atol=1e-6)


def test_the_same_network_and_card_give_the_same_files(tmp_path: Path) -> None:
    formats: tuple[Format, ...] = ("torchscript", "onnx")
    export_model(network(), go_to_ball_card(), tmp_path / "a", formats)
    # Torch numbers what is traced; whatever else was traced in between must not show.
    export_model(network(seed=5), go_to_ball_card("other"), tmp_path / "b")
    export_model(network(), go_to_ball_card(), tmp_path / "c", formats)
    assert read_manifest(tmp_path / "a") == read_manifest(tmp_path / "c")


@pytest.mark.integration
def test_another_process_writes_the_same_file(tmp_path: Path) -> None:
    export_model(network(), go_to_ball_card(), tmp_path / "a")
    code = (
        "from pathlib import Path; from tests.models.made_models import *;"
        f"write_model(Path({str(tmp_path / 'b')!r}))"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parent.parent.parent)
    assert read_manifest(tmp_path / "a") == read_manifest(tmp_path / "b")


def test_a_module_keeps_its_mode_weights_and_device(tmp_path: Path) -> None:
    module = nn.Sequential(nn.Linear(6, 8), nn.Dropout(0.5), nn.Linear(8, 3), nn.Tanh()).train()
    before = {name: value.clone() for name, value in module.state_dict().items()}
    (path,) = export_model(module, go_to_ball_card(), tmp_path)
    assert module.training
    assert all(torch.equal(value, before[name]) for name, value in module.state_dict().items())
    policy = load_policy(path)
    assert policy(np.ones(6)).tolist() == policy(np.ones(6)).tolist()


@pytest.mark.parametrize("frozen", [False, True])
def test_a_torchscript_module_of_ones_own_is_exported_with_a_card(tmp_path: Path, frozen: bool) -> None:
    torch.jit.save(torch.jit.script(network().eval()), tmp_path / "own.pt")
    module = torch.jit.load(tmp_path / "own.pt")
    if frozen:
        module = torch.jit.freeze(module.eval())
    (path,) = export_model(module, go_to_ball_card(), tmp_path / "models")
    with torch.no_grad():
        wanted = network()(torch.ones(1, 6)).numpy()[0]
    np.testing.assert_allclose(load_policy(path)(np.ones(6)), wanted, atol=1e-6)


def test_a_predictor_is_exported_like_a_policy(tmp_path: Path) -> None:
    module = nn.Sequential(nn.Linear(2, 4), nn.ReLU(), nn.Linear(4, 1), nn.Sigmoid())
    for path in export_model(module, predictor_card(), tmp_path, ("torchscript", "onnx")):
        assert load_policy(path).card.kind == "shot_predictor"


class Steps(nn.Module):
    """Answers by a branch that tracing does not see."""

    def forward(self, observation: Tensor) -> Tensor:
        return torch.tanh(observation[:, :3]) if len(observation) < 500 else -torch.tanh(observation[:, :3])


@pytest.mark.parametrize(
    ("module", "said"),
    [
        (network(outputs=2), r"answers \(64, 2\)"),
        (network(inputs=5), "torch cannot export the network"),
        (nn.Linear(6, 3), "not within"),
        (Actor(SCALE, 3, (512, 512)), "more than 1048576"),
        (Steps(), "off those of the network"),
    ],
)
def test_what_does_not_fit_is_not_written(tmp_path: Path, module: nn.Module, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        export_model(module, go_to_ball_card(), tmp_path)
    assert os.listdir(tmp_path) == []


def test_what_was_there_stays_when_an_export_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (path,) = export_model(network(), go_to_ball_card(), tmp_path)
    before = {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)}

    def full(*_: object) -> bytes:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(export, "_onnx", full)
    with pytest.raises(OSError, match="No space"):
        export_model(network(seed=4), go_to_ball_card(), tmp_path, ("onnx",), force=True)
    assert {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)} == before
    assert load_policy(path).card.name == "small"


def test_a_model_is_never_replaced_without_being_told_to(tmp_path: Path) -> None:
    (path,) = export_model(network(), go_to_ball_card(), tmp_path)
    before = path.read_bytes()
    with pytest.raises(ModelError, match=r"small.pt: is there already; .*--force"):
        export_model(network(seed=4), go_to_ball_card(), tmp_path, ("onnx", "torchscript"))
    assert path.read_bytes() == before
    assert sorted(os.listdir(tmp_path)) == [MANIFEST, "small.pt"]
    export_model(network(seed=4), go_to_ball_card(), tmp_path, force=True)
    assert path.read_bytes() != before


@pytest.mark.parametrize("formats", [("torchscript", "onnx"), ("onnx", "torchscript")])
def test_the_format_that_succeeds_is_written_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, formats: tuple[Format, Format]
) -> None:
    def unknown(*_: object) -> bytes:
        raise RuntimeError("no such operator")

    monkeypatch.setattr(export, "_onnx", unknown)
    with pytest.raises(ModelError, match=r"small.onnx: .*no such operator; written all the same: .*small.pt"):
        export_model(network(), go_to_ball_card(), tmp_path, formats)
    assert load_policy(tmp_path / "small.pt").card.name == "small"
    assert set(read_manifest(tmp_path)) == {"small.pt"}


def test_onnx_may_round_as_single_precision_does_and_no_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Answers up to 1: an answer 5e-6 off is rounding, one 5e-5 off is another network."""
    right = Policy.__call__

    def off_by(gap: float) -> None:
        monkeypatch.setattr(Policy, "__call__", lambda self, inputs: right(self, inputs) + gap)

    off_by(5e-6)
    export_model(network(), go_to_ball_card("rounded"), tmp_path, ("onnx",))
    off_by(5e-5)
    with pytest.raises(ModelError, match="off those of the network"):
        export_model(network(), go_to_ball_card("other"), tmp_path, ("onnx",))


def test_a_full_disk_is_told_with_the_files_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left on device") as caught:
        export_model(network(), go_to_ball_card("mine"), tmp_path)
    assert caught.value.filename == str(tmp_path / "mine.pt")
    assert list(tmp_path.iterdir()) == []


def test_the_manifest_keeps_the_models_of_other_exports(tmp_path: Path) -> None:
    export_model(network(), go_to_ball_card("first"), tmp_path)
    export_model(network(), go_to_ball_card("second"), tmp_path, ("onnx",))
    export_model(network(seed=2), go_to_ball_card("first"), tmp_path, force=True)
    assert set(read_manifest(tmp_path)) == {"first.pt", "second.onnx"}
    for path in list_models(tmp_path):
        assert read_model_file(path).sha256 == read_manifest(tmp_path)[path.name]
    (tmp_path / MANIFEST).write_text("what?\n")
    with pytest.raises(ModelError, match="manifest, line 1"):
        export_model(network(), go_to_ball_card("third"), tmp_path)


def test_figures_are_added_to_a_card_and_nothing_else_changes(tmp_path: Path) -> None:
    first = {"success": Measured(value=0.9, n=100)}
    (path,) = export_model(network(), go_to_ball_card("mine", held_out=first), tmp_path)
    before, row = load_policy(path), np.linspace(-1.0, 1.0, 6)
    late = Measured(value=0.8, low=0.7, high=0.9, n=100, interval="95 % Wilson")
    add_figures(path, {"success, +60 ms": late})
    after = load_policy(path)
    assert after.card.held_out == {**first, "success, +60 ms": late}
    assert after.card.model_copy(update={"held_out": first}) == before.card
    np.testing.assert_array_equal(after(row), before(row))
    assert read_manifest(tmp_path)["mine.pt"] == read_model_file(path).sha256
    with pytest.raises(ModelError, match="its card would be"):
        add_figures(path, {str(k): late for k in range(2000)})
    (onnx,) = export_model(network(), go_to_ball_card("other"), tmp_path, ("onnx",))
    with pytest.raises(ModelError, match="TorchScript models only"):
        add_figures(onnx, {"success, +60 ms": late})
