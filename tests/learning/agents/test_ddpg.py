from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from robobt.learning.agents.ddpg import DDPG, Atoms
from robobt.learning.agents.networks import Actor
from robobt.learning.agents.nstep import Transitions
from robobt.learning.agents.replay import PrioritisedReplay, ReplayBuffer
from robobt.learning.agents.settings import AgentSettings
from tests.learning.tiny import small_agent

SWITCHES = [
    {},
    {"twin_critics": True, "policy_delay": 2, "target_update_interval": 2, "target_policy_noise": 0.2},
    {"num_atoms": 21, "v_min": -5.0, "v_max": 5.0},
    {"num_atoms": 21, "v_min": -5.0, "v_max": 5.0, "twin_critics": True, "dqda_clipping": 1.0},
    {"layer_norm": True, "weight_decay": 1e-4},
]


def batch(seed=0, rows=64, replay=None):
    rng = np.random.default_rng(seed)
    replay = ReplayBuffer(rows, 3, 2) if replay is None else replay
    replay.add(
        Transitions(
            rng.normal(size=(rows, 3)),
            rng.uniform(-1, 1, (rows, 2)),
            rng.normal(size=rows),
            rng.choice([0.0, 0.9], rows),
            rng.normal(size=(rows, 3)),
        )
    )
    return replay.sample(32, rng)


def weights(module):
    return {key: value.clone() for key, value in module.state_dict().items()}


def same(one, other):
    return all(torch.equal(one[key], other[key]) for key in one)


@pytest.mark.integration
@pytest.mark.parametrize("switches", SWITCHES, ids=str)
def test_targets_follow_in_closed_form(switches):
    agent = small_agent(3, 2, **switches)
    before = weights(agent.target_critic)
    every = agent.settings.target_update_interval
    for i in range(every):
        assert i == 0 or same(before, weights(agent.target_critic))
        agent.update(batch(i), np.random.default_rng(i))
    for key, moved in weights(agent.target_critic).items():
        online = agent.critic.state_dict()[key]
        assert torch.allclose(moved, 0.9 * before[key] + 0.1 * online, atol=1e-7)


def test_the_target_forgets_a_fixed_network_at_the_rate_of_tau():
    agent = small_agent(3, 2, tau=0.05, actor_learning_rate=1e-12, critic_learning_rate=1e-12)
    with torch.no_grad():
        for weight in agent.target_critic.parameters():
            weight.add_(1.0)
    for i in range(20):
        agent.update(batch(i), np.random.default_rng(i))
    for slow, fixed in zip(agent.target_critic.parameters(), agent.critic.parameters(), strict=True):
        assert torch.allclose(slow - fixed, torch.full_like(slow, 0.95**20), atol=1e-4)


@pytest.mark.parametrize("switches", SWITCHES, ids=str)
def test_no_network_shares_memory_with_another(switches):
    agent = small_agent(3, 2, **switches)
    agent.update(batch(), np.random.default_rng(0))
    modules = [agent.actor, agent.critic, agent.target_actor, agent.target_critic]
    places = [weight.data_ptr() for module in modules for weight in module.parameters()]
    tensors = [each for _, adam in agent._optimisers() for kind in adam.moments.values() for each in kind]
    places += [tensor.data_ptr() for tensor in tensors]
    assert len(set(places)) == len(places)


@pytest.mark.parametrize("switches", SWITCHES, ids=str)
def test_the_actors_step_leaves_the_critic_alone_and_the_other_way_round(switches):
    agent = small_agent(3, 2, **switches)
    given, rng = batch(), np.random.default_rng(0)
    actor, critic = weights(agent.actor), weights(agent.critic)
    agent._update_critic(given, rng)
    assert same(actor, weights(agent.actor))
    assert not same(critic, weights(agent.critic))
    critic = weights(agent.critic)
    moments = [moment.clone() for moment in agent._critic_adam.moments["exp_avg"]]
    agent._update_actor(given.observation)
    assert same(critic, weights(agent.critic))
    now = agent._critic_adam.moments["exp_avg"]
    assert all(torch.equal(a, b) for a, b in zip(moments, now, strict=True))
    assert not same(actor, weights(agent.actor))


@pytest.mark.parametrize("switches", SWITCHES, ids=str)
def test_targets_never_get_a_gradient(switches):
    agent = small_agent(3, 2, **switches)
    for i in range(2):
        agent.update(batch(i), np.random.default_rng(i))
    for module in (agent.target_actor, agent.target_critic):
        assert all(weight.grad is None and not weight.requires_grad for weight in module.parameters())


