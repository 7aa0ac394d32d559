"""Settings of an agent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings


class AgentSettings(Settings):
    """The agent. Every default is Spinning Up's DDPG; each other value switches something on.

    ``n_step`` > 1, ``one_step_weight`` > 0 (DDPGfD's second loss), ``twin_critics``, ``policy_delay`` > 1
    and ``target_policy_noise`` > 0 (TD3), ``num_atoms`` > 0 (C51, D4PG) and ``layer_norm`` combine freely.
    """

    renamed: ClassVar[Mapping[str, str]] = {
        "hidden": "hidden_sizes",
        "target_every": "target_update_interval",
        "actor_rate": "actor_learning_rate",
        "critic_rate": "critic_learning_rate",
        "final_rate": "final_learning_rate_fraction",
        "twin": "twin_critics",
        "actor_every": "policy_delay",
        "smoothing": "target_policy_noise",
        "smoothing_limit": "target_noise_clip",
        "atoms": "num_atoms",
        "returns": "v_min and v_max",
        "dqda_limit": "dqda_clipping",
    }

    hidden_sizes: tuple[int, ...] = Field(
        (256, 256), min_length=1, max_length=6, description="units of each hidden layer"
    )
    layer_norm: bool = Field(False, description="normalise each hidden layer before its ReLU")
    gamma: float = Field(0.99, gt=0, lt=1, description="discount per control step")
    tau: float = Field(
        0.005, gt=0, le=1, description="fraction by which target networks move towards the online ones"
    )
    target_update_interval: int = Field(
        1, ge=1, le=100_000, description="critic updates between updates of the target networks"
    )
    actor_learning_rate: float = Field(1e-3, gt=0, le=1, description="of Adam")
    critic_learning_rate: float = Field(1e-3, gt=0, le=1, description="of Adam")
    final_learning_rate_fraction: float = Field(
        1.0, gt=0, le=1, description="both learning rates fall linearly to this fraction at the last step"
    )
    weight_decay: float = Field(0.0, ge=0, le=1, description="L2 regularisation of both networks")
    n_step: int = Field(1, ge=1, le=50, description="rewards summed before bootstrapping")
    one_step_weight: float = Field(
        0.0, ge=0, le=100, description="weight of a one-step loss beside the n-step one (DDPGfD)"
    )
    twin_critics: bool = Field(False, description="two critics; the smaller estimate makes the target (TD3)")
    policy_delay: int = Field(1, ge=1, le=100, description="critic updates per actor update (TD3)")
    target_policy_noise: float = Field(
        0.0, ge=0, le=1, description="standard deviation of the noise on the target action (TD3)"
    )
    target_noise_clip: float = Field(0.5, gt=0, le=2, description="limit of that noise")
    num_atoms: int = Field(0, ge=0, le=1001, description="atoms of a distributional critic; 0 for a value")
    v_min: float = Field(-170.0, description="return of the lowest atom")
    v_max: float = Field(110.0, description="return of the highest atom")
    dqda_clipping: float | None = Field(None, gt=0, description="largest norm of dQ/da (D4PG)")
    scale_observations: bool = Field(True, description="divide observations by the task's typical sizes")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.num_atoms == 1 or not self.v_min < self.v_max:
            raise ValueError("num_atoms must be 0 or at least 2, and v_min less than v_max")
        if max(self.hidden_sizes) > 4096 or min(self.hidden_sizes) < 1:
            raise ValueError("hidden layers have 1 to 4096 units")
        return self


class PPOSettings(Settings):
    """The learner PPO; the defaults are what the shipped Score was trained with."""

    renamed: ClassVar[Mapping[str, str]] = {
        "hidden": "hidden_sizes",
        "trace": "gae_lambda",
        "clip": "clip_coef",
        "rollout": "num_steps",
        "batch": "minibatch_size",
        "epochs": "num_epochs",
        "rate": "learning_rate",
        "entropy": "ent_coef",
        "longest_step": "max_grad_norm",
        "spread": "init_std",
        "critic_first": "critic_warmup_steps",
    }

    hidden_sizes: tuple[int, ...] = Field(
        (96, 96), min_length=1, max_length=6, description="units of each hidden layer, of policy and value"
    )
    network: Literal["flat", "entities"] = Field(
        "flat",
        description="flat: all entries are inputs of one perceptron; entities: team-mates and opponents are "
        "sets, so that the weights serve any number of robots; for tasks with several robots",
    )
    critic: Literal["own", "central"] = Field(
        "own",
        description="input of the value: own: the robot's observation; central: also the true state of all "
        "robots from its team's side; for tasks with several robots",
    )
    frame: Literal["robot", "ball"] = Field(
        "robot",
        description="frame of the observed vectors and of the velocity action: robot: the robot's; ball: "
        "the frame in which the ball is ahead, so that the policy is the same in all headings; for "
        "go_to_ball_among_robots",
    )
    gamma: float = Field(0.985, gt=0, lt=1, description="discount per decision, at first")
    final_gamma: float | None = Field(
        None, gt=0, lt=1, description="discount at the last step; 1 / (1 - gamma) moves linearly towards it"
    )
    gae_lambda: float = Field(0.95, ge=0, le=1, description="lambda of generalised advantage estimation")
    clip_coef: float = Field(0.2, gt=0, le=1, description="clipping range of the probability ratio")
    num_steps: int = Field(40, ge=1, le=10_000, description="decisions per environment in a rollout")
    minibatch_size: int = Field(1280, ge=1, le=1_000_000, description="decisions per minibatch")
    num_epochs: int = Field(4, ge=1, le=100, description="passes over each rollout")
    learning_rate: float = Field(
        1e-3, gt=0, le=1, description="of Adam; falls linearly to 0 at the last step"
    )
    ent_coef: float = Field(0.002, ge=0, le=1, description="weight of the entropy bonus")
    max_grad_norm: float = Field(0.5, gt=0, le=100, description="gradients are clipped to this norm")
    init_std: float = Field(0.6, gt=0, le=3, description="initial standard deviation of actions")
    critic_warmup_steps: int = Field(
        0, ge=0, description="steps in which only the value is trained, for a policy from init"
    )
    threshold_bias: float = Field(-2.5, ge=-10, le=10, description="initial log-odds of kicks")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if max(self.hidden_sizes) > 4096 or min(self.hidden_sizes) < 1:
            raise ValueError("hidden layers have 1 to 4096 units")
        return self
