"""Settings of a training run, loading them, and the environments that they describe."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Self, TypeVar

from pydantic import BaseModel, Field, SerializeAsAny, ValidationError, model_validator

from robobt.config.validation import Settings, first_problem
from robobt.learning.agents.settings import AgentSettings, PPOSettings
from robobt.learning.envs import TaskSettings, find_task, make_task
from robobt.learning.envs.make import learners_of, make_rows, task_file
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.training.arenas import learners_in, opposed
from robobt.learning.training.preset_files import SettingsError as SettingsError
from robobt.learning.training.preset_files import assign, merged, read_preset
from robobt.learning.training.setting_groups import (
    EvaluationSettings,
    ExperienceSettings,
    ImitationSettings,
    PoolSettings,
    ReplaySettings,
    StageSettings,
)

_M = TypeVar("_M", bound=BaseModel)


class TrainSettings(Settings):
    """A training run; the same settings give the same weights, bit for bit, on one machine and version."""

    task: str = Field(description="name of the task: go_to_ball, shoot, ...")
    preset: str = Field("", description="name or file of the preset that these settings come from")
    seed: int = Field(0, ge=0, le=2**53 - 1, description="of all random numbers of the run")
    steps: int = Field(description="total environment steps", ge=1, le=1_000_000_000)
    environment: SerializeAsAny[TaskSettings] = Field(
        default_factory=TaskSettings, description="changes to the task's settings, which are kept in full"
    )
    worlds: tuple[dict[str, Any], ...] = Field(
        (),
        max_length=64,
        description="changes to the environment, such as other simulators; arenas and validation "
        "starts are divided evenly among these worlds; none for the environment alone",
    )
    stages: tuple[StageSettings, ...] = Field(
        (),
        max_length=16,
        description="curriculum, for learner ppo; a stage begins when the simulator is next rebuilt",
    )
    init: str | None = Field(
        None,
        description="folder of a finished run whose policy is the start of training, for learner ppo; its "
        "observation may have fewer robots",
    )
    pool: PoolSettings = PoolSettings()
    imitation: ImitationSettings = ImitationSettings()
    learner: Literal["ddpg", "ppo"] = Field(
        "ddpg", description="ddpg uses agent, replay and collection; ppo uses ppo and collection.num_envs"
    )
    agent: AgentSettings = AgentSettings()
    ppo: PPOSettings = PPOSettings()
    replay: ReplaySettings = ReplaySettings()
    collection: ExperienceSettings = ExperienceSettings()
    evaluation: EvaluationSettings = EvaluationSettings()
    rebuild_every: int = Field(
        20_000,
        ge=1,
        description="steps after which the simulator is rebuilt and a checkpoint may be written; "
        "choose fewer than a slow machine makes in a minute",
    )
    checkpoint_seconds: float = Field(20.0, ge=0, le=60, description="least time between checkpoints [s]")
    tensorboard: bool = Field(True, description="write TensorBoard events beside the log")

    @property
    def central(self) -> bool:
        """Whether a central critic learns."""
        return self.learner == "ppo" and self.ppo.critic == "central"

    @property
    def changes_on_the_way(self) -> bool:
        """Whether the arenas change as the run goes on."""
        return bool(self.stages) or any(self.pool.shares)

    @property
    def algorithm(self) -> str:
        """The algorithm, named by the papers whose switches are on; "ddpg" only without any of them.

        ``d4pg`` has a distributional critic, ``td3`` twin critics, a delayed actor or smoothed targets,
        ``ddpgfd`` keeps demonstrations; ``3-step ddpg`` is DDPG with 3-step returns.
        """
        if self.learner == "ppo":
            return "mappo" if self.central else "ppo"
        agent, named = self.agent, []
        if agent.num_atoms:
            named.append("d4pg")
        if agent.twin_critics or agent.policy_delay > 1 or agent.target_policy_noise:
            named.append("td3")
        if self.replay.demonstrations.keep:
            named.append("ddpgfd")
        steps = f"{agent.n_step}-step " if agent.n_step > 1 and not agent.num_atoms else ""
        return steps + ("+".join(named) or "ddpg")

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name, every in (
            ("evaluation.every", self.evaluation.every),
            ("rebuild_every", self.rebuild_every),
        ):
            if every % self.collection.num_envs:
                raise ValueError(
                    f"{name} must be a multiple of collection.num_envs ({self.collection.num_envs})"
                )
        if len(self.worlds) > min(self.collection.num_envs, self.evaluation.starts):
            raise ValueError("worlds: more than there are arenas or validation starts to share")
        own = self.stages or self.init is not None or self.pool != PoolSettings() or self.imitation.teachers
        if self.learner != "ppo" and own:
            raise ValueError("stages, init, pool and imitation are for learner ppo")
        return self


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
    _model(task, "")
    data, source = read_preset(task, preset)
    if data.get("task", task) != task:
        raise SettingsError(source, f"is {data['task']}, where {task} is trained", "task")
    data = {**data, "task": task, "preset": preset}
    if "task" in (changes or {}):
        raise SettingsError(source, f"is what is trained, {task}: name another one instead", "task")
    for name, value in (changes or {}).items():
        assign(data, name.split("."), value, name)
    if changes:
        source = f"{source}, with {', '.join(changes)} changed"
    settings = settings_of(data, source)
    environment = settings.environment
    try:
        arenas = make_task(environment, 1)
        _ = arenas.space, arenas.scale, task_file(environment)
    except Exception as error:
        raise SettingsError(settings.task, f"{type(error).__name__}: {error}") from error
    if settings.central and not arenas.central:
        problem = "a central critic is for tasks of several robots, such as soccer"
        raise SettingsError(source, problem, "ppo.critic")
    if settings.ppo.frame == "ball" and not arenas.observation.vectors:
        raise SettingsError(source, "the ball's frame is for go_to_ball_among_robots", "ppo.frame")
    if settings.ppo.network == "entities" and not arenas.observation.groups:
        raise SettingsError(source, "entities is for tasks of several robots, such as soccer", "ppo.network")
    for index, stage in enumerate(stages_of(settings, source)):
        place = f"environment with stages[{index}]" if settings.stages else "environment"
        worlds = worlds_of(stage, source)
        if sum(map(learners_of, worlds)) > settings.collection.num_envs:
            raise SettingsError(source, "more than there are arenas to share", "worlds")
        _check_count(settings, worlds, source)
        for world in worlds:
            _check_rows(settings, environment, world, source, place)
        _check_pool(stage, environment, source)
    for found in (*validated_on(settings, source), evaluated_on(settings, source)):
        _check_rows(settings, environment, found, source, "evaluation")
    return settings


def settings_of(data: Mapping[str, Any], source: str) -> TrainSettings:
    """Validate plain data.

    Raises:
        SettingsError: the message begins with ``source`` and names the field.
    """
    plain = dict(data)
    if isinstance(plain.get("task"), str):
        model = _model(plain["task"], source)
        plain["environment"] = _validated(model, plain.get("environment", {}), source, "environment")
    return _validated(TrainSettings, plain, source, "")


def _model(task: str, source: str) -> type[TaskSettings]:
    try:
        return find_task(task).Settings
    except KeyError as error:
        raise SettingsError(source, str(error.args[0]), "task") from error


def _with(settings: TrainSettings, source: str, place: str, *changes: Mapping[str, Any]) -> TaskSettings:
    """Return the run's environment with changes, which ``place`` names in an error."""
    data = settings.environment.model_dump(mode="json")
    for each in changes:
        data = merged(data, each)
    return _validated(type(settings.environment), data, source, f"environment with {place}")


