import json
from pathlib import Path

import numpy as np
import pytest
import torch

from paper.predictors import paper_features
from robobt.shots.data import ShotDataError, goals, read_shots, shot_inputs
from robobt.shots.predict.batched import Recipe, TrainingSet, train_networks
from robobt.shots.predict.networks import author_network
from robobt.shots.predict.validation import judge
from tests.shots.real_data import REAL_SHOTS, needs_real_shots


def _author_file(folder: Path, layers: object) -> Path:
    file = folder / "author_predictor.json"
    file.write_text(json.dumps({"layers": layers}))
    return file


def test_a_file_without_the_weights_of_table_1_is_refused(tmp_path: Path):
    with pytest.raises(ShotDataError, match=r"author_predictor\.json.*dense"):
        author_network(_author_file(tmp_path, {}))
    with pytest.raises(ShotDataError, match=r"missing\.json"):
        author_network(tmp_path / "missing.json")
    layers: dict[str, object] = {
        f"dense{end}": {"kernel": [[1.0]], "bias": [1.0]} for end in ("", "_1", "_2")
    }
    norm = {name: [1.0] for name in ("gamma", "beta", "moving_mean", "moving_variance")}
    layers |= {"batch_normalization": norm, "batch_normalization_1": norm}
    with pytest.raises(ShotDataError, match="size mismatch"):
        author_network(_author_file(tmp_path, layers))


def test_the_module_of_probabilities_answers_what_the_network_does():
    x = torch.randn(40, 4, generator=torch.Generator().manual_seed(0))
    y = (x[:, 0] > 0).float()
    network = train_networks([TrainingSet(x[:30], y[:30], x[30:], y[30:], 0)], Recipe(warm_up=2, epochs=3))[0]
    with torch.no_grad():
        expected = torch.sigmoid(network(x))
        torch.testing.assert_close(network.probabilities()(x), expected)
        # The network itself stays as it was.
        torch.testing.assert_close(torch.sigmoid(network(x)), expected)


@needs_real_shots
def test_the_authors_weights_give_his_confusion_matrix_and_outputs():
    file = REAL_SHOTS / "author_predictor.json"
    test = read_shots(REAL_SHOTS / "test.csv")
    with torch.no_grad():
        logits = author_network(file)(torch.tensor(paper_features(shot_inputs(test)), dtype=torch.float32))
    p = torch.sigmoid(logits)[:, 0].numpy()
    np.testing.assert_allclose(p, json.loads(file.read_text())["golden"]["test_probabilities"], atol=1e-6)
    assert judge(p, goals(test)).confusion == [[102, 20], [10, 69]]