def test_the_update_is_that_of_spinning_up_written_out():
    """The plain agent against the equations in the form anybody would write, with torch's own Adam."""
    agent = DDPG(AgentSettings(hidden_sizes=(16,)), (1.0,) * 3, (True, True), 5)
    plain = DDPG(AgentSettings(hidden_sizes=(16,)), (1.0,) * 3, (True, True), 5)
    actor_adam = torch.optim.Adam(plain.actor.parameters(), lr=1e-3)
    critic_adam = torch.optim.Adam(plain.critic.parameters(), lr=1e-3)
    for i in range(5):
        given = batch(i)
        agent.update(given, np.random.default_rng(i))
        r, d, s2 = (
            given.bootstraps[0].reward,
            given.bootstraps[0].discount,
            given.bootstraps[0].next_observation,
        )
        with torch.no_grad():
            y = r + d * plain.target_critic(s2, plain.target_actor(s2))[0, :, 0]
        loss = ((plain.critic(given.observation, given.action)[0, :, 0] - y) ** 2).mean()
        critic_adam.zero_grad()
        loss.backward()
        critic_adam.step()
        objective = plain.critic(given.observation, plain.actor(given.observation)).mean()
        actor_adam.zero_grad()
        (-objective).backward()
        actor_adam.step()
        with torch.no_grad():
            for slow, quick in (
                (plain.target_actor, plain.actor),
                (plain.target_critic, plain.critic),
            ):
                for p_slow, p_quick in zip(slow.parameters(), quick.parameters(), strict=True):
                    p_slow.mul_(0.995).add_(0.005 * p_quick)
    for ours, theirs in ((agent.actor, plain.actor), (agent.target_critic, plain.target_critic)):
        for a, b in zip(ours.parameters(), theirs.parameters(), strict=True):
            assert torch.allclose(a, b, atol=2e-6)


def test_smoothing_never_touches_a_masked_action():
    settings = AgentSettings(hidden_sizes=(8,), target_policy_noise=1.0, target_noise_clip=2.0)
    agent = DDPG(settings, (1.0,) * 3, (True, False), 0)
    action = torch.zeros(1000, 2)
    smoothed = agent._smooth(action, np.random.default_rng(0))
    assert float(smoothed[:, 0].std()) > 0.4
    assert float(smoothed.abs().max()) <= 1.0
    assert smoothed[:, 1].tolist() == [0.0] * 1000


def test_twin_critics_make_the_target_from_the_smaller_value():
    agent = small_agent(3, 2, twin_critics=True)
    with torch.no_grad():
        for head, bias in zip(agent.target_critic.heads, (5.0, -5.0), strict=True):
            head[-1].weight.zero_()
            head[-1].bias.fill_(bias)
    given = batch()
    target = agent._target(given.bootstraps[0], np.random.default_rng(0))
    bootstrap = given.bootstraps[0]
    assert torch.allclose(target[:, 0], bootstrap.reward - 5.0 * bootstrap.discount)


def test_twin_distributions_make_the_target_from_the_one_with_the_smaller_mean():
    agent = small_agent(3, 2, twin_critics=True, num_atoms=3, v_min=-1.0, v_max=1.0)
    with torch.no_grad():
        for head, logits in zip(agent.target_critic.heads, ([0.0, 0.0, 50.0], [0.0, 50.0, 0.0]), strict=True):
            head[-1].weight.zero_()
            head[-1].bias.copy_(torch.tensor(logits))
    given = batch()
    given.bootstraps[0].reward.zero_()
    assert torch.allclose(
        agent._target(given.bootstraps[0], np.random.default_rng(0))[:, 1], torch.ones(32), atol=1e-5
    )


def test_the_slope_that_the_actor_follows_is_limited():
    free, held = small_agent(3, 2), small_agent(3, 2, dqda_clipping=1e-3)
    given = batch()
    for agent in (free, held):
        agent._update_actor(given.observation)
    # After one step the first moment is a tenth of the gradient.
    firsts = [agent._actor_adam.moments["exp_avg"] for agent in (free, held)]
    largest = [max(float(moment.abs().max()) for moment in moments) for moments in firsts]
    assert largest[1] < 0.1 * largest[0]


def test_errors_and_gradients_are_returned_for_prioritised_replay():
    replay = PrioritisedReplay(64, 3, 2, alpha=0.3, beta=1.0, epsilon=1e-3, bonus=0.0)
    agent = small_agent(3, 2)
    given = batch(replay=replay)
    with torch.no_grad():
        estimate = agent.critic(given.observation, given.action)[0, :, 0]
        target = agent._target(given.bootstraps[0], np.random.default_rng(0))[:, 0]
    errors, gradients = agent.update(given, np.random.default_rng(0))
    assert torch.allclose(errors, (estimate - target) ** 2, atol=1e-5)
    assert errors.shape == gradients.shape == (32,)
    assert float(gradients.min()) >= 0.0
    assert float(gradients.max()) > 0.0