def evaluated_on(settings: TrainSettings, source: str = "settings") -> TaskSettings:
    """Return the settings of the environment in which the held-out starts are played."""
    changes = settings.evaluation.environment, settings.evaluation.held_out_environment
    return _with(settings, source, "evaluation.held_out_environment", *changes)


def validated_on(settings: TrainSettings, source: str = "settings") -> tuple[TaskSettings, ...]:
    """Return the settings of each world in which validation starts are played."""
    return worlds_of(settings, source, settings.evaluation.environment)


def stages_of(settings: TrainSettings, source: str = "settings") -> tuple[TrainSettings, ...]:
    """Return the settings of each stage, the run's own without stages."""
    return tuple(
        settings.model_copy(
            update={
                "environment": _with(settings, source, f"stages[{index}]", stage.environment),
                "pool": _validated(
                    PoolSettings,
                    merged(settings.pool.model_dump(), stage.pool),
                    source,
                    f"pool with stages[{index}]",
                ),
            }
        )
        for index, stage in enumerate(settings.stages)
    ) or (settings,)


def stage_after(settings: TrainSettings, steps: int) -> int:
    """Return the index in :func:`stages_of` of the stage that is trained after ``steps``."""
    shares = [stage.share for stage in settings.stages]
    begun = [settings.steps * sum(shares[:index]) / sum(shares) for index in range(len(shares))]
    return max(sum(steps >= begin for begin in begun) - 1, 0)


