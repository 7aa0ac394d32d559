"""Settings of a training run: agent, collection, replay, exploration and evaluation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, Self, TypeVar

from pydantic import BaseModel, Field, ValidationError, model_validator

from robobt.config.errors import ConfigError
from robobt.config.validation import Settings, first_problem
from robobt.config.yaml import read_yaml
from robobt.learning.agents.settings import AgentSettings, PPOSettings
from robobt.learning.envs import TaskSettings
from robobt.learning.envs.make import ENVIRONMENTS, SEVERAL, learners_of

_PRESETS = Path(__file__).parent / "presets"
SWITCHES = _PRESETS / "switches.yaml"
"""The changes to the fast preset that comparisons are made of."""

_M = TypeVar("_M", bound=BaseModel)


class SettingsError(ConfigError):
    """Settings that cannot be used."""


class PrioritySettings(Settings):
    """Prioritised replay; off unless ``enabled``."""

    enabled: bool = False
    alpha: float = Field(0.3, ge=0, le=1, description="0 samples uniformly, 1 in proportion")
    beta: float = Field(1.0, ge=0, le=1, description="how far importance weights correct for it")
    floor: float = Field(1e-3, gt=0, le=10, description="added to every priority")
    dqda_weight: float = Field(1.0, ge=0, le=100, description="weight of the squared norm of dQ/da")


class DemonstrationSettings(Settings):
    """Demonstrations in the replay before the agent's own steps; none unless ``episodes`` > 0.

    ``keep`` and a ``bonus`` make it DDPGfD; without them, in place of random
    steps, it is the burn-in of Schwab, Zhu & Veloso (CMU).
    """

    episodes: int = Field(0, ge=0, le=100_000, description="how many to record or to take from the file")
    file: str | None = Field(None, description="Parquet file; None records them with the scripted skill")
    keep: bool = Field(False, description="never overwrite them")
    bonus: float = Field(0.0, ge=0, le=100, description="added to their priorities")
    updates: int = Field(0, ge=0, le=1_000_000, description="updates on them alone, before the first step")


class ReplaySettings(Settings):
    """The replay buffer and how it is sampled."""

    capacity: int = Field(1_000_000, ge=100, le=20_000_000, description="transitions")
    batch: int = Field(100, ge=1, le=100_000, description="transitions of an update")
    priority: PrioritySettings = PrioritySettings()
    demonstrations: DemonstrationSettings = DemonstrationSettings()

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.demonstrations.bonus and not self.priority.enabled:
            raise ValueError("demonstrations get a bonus only with priority.enabled")
        return self


class CollectionSettings(Settings):
    """How the agent gathers experience. Steps are environment steps, whatever ``environments`` is."""

    environments: int = Field(1, ge=1, le=4096, description="that run side by side, each learner counted")
    random_steps: int = Field(10_000, ge=0, description="of uniformly random actions, to begin with")
    update_after: int = Field(1_000, ge=0, description="steps before the first update")
    update_every: int = Field(50, ge=1, description="steps between rounds of updates")
    updates: int = Field(50, ge=1, description="updates a round")
    noise: float = Field(0.1, ge=0, le=2, description="standard deviation of the noise on actions")
    last_noise: float | None = Field(
        None,
        ge=0,
        le=2,
        description="that of the last environment; those between are evenly spaced; None for the same",
    )


class EvaluationSettings(Settings):
    """How progress is evaluated: by success and time, never by the return.

    A slow policy near the ball collects more reward than a fast one.
    """

    every: int = Field(20_000, ge=1, description="steps between evaluations")
    starts: int = Field(300, ge=1, le=100_000, description="fixed validation starts of each evaluation")
    held_out: int = Field(
        1_000, ge=1, le=100_000, description="fixed starts that the best actor is evaluated on"
    )
    held_out_environment: dict[str, Any] = Field(
        default_factory=dict, description="changes to the environment for those, such as opponents never met"
    )
    target_actor: bool = Field(
        False, description="evaluate and ship the slow actor instead of the online one"
    )
    stop_success: float | None = Field(
        None, ge=0, le=1, description="stop once this share of the starts succeeds and ..."
    )
    stop_time: float | None = Field(
        None,
        gt=0,
        description="... the mean time, over the optimum where there is one, else in s, is no more",
    )
    stop_after: int = Field(1, ge=1, le=100, description="so often running")


class TrainSettings(Settings):
    """A training run: with a seed and a version it gives the same weights, bit for bit, on a machine."""

    task: str = Field(description="what is learned, by name: go_to_ball, shoot, ...")
    preset: str = Field("", description="where these settings come from")
    seed: int = Field(0, ge=0, le=2**53 - 1, description="what all randomness follows from")
    steps: int = Field(description="environment steps at most", ge=1, le=1_000_000_000)
    environment: dict[str, Any] = Field(default_factory=dict, description="changes to the task's settings")
    worlds: tuple[dict[str, Any], ...] = Field(
        (),
        max_length=64,
        description="changes to the environment, such as other simulators: the arenas and the validation "
        "starts are shared evenly among these worlds; none for the environment alone",
    )
    learner: Literal["ddpg", "ppo"] = Field(
        "ddpg", description="what learns: ddpg with the settings of agent, replay and collection, or ppo"
    )
    agent: AgentSettings = AgentSettings()
    ppo: PPOSettings = PPOSettings()
    replay: ReplaySettings = ReplaySettings()
    collection: CollectionSettings = CollectionSettings()
    evaluation: EvaluationSettings = EvaluationSettings()
    rebuild_every: int = Field(
        20_000,
        ge=1,
        description="steps after which the simulator is built anew and a checkpoint may be written; "
        "fewer than a slow machine takes in a minute",
    )
    checkpoint_seconds: float = Field(20.0, ge=0, le=60, description="time between checkpoints at least [s]")
    tensorboard: bool = Field(True, description="write TensorBoard events beside the log")

    @property
    def central(self) -> bool:
        """Whether a central critic learns."""
        return self.learner == "ppo" and self.ppo.critic == "central"

    @property
    def algorithm(self) -> str:
        """What learns, by the name of the paper whose switches are on; "ddpg" only without any of them.

        ``d4pg`` has a distributional critic, ``td3`` twin critics, a delayed actor or smoothed targets,
        ``ddpgfd`` keeps demonstrations; ``3-step ddpg`` is DDPG with 3-step returns.
        """
        if self.learner == "ppo":
            return "mappo" if self.central else "ppo"
        agent, named = self.agent, []
        if agent.atoms:
            named.append("d4pg")
        if agent.twin or agent.actor_every > 1 or agent.smoothing:
            named.append("td3")
        if self.replay.demonstrations.keep:
            named.append("ddpgfd")
        steps = f"{agent.n_step}-step " if agent.n_step > 1 and not agent.atoms else ""
        return steps + ("+".join(named) or "ddpg")

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name, every in (
            ("evaluation.every", self.evaluation.every),
            ("rebuild_every", self.rebuild_every),
        ):
            if every % self.collection.environments:
                raise ValueError(
                    f"{name} must be a multiple of collection.environments ({self.collection.environments})"
                )
        if len(self.worlds) > min(self.collection.environments, self.evaluation.starts):
            raise ValueError("worlds: more than there are arenas or validation starts to share")
        return self


def presets(task: str) -> list[str]:
    """Return the names of the presets that ship for a task."""
    return sorted(path.stem for path in _folder(task).glob("*.yaml"))


def _folder(task: str) -> Path:
    return _PRESETS / ("several_robots" if task in SEVERAL else task)


def load_settings(
    task: str, preset: str = "fast", changes: Mapping[str, object] | None = None
) -> TrainSettings:
    """Load settings from a preset or a file.

    Args:
        task: of the preset.
        preset: name of a preset, or a YAML file. Either may say ``extends: NAME`` and then
            holds only what differs.
        changes: by dotted name, such as ``{"agent.n_step": 5}``.

    Raises:
        SettingsError: no such preset, or something wrong in the file or the changes.
    """
    data, source = _read(task, preset, ())
    data = {"task": task, **data, "preset": preset}
    for name, value in (changes or {}).items():
        _assign(data, name.split("."), value, name)
    if changes:
        source = f"{source}, with {', '.join(changes)} changed"
    settings = settings_of(data, source)
    if settings.task not in ENVIRONMENTS:
        problem = f"there is no {settings.task!r}; there are {', '.join(ENVIRONMENTS)}"
        raise SettingsError(source, problem, "task")
    environment = environment_of(settings, source)
    evaluated_on(settings, source)
    worlds_of(settings, source)
    if settings.collection.environments % learners_of(environment):
        problem = f"must be a multiple of the {learners_of(environment)} robots that learn in an arena"
        raise SettingsError(source, problem, "collection.environments")
    if settings.central and settings.task not in SEVERAL:
        problem = f"a central critic is for tasks of several robots, such as {next(iter(SEVERAL))}"
        raise SettingsError(source, problem, "ppo.critic")
    # Written out in full, so that a default that changes later does not change this run.
    return settings.model_copy(update={"environment": environment.model_dump(mode="json")})


def settings_of(data: Mapping[str, Any], source: str) -> TrainSettings:
    """Validate plain data, but for the task's environment.

    Raises:
        SettingsError: the message begins with ``source`` and names the field.
    """
    return _validated(TrainSettings, dict(data), source, "")


def environment_of(settings: TrainSettings, source: str = "settings") -> TaskSettings:
    """Return the environment's settings."""
    return _validated(ENVIRONMENTS[settings.task], settings.environment, source, "environment")


