"""Groups of a run's settings: replay, collection, evaluation, self-play and stages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings
from robobt.learning.opponents.play_settings import GivenPlay, PlaySettings


class PrioritySettings(Settings):
    """Prioritised replay; off unless ``enabled``."""

    renamed: ClassVar[Mapping[str, str]] = {"floor": "epsilon"}

    enabled: bool = False
    alpha: float = Field(0.3, ge=0, le=1, description="0 samples uniformly, 1 in proportion to priorities")
    beta: float = Field(1.0, ge=0, le=1, description="exponent of the importance weights")
    epsilon: float = Field(1e-3, gt=0, le=10, description="added to every priority")
    dqda_weight: float = Field(1.0, ge=0, le=100, description="weight of the squared norm of dQ/da")


class DemonstrationSettings(Settings):
    """Demonstrations in the replay before the agent's own steps; none unless ``episodes`` > 0.

    ``keep`` and a ``bonus`` make it DDPGfD; without them, in place of random
    steps, it is the burn-in of Schwab, Zhu & Veloso (CMU).
    """

    renamed: ClassVar[Mapping[str, str]] = {"updates": "pretrain_gradient_steps"}

    episodes: int = Field(0, ge=0, le=100_000, description="number to record or to take from the file")
    file: str | None = Field(None, description="Parquet file; None records them with the scripted skill")
    keep: bool = Field(False, description="never overwrite them")
    bonus: float = Field(0.0, ge=0, le=100, description="added to their priorities")
    pretrain_gradient_steps: int = Field(
        0, ge=0, le=1_000_000, description="updates on them alone, before the first environment step"
    )


class ReplaySettings(Settings):
    """The replay buffer and how it is sampled."""

    renamed: ClassVar[Mapping[str, str]] = {"capacity": "buffer_size", "batch": "batch_size"}

    buffer_size: int = Field(1_000_000, ge=100, le=20_000_000, description="transitions")
    batch_size: int = Field(100, ge=1, le=100_000, description="transitions per update")
    priority: PrioritySettings = PrioritySettings()
    demonstrations: DemonstrationSettings = DemonstrationSettings()

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.demonstrations.bonus and not self.priority.enabled:
            raise ValueError("demonstrations get a bonus only with priority.enabled")
        return self


class ExperienceSettings(Settings):
    """How the agent gathers experience.

    Steps are environment steps, summed over the ``num_envs`` environments.
    """

    renamed: ClassVar[Mapping[str, str]] = {
        "environments": "num_envs",
        "update_after": "learning_starts",
        "update_every": "train_freq",
        "updates": "gradient_steps",
        "noise": "exploration_noise",
        "last_noise": "exploration_noise_last_env",
    }

    num_envs: int = Field(
        1,
        ge=1,
        le=4096,
        description="environments side by side; each learning robot counts as one",
    )
    random_steps: int = Field(10_000, ge=0, description="steps of uniformly random actions at the beginning")
    learning_starts: int = Field(1_000, ge=0, description="steps before the first update")
    train_freq: int = Field(50, ge=1, description="steps between rounds of updates")
    gradient_steps: int = Field(50, ge=1, description="updates per round")
    exploration_noise: float = Field(
        0.1, ge=0, le=2, description="standard deviation of the noise on actions"
    )
    exploration_noise_last_env: float | None = Field(
        None,
        ge=0,
        le=2,
        description="exploration noise of the last environment; of those between it is evenly spaced; None "
        "for the same in all",
    )


class EvaluationSettings(Settings):
    """How progress is evaluated: by success and time, never by the return.

    The return misleads: near the ball a slow policy collects more reward than a fast one.
    """

    every: int = Field(20_000, ge=1, description="steps between evaluations")
    starts: int = Field(300, ge=1, le=100_000, description="number of fixed validation starts")
    held_out: int = Field(
        1_000, ge=1, le=100_000, description="number of fixed starts on which the best actor is evaluated"
    )
    environment: dict[str, Any] = Field(
        default_factory=dict,
        description="changes to the environment in all evaluations, such as a fixed opponent",
    )
    held_out_environment: dict[str, Any] = Field(
        default_factory=dict,
        description="further changes for the held-out starts, such as opponents not met in training",
    )
    enough: float = Field(
        1.0,
        gt=0,
        le=1,
        description="success rate above which only the mean time decides which weights are the best",
    )
    target_actor: bool = Field(
        False, description="evaluate and keep the target actor instead of the online one"
    )
    stop_success: float | None = Field(
        None, ge=0, le=1, description="stop early once this share of the starts succeeds and ..."
    )
    stop_time: float | None = Field(
        None,
        gt=0,
        description="... the mean time, over the optimum where there is one, else in s, is no more",
    )
    stop_after: int = Field(1, ge=1, le=100, description="... in this many evaluations in a row")


Script = Literal["challenge", "still", "press", "mark", "wall", "attack", "pass", "redirect"]
"""A scripted field player: ``challenge``, or one of
:data:`robobt.learning.opponents.field_players.PLAYERS`."""


class PoolSettings(Settings):
    """Opponents of the learners in a share of the arenas; in the other arenas the policy plays itself.

    For tasks with learners on both teams. Opponents replace yellow's learners, so that only blue's learn
    there. Past selves are frozen copies of the policy that act without noise; all play in equally many
    arenas.
    """

    size: int = Field(8, ge=1, le=64, description="number of past selves; the newest are kept")
    every: int = Field(307_200, ge=1, description="steps between past selves, a multiple of rebuild_every")
    share: float = Field(0.0, ge=0, le=1, description="share of the learners that play against past selves")
    scripts: tuple[Script, ...] = Field((), max_length=8, description="scripted opponents")
    scripted: float = Field(0.0, ge=0, le=1, description="share of the learners that play against scripts")
    plays: tuple[GivenPlay, ...] = Field(
        (), max_length=8, description="plays as opponents; they cost much computing time"
    )
    played: float = Field(0.0, ge=0, le=1, description="share of the learners that play against plays")

    @property
    def opponents(self) -> tuple[Script | PlaySettings, ...]:
        """All opponents except the past selves."""
        return (*self.scripts, *self.plays)

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of the learners that play against past selves and against each of :attr:`opponents`."""
        scripted = [self.scripted / len(self.scripts) for _ in self.scripts]
        return (self.share, *scripted, *(self.played / len(self.plays) for _ in self.plays))

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.share + self.scripted + self.played > 1.0:
            raise ValueError("share, scripted and played are more than 1 together")
        if bool(self.scripts) != bool(self.scripted):
            raise ValueError("scripts and their share, scripted, are given together")
        if bool(self.plays) != bool(self.played):
            raise ValueError("plays and their share, played, are given together")
        return self