def _check_count(settings: TrainSettings, worlds: Sequence[TaskSettings], source: str) -> None:
    """Raise unless the learners fill whole arenas of the worlds."""
    try:
        learners_in(worlds, settings.collection.num_envs)
    except ValueError as error:
        raise SettingsError(source, str(error), "collection.num_envs") from error


def _check_rows(
    settings: TrainSettings, environment: TaskSettings, other: TaskSettings, source: str, place: str
) -> None:
    """Raise unless a policy of the environment can learn and play in the other one."""
    sizes = [
        make_rows(each, learners_of(each), settings.central).observation_size for each in (environment, other)
    ]
    if sizes[0] != sizes[1]:
        problem = (
            f"a robot sees {sizes[1]} entries there and {sizes[0]} in the run's environment; "
            "mates and opponents say for how many robots there are places"
        )
        raise SettingsError(source, problem, place)


def _check_pool(stage: TrainSettings, environment: TaskSettings, source: str) -> None:
    """Raise unless the stage's pool, if it has one, can play in the run's ``environment``."""
    if not any(stage.pool.shares):
        return
    if not environment.two_alike:
        raise SettingsError(source, "is for tasks whose two teams are of equal size and learn", "pool")
    if stage.worlds:
        raise SettingsError(source, "there is none with several worlds", "pool")
    if stage.pool.every % stage.rebuild_every:
        problem = f"must be a multiple of rebuild_every ({stage.rebuild_every})"
        raise SettingsError(source, problem, "pool.every")
    own, n = stage.environment, stage.collection.num_envs
    if isinstance(own, SoccerSettings) and own.two_alike:
        counts = opposed(own, stage.pool, n)
        if any(share and not count for share, count in zip(stage.pool.shares, counts, strict=True)):
            raise SettingsError(source, f"{n} learners are too few for an arena of each share", "pool")


def worlds_of(
    settings: TrainSettings, source: str = "settings", changes: Mapping[str, Any] | None = None
) -> tuple[TaskSettings, ...]:
    """Return the settings of each world that the run trains in, with ``changes`` to each.

    Without other worlds that is the environment.
    """
    return tuple(
        _with(settings, source, f"worlds[{index}]", world, changes or {})
        for index, world in enumerate(settings.worlds or ({},))
    )


def _validated(model: type[_M], data: dict[str, Any], source: str, group: str) -> _M:
    try:
        return model.model_validate(data)
    except ValidationError as error:
        field, problem = first_problem(error, model, data)
        place = ".".join([part for part in (group, field) if part])
        raise SettingsError(source, problem, place) from error
