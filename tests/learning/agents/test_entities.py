"""The network that treats robots as sets: neither their order nor the number of places matters."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from robobt.learning.agents.networks import Actor, resized
from robobt.learning.agents.ppo import PPO
from robobt.learning.agents.rollout import Rollout
from robobt.learning.agents.settings import PPOSettings
from robobt.models.actions import SCORE_ACTION
from robobt.models.card import ModelCard, ObservationCard, action_outputs
from robobt.models.export import export_model
from robobt.models.file import Format
from robobt.models.policy import load_policy
from robobt.world.team_view import AWAY, team_view

OWN = 19


def scale(mates: int, opponents: int, told: int = 0) -> list[float]:
    return [1.0 + 0.1 * k for k in range(OWN)] + [2.0, 2.0, 3.0, 3.0] * (mates + opponents) + [1.0] * told


def actor(mates: int, opponents: int, told: int = 0, seed: int = 0) -> Actor:
    spec = team_view(mates, opponents, told)
    generator = torch.Generator().manual_seed(seed)
    sizes = scale(mates, opponents, told)
    return Actor(sizes, 4, [16, 16], False, generator, "tanh", (), spec.groups)


def rows(own: np.ndarray, mates: np.ndarray, opponents: np.ndarray, places: tuple[int, int]) -> np.ndarray:
    """Return observations (n, ...) of robots (n, M, 4) and (n, K, 4), with empty places behind them."""
    parts = [own]
    for robots, count in zip((mates, opponents), places, strict=True):
        empty = np.tile([-AWAY, 0.0, 0.0, 0.0], (len(own), count - robots.shape[1], 1))
        parts.append(np.concatenate((robots, empty), axis=1).reshape(len(own), -1))
    return np.concatenate(parts, axis=1)


def decided(one: Actor, seen: np.ndarray) -> np.ndarray:
    with torch.no_grad():
        answer: np.ndarray = one(torch.from_numpy(seen.astype(np.float32))).numpy()
    return answer


def team(seed: int, mates: int, opponents: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    own, beside, against = (rng.normal(size=shape) for shape in ((3, OWN), (3, mates, 4), (3, opponents, 4)))
    return own, beside, against


@given(st.integers(0, 2**31), st.integers(0, 6), st.integers(0, 6))
def test_the_order_of_robots_does_not_matter(seed: int, mates: int, opponents: int) -> None:
    own, beside, against = team(seed, mates, opponents)
    one, places = actor(6, 6), (6, 6)
    rng = np.random.default_rng(seed + 1)
    mixed = rng.permuted(np.arange(mates)), rng.permuted(np.arange(opponents))
    shuffled = rows(own, beside[:, mixed[0]], against[:, mixed[1]], places)
    np.testing.assert_allclose(
        decided(one, shuffled), decided(one, rows(own, beside, against, places)), atol=1e-6
    )


@given(st.integers(0, 2**31), st.integers(0, 4), st.integers(0, 5))
def test_empty_places_do_not_matter(seed: int, mates: int, opponents: int) -> None:
    own, beside, against = team(seed, mates, opponents)
    few, many = actor(mates, opponents), (10, 11)
    more = resized(few, scale(*many), team_view(*many).groups)
    np.testing.assert_allclose(
        decided(more, rows(own, beside, against, many)),
        decided(few, rows(own, beside, against, (mates, opponents))),
        atol=1e-6,
    )


def test_each_robot_matters() -> None:
    own, beside, against = team(3, 3, 3)
    one = actor(3, 3)
    before = decided(one, rows(own, beside, against, (3, 3)))
    for robots in (beside, against):
        for k in range(3):
            robots[:, k] += 1.0
            after = decided(one, rows(own, beside, against, (3, 3)))
            assert (np.abs(after - before).max(axis=1) > 1e-4).all()
            before = after


def test_a_team_of_one_has_gradients_for_all_weights() -> None:
    one = actor(0, 1)
    own, beside, against = team(6, 0, 1)
    seen = torch.from_numpy(rows(own, beside, against, (0, 1)).astype(np.float32))
    gradients = torch.autograd.grad(one(seen).sum(), [*one.parameters()])
    assert all(bool(torch.isfinite(gradient).all()) for gradient in gradients)


def test_a_mate_is_not_an_opponent() -> None:
    own, beside, against = team(4, 2, 2)
    one = actor(2, 2)
    swapped = decided(one, rows(own, against, beside, (2, 2)))
    assert np.abs(swapped - decided(one, rows(own, beside, against, (2, 2)))).max() > 1e-3


def test_what_follows_the_robots_is_the_robots_own() -> None:
    own, beside, against = team(5, 2, 2)
    one, robots = actor(2, 2, told=2), rows(own, beside, against, (2, 2))
    quiet, told = (np.column_stack((robots, np.full((3, 2), value))) for value in (0.0, 1.0))
    assert np.abs(decided(one, quiet) - decided(one, told)).max() > 1e-3
    more = resized(one, scale(4, 4, 2), team_view(4, 4, 2).groups)
    wide = np.column_stack((rows(own, beside, against, (4, 4)), np.ones((3, 2))))
    np.testing.assert_allclose(decided(more, wide), decided(one, told), atol=1e-6)


@pytest.mark.parametrize(
    ("one", "sizes", "told", "problem"),
    [
        (Actor(scale(1, 1), 4, [4]), scale(2, 2), 0, "serves one number of robots only"),
        (actor(1, 1), scale(2, 2, 1), 1, "other kinds or scales"),
        (actor(1, 1), [5.0, *scale(2, 2)[1:]], 0, "other kinds or scales"),
    ],
)
def test_another_observation_is_refused(one: Actor, sizes: list[float], told: int, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        resized(one, sizes, team_view(2, 2, told).groups)


@pytest.mark.parametrize("format_", ["torchscript", "onnx"])
def test_a_file_answers_as_the_network_does(tmp_path: Path, format_: Format) -> None:
    spec = team_view(10, 11)
    card = ModelCard(
        kind="policy",
        name="entities",
        skill="LearnedSkill",
        description="A test.",
        algorithm="ppo",
        observation=ObservationCard.of(spec),
        outputs=action_outputs(SCORE_ACTION),
        action=SCORE_ACTION,
        period=0.06,
        created_by="a test",
    )
    one = actor(10, 11)
    with torch.no_grad():
        # Weights as large as after training, so that sums in another order differ by more.
        for weights in one.parameters():
            weights.mul_(3.0)
    (path,) = export_model(one, card, tmp_path, (format_,))
    assert path.stat().st_size < 2**20
    policy = load_policy(path)
    for mates, opponents in ((0, 0), (1, 2), (10, 11)):
        own, beside, against = team(mates, mates, opponents)
        seen = rows(own, beside, against, (10, 11))
        np.testing.assert_allclose(policy(seen), decided(one, seen), atol=1e-5)


def test_ppo_finds_the_nearer_of_two_robots() -> None:
    """The sign of the action that is rewarded depends on which kind of robot stands nearer."""
    places = 3, 3
    spec = team_view(*places)
    settings = PPOSettings(hidden_sizes=(16,), network="entities", learning_rate=0.01)
    one = PPO(settings, scale(*places), (True,), 0, groups=spec.groups)
    rng = np.random.default_rng(0)

    def scene(count: int) -> tuple[np.ndarray, np.ndarray]:
        mates, opponents = rng.normal(size=(2, count, 2, 4))
        near, far = (np.hypot(one[..., 0], one[..., 1]).min(axis=1) for one in (mates, opponents))
        return rows(np.zeros((count, OWN)), mates, opponents, places), np.sign(near - far)

    seen, side = scene(2048)
    rollout = Rollout.empty(1, 2048, spec.size, 1)
    rollout.observation[0], rollout.action[0, :, 0] = seen, 0.8 * side
    rollout.ended[:] = rollout.terminated[:] = True
    for _ in range(40):
        one.update(rollout, rng, "imitate")
    fresh, asked = scene(1000)
    assert (np.sign(decided(one.actor, fresh)[:, 0]) == asked).mean() > 0.9