def evaluated_on(settings: TrainSettings, source: str = "settings") -> TaskSettings:
    """Return the settings of the environment in which the held-out starts are played."""
    data = _merged(settings.environment, settings.evaluation.held_out_environment)
    return _validated(
        ENVIRONMENTS[settings.task], data, source, "environment with evaluation.held_out_environment"
    )


def worlds_of(settings: TrainSettings, source: str = "settings") -> tuple[TaskSettings, ...]:
    """Return the settings of each world that the run trains in; without others, of the environment."""
    model, data = ENVIRONMENTS[settings.task], settings.environment
    return tuple(
        _validated(model, _merged(data, changes), source, f"environment with worlds[{index}]")
        for index, changes in enumerate(settings.worlds or ({},))
    )


def _validated(model: type[_M], data: dict[str, Any], source: str, group: str) -> _M:
    try:
        return model.model_validate(data)
    except ValidationError as error:
        field, problem = first_problem(error, model, data)
        place = ".".join([part for part in (group, field) if part])
        raise SettingsError(source, problem, place) from error


def _read(task: str, preset: str, seen: tuple[str, ...]) -> tuple[dict[str, Any], str]:
    bundled = _folder(task) / f"{preset}.yaml"
    path = bundled if bundled.is_file() else Path(preset)
    if path is not bundled and path.suffix not in (".yaml", ".yml"):
        known = presets(task)
        if not known:
            raise SettingsError("", f"no task is called {task!r}; there are {', '.join(ENVIRONMENTS)}")
        raise SettingsError("", f"no preset of {task} is called {preset!r}; there are {', '.join(known)}")
    data = read_yaml(path, SettingsError)
    base = data.pop("extends", None)
    if base is None:
        return data, str(path)
    if not isinstance(base, str) or base in seen:
        raise SettingsError(str(path), "must name another preset", "extends")
    return _merged(_read(task, base, (*seen, preset, base))[0], data), str(path)


def _merged(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    result = dict(base)
    for key, value in changes.items():
        old = result.get(key)
        result[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return result


def _assign(data: dict[str, Any], path: list[str], value: object, name: str) -> None:
    *groups, last = path
    for group in groups:
        inner = data.get(group, {})
        if not isinstance(inner, dict):
            raise SettingsError("", f"{group} holds a value, not settings", name)
        data[group] = inner = dict(inner)
        data = inner
    data[last] = value