class ImitationSettings(Settings):
    """The first steps of a run, in which the policy imitates a teacher instead of earning rewards.

    At first the teacher moves the robots, later more and more often the policy, and the teacher shows what it
    would have done (DAgger). The value learns from the rewards meanwhile. With a ``weight`` the teacher goes
    on to show what it would do while the policy learns by itself, so that the policy stays close to it.
    """

    teachers: tuple[str, ...] = Field(
        (),
        max_length=64,
        description="plays, or models by name or file: one for all worlds, or one for each; () for none",
    )
    params: dict[str, Any] = Field(default_factory=dict, description="parameters of those that are plays")
    steps: int = Field(0, ge=0, description="steps of imitation; from then on the policy learns by itself")
    weight: float = Field(
        0.0,
        ge=0,
        le=100,
        description="weight of imitation beside PPO's own loss after these steps; falls linearly to 0 at the "
        "last step",
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        if bool(self.teachers) != bool(self.steps or self.weight):
            raise ValueError("teachers are given together with steps or a weight")
        return self


class StageSettings(Settings):
    """A part of the run in which the environment or the pool differs: a curriculum."""

    share: float = Field(gt=0, le=1, description="of the run's steps, relative to the other stages' shares")
    environment: dict[str, Any] = Field(
        default_factory=dict, description="changes to the environment; evaluations use the run's own"
    )
    pool: dict[str, Any] = Field(
        default_factory=dict, description="changes to the pool's shares and scripts; its past selves stay"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("size", "every"):
            if name in self.pool:
                raise ValueError(f"pool.{name} is the same in all stages: set it for the run")
        return self
