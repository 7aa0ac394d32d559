"""Settings of an agent."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings


class AgentSettings(Settings):
    """The agent. Every default is Spinning Up's DDPG; each other value switches something on.

    ``n_step`` > 1, ``one_step_weight`` > 0 (DDPGfD's second loss), ``twin``,
    ``actor_every`` > 1 and ``smoothing`` > 0 (TD3), ``atoms`` > 0 (C51, D4PG) and
    ``layer_norm`` combine freely.
    """

    hidden: tuple[int, ...] = Field(
        (256, 256), min_length=1, max_length=6, description="hidden layers' sizes"
    )
    layer_norm: bool = Field(False, description="normalise each hidden layer before its ReLU")
    gamma: float = Field(0.99, gt=0, lt=1, description="discount a control step")
    tau: float = Field(
        0.005, gt=0, le=1, description="share by which targets move towards the online networks"
    )
    target_every: int = Field(1, ge=1, le=100_000, description="updates between the targets' moves")
    actor_rate: float = Field(1e-3, gt=0, le=1, description="learning rate of the actor (Adam)")
    critic_rate: float = Field(1e-3, gt=0, le=1, description="learning rate of the critic (Adam)")
    final_rate: float = Field(1.0, gt=0, le=1, description="share of both rates left at the last step")
    weight_decay: float = Field(0.0, ge=0, le=1, description="L2 regularisation of both networks")
    n_step: int = Field(1, ge=1, le=50, description="rewards summed before bootstrapping")
    one_step_weight: float = Field(
        0.0, ge=0, le=100, description="weight of a one-step loss beside the n-step one (DDPGfD)"
    )
    twin: bool = Field(False, description="two critics, of which the smaller makes the target (TD3)")
    actor_every: int = Field(1, ge=1, le=100, description="critic updates for one of the actor (TD3)")
    smoothing: float = Field(0.0, ge=0, le=1, description="noise on the target's action (TD3)")
    smoothing_limit: float = Field(0.5, gt=0, le=2, description="largest such noise")
    atoms: int = Field(0, ge=0, le=1001, description="atoms of a distributional critic; 0 for a value")
    returns: tuple[float, float] = Field((-170.0, 110.0), description="smallest and largest atom")
    dqda_limit: float | None = Field(None, gt=0, description="largest dQ/da that the actor follows (D4PG)")
    scale_observations: bool = Field(True, description="divide observations by the task's typical sizes")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.atoms == 1 or not self.returns[0] < self.returns[1]:
            raise ValueError("atoms must be 0 or at least 2, and returns rise")
        if max(self.hidden) > 4096 or min(self.hidden) < 1:
            raise ValueError("hidden layers have 1 to 4096 units")
        return self


class PPOSettings(Settings):
    """The learner PPO; the defaults are what the shipped Score was trained with."""

    hidden: tuple[int, ...] = Field(
        (96, 96), min_length=1, max_length=6, description="hidden layers' sizes, of policy and value each"
    )
    critic: Literal["own", "central"] = Field(
        "own",
        description="what the value is estimated from: what the robot sees, or besides the true state of all "
        "robots, as its team sees the field; for tasks of several robots",
    )
    frame: Literal["robot", "ball"] = Field(
        "robot",
        description="in which vectors are seen and a velocity is answered: the robot's, or that in which the "
        "ball lies ahead, by which what is learned in one heading is learned in all; for "
        "go_to_ball_among_robots",
    )
    gamma: float = Field(0.985, gt=0, lt=1, description="discount a decision, at first")
    final_gamma: float | None = Field(
        None, gt=0, lt=1, description="discount at the last step, towards which 1 / (1 - gamma) moves evenly"
    )
    trace: float = Field(0.95, ge=0, le=1, description="lambda of the advantages")
    clip: float = Field(0.2, gt=0, le=1, description="how far probabilities may move in an update")
    rollout: int = Field(40, ge=1, le=10_000, description="decisions of each arena between updates")
    batch: int = Field(1280, ge=1, le=1_000_000, description="decisions of a minibatch")
    epochs: int = Field(4, ge=1, le=100, description="times that a rollout is gone through")
    rate: float = Field(1e-3, gt=0, le=1, description="learning rate (Adam), falling to 0 at the last step")
    entropy: float = Field(0.002, ge=0, le=1, description="weight of the policy's entropy")
    longest_step: float = Field(0.5, gt=0, le=100, description="longest gradient")
    spread: float = Field(0.6, gt=0, le=3, description="standard deviation of actions at first")
    critic_first: int = Field(
        0, ge=0, description="steps in which the value alone is learned, such as that of a policy from init"
    )
    threshold_bias: float = Field(-2.5, ge=-10, le=10, description="log-odds of kicks at first")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if max(self.hidden) > 4096 or min(self.hidden) < 1:
            raise ValueError("hidden layers have 1 to 4096 units")
        return self