@pytest.mark.parametrize("switches", SWITCHES, ids=str)
def test_a_restored_agent_learns_on_as_the_one_it_was(switches):
    agent, again = small_agent(3, 2, seed=1, **switches), small_agent(3, 2, seed=2, **switches)
    for i in range(5):
        agent.update(batch(i), np.random.default_rng(i))
    again.restore(agent.state())
    for each in (agent, again):
        for i in range(5, 10):
            each.update(batch(i), np.random.default_rng(i))
    first, second = agent.state(), again.state()
    assert first.keys() == second.keys()
    assert all(np.array_equal(first[key], second[key]) for key in first)


def test_the_seed_fixes_the_weights():
    first, second, other = [small_agent(3, 2, seed=seed).state() for seed in (4, 4, 5)]
    assert all(np.array_equal(first[key], second[key]) for key in first)
    assert not np.array_equal(first["actor.body.0.weight"], other["actor.body.0.weight"])


def test_the_actor_scales_raw_observations_itself():
    plain, scaled = Actor((1.0, 1.0), 1, (8,)), Actor((2.0, 0.5), 1, (8,))
    scaled.body.load_state_dict(plain.body.state_dict())
    seen = torch.tensor([[0.3, -0.2]])
    assert torch.allclose(scaled(seen * torch.tensor([2.0, 0.5])), plain(seen))


def test_learning_rates_can_fall():
    agent = small_agent(3, 2)
    agent.set_learning_rates(0.5)
    assert [each.rate for _, each in agent._optimisers()] == [1e-3, 2.5e-3]


ATOMS = Atoms(-2.0, 3.0, 11)


def project(probabilities, reward, discount, atoms=ATOMS):
    row = torch.tensor([probabilities], dtype=torch.float32)
    return atoms.project(row, torch.tensor([reward]), torch.tensor([discount]))[0]


@given(
    st.lists(st.floats(0.01, 1.0), min_size=11, max_size=11),
    st.floats(-5.0, 5.0),
    st.floats(0.0, 1.0),
)
def test_no_probability_is_lost(weights, reward, discount):
    probabilities = np.array(weights) / np.sum(weights)
    projected = project(probabilities.tolist(), reward, discount)
    assert float(projected.sum()) == pytest.approx(1.0, abs=1e-5)
    assert float(projected.min()) >= -1e-6


@given(st.lists(st.floats(0.01, 1.0), min_size=11, max_size=11), st.floats(-0.5, 0.5), st.floats(0.0, 0.5))
def test_the_mean_inside_the_support_is_kept(weights, reward, discount):
    probabilities = np.array(weights) / np.sum(weights)
    mean = float(probabilities @ ATOMS.values.numpy())
    projected = project(probabilities.tolist(), reward, discount)
    assert float(projected @ ATOMS.values) == pytest.approx(reward + discount * mean, abs=1e-4)


def test_a_value_on_an_atom_stays_whole():
    one_hot = torch.eye(11)[4].tolist()
    assert project(one_hot, 0.5, 1.0).tolist() == pytest.approx(torch.eye(11)[5].tolist(), abs=1e-5)


def test_a_value_between_atoms_is_shared_in_proportion():
    projected = project(torch.eye(11)[4].tolist(), 0.125, 1.0)
    assert projected[4:6].tolist() == pytest.approx([0.75, 0.25], abs=1e-5)


@pytest.mark.parametrize(("reward", "atom"), [(100.0, 10), (-100.0, 0)])
def test_what_lies_outside_counts_as_the_last_atom(reward, atom):
    even = [1 / 11] * 11
    assert project(even, reward, 0.9)[atom] == pytest.approx(1.0, abs=1e-5)


def test_a_terminal_reward_is_all_there_is():
    projected = project([1 / 11] * 11, 1.0, 0.0)
    assert projected[6] == pytest.approx(1.0, abs=1e-5)


def test_a_support_that_rounds_badly_loses_nothing():
    atoms = Atoms(-60.0, 35.0, 51)
    row = torch.softmax(torch.randn(64, 51, generator=torch.Generator().manual_seed(0)), -1)
    for reward in (35.0, -60.0, 34.999996, 0.1):
        projected = atoms.project(row, torch.full((64,), reward), torch.full((64,), 0.99))
        assert projected.sum(-1).tolist() == pytest.approx([1.0] * 64, abs=1e-5)


def test_fewer_than_two_atoms_are_refused():
    with pytest.raises(ValueError, match="at least 2 atoms on a rising range, not 1"):
        Atoms(0.0, 1.0, 1)
