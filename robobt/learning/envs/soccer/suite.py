"""The graded suite of tasks with several robots: each has its robots, aim, starts and ends.

Everything else is the default of :class:`~robobt.learning.envs.soccer.settings.SoccerSettings`.
"""

from __future__ import annotations

from robobt.learning.envs.score_on_goalkeeper.settings import KeeperSettings
from robobt.learning.envs.soccer.rewards import SoccerReward
from robobt.learning.envs.soccer.settings import (
    GOALKEEPER,
    LEARNER,
    PLAY_ROLE,
    Aim,
    Role,
    SoccerRules,
    SoccerSettings,
    SoccerStarts,
)
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.opponents.play_settings import PlaySettings

_ATTACKED = SoccerStarts(
    blue_x=(0.0, 3.0), yellow_x=(2.0, 3.2), y=(-2.2, 2.2), ball_x=(0.0, 3.0), held=0.5, apart=0.35
)
_OPEN_PLAY_STARTS = SoccerStarts(ball_speed=(0.0, 1.0))


class ScoreOnGoalkeeperAndDefendersSettings(SoccerSettings):
    """Get the ball and score past a wall of one robot and a goalkeeper.

    All robots start in the attacked half; in half of the episodes the attacker has the ball. Success is a
    goal. A ball that is out, with the goalkeeper or held by yellow for 8 periods, or an attacker in the
    defence area, ends the episode.
    """

    blue: tuple[Role, ...] = (LEARNER,)
    yellow: tuple[Role, ...] = (GOALKEEPER, "wall")
    starts: SoccerStarts = _ATTACKED


class ScoreOnGoalkeeperAndTwoDefendersSettings(ScoreOnGoalkeeperAndDefendersSettings):
    """Get the ball and score past a wall of one, a goalkeeper and a defender that presses at up to 2 m/s."""

    yellow: tuple[Role, ...] = (GOALKEEPER, "wall", "press")


class SaveSettings(SoccerSettings):
    """Keep goal against one attacker that gets the ball and shoots.

    The attacker starts with the ball, 1 to 4 m in front of the goal. Success is every end except a goal: the
    ball out, held by the goalkeeper for 8 periods, or 6.7 s over.
    """

    blue: tuple[Role, ...] = (LEARNER,)
    yellow: tuple[Role, ...] = ("attack",)
    aim: Aim = "save"
    time_limit: int = 222
    rules: SoccerRules = SoccerRules(areas=False)
    reward: SoccerReward = SoccerReward(advance=0.1, approach=0.1, shot=0.0)
    starts: SoccerStarts = SoccerStarts(
        blue_x=(-4.4, -4.0), yellow_x=(-3.3, -0.5), y=(-1.5, 1.5), held=1.0, holder="yellow"
    )


class DuelSettings(SoccerSettings):
    """One against one, both learning: the ball starts between them, and a goal decides."""

    blue: tuple[Role, ...] = (LEARNER,)
    yellow: tuple[Role, ...] = (LEARNER,)
    rules: SoccerRules = SoccerRules(held_by=None)
    starts: SoccerStarts = _OPEN_PLAY_STARTS


class DuelWithScriptSettings(DuelSettings):
    """One against a script that fetches the ball, carries it and shoots, at up to 2 m/s."""

    yellow: tuple[Role, ...] = ("attack",)


class KeepawaySettings(SoccerSettings):
    """Three robots keep the ball for 6 s from one that presses at up to 1 m/s.

    The ball starts with the first of the three. The episode ends when the presser has held the ball for 8
    periods, when the ball is over a line, or when a robot has carried it farther than 1 m. Success is still
    having the ball when time is up.
    """

    blue: tuple[Role, ...] = (LEARNER, LEARNER, LEARNER)
    yellow: tuple[Role, ...] = ("press",)
    aim: Aim = "keep"
    time_limit: int = 200
    player_speed: float = 1.0
    rules: SoccerRules = SoccerRules(dribbling=1.0)
    reward: SoccerReward = SoccerReward(goal=0.0, advance=0.0, shot=0.0, passed=0.5, approach=0.1)
    starts: SoccerStarts = SoccerStarts(
        blue_x=(-2.0, 2.0), yellow_x=(-2.0, 2.0), y=(-2.0, 2.0), held=1.0, apart=0.8
    )


class PassSettings(SoccerSettings):
    """Pass to a team-mate past an opponent that presses at up to 1 m/s.

    Success is the ball in the team-mate's mouth, 0.8 m or more from where it was passed.
    """

    blue: tuple[Role, ...] = (LEARNER, LEARNER)
    yellow: tuple[Role, ...] = ("press",)
    aim: Aim = "pass"
    time_limit: int = 200
    player_speed: float = 1.0
    rules: SoccerRules = SoccerRules(dribbling=1.0)
    reward: SoccerReward = SoccerReward(goal=0.0, advance=0.0, shot=0.0, passed=5.0, approach=0.1)
    starts: SoccerStarts = SoccerStarts(
        blue_x=(-2.0, 2.0), yellow_x=(-2.0, 2.0), y=(-2.0, 2.0), held=1.0, apart=0.8
    )


class ReceiveSettings(SoccerSettings):
    """Take a ball that comes at 1.5 to 4 m/s past an opponent that presses, and hold it for 8 periods."""

    blue: tuple[Role, ...] = (LEARNER,)
    yellow: tuple[Role, ...] = ("press",)
    aim: Aim = "hold"
    time_limit: int = 134
    player_speed: float = 1.0
    reward: SoccerReward = SoccerReward(goal=0.0, advance=0.0, shot=0.0, approach=0.2, holding=0.1)
    starts: SoccerStarts = SoccerStarts(
        blue_x=(0.0, 2.5), yellow_x=(-2.5, 2.5), y=(-2.0, 2.0), ball_x=(-3.0, -1.5), ball_speed=(1.5, 4.0),
        coming=1.0, apart=0.8,
    )  # fmt: skip


class RedirectSettings(SoccerSettings):
    """Score on a goalkeeper with a ball that comes at 1.5 to 4 m/s, held for no more than 6 periods."""

    blue: tuple[Role, ...] = (LEARNER,)
    yellow: tuple[Role, ...] = (GOALKEEPER,)
    time_limit: int = 134
    rules: SoccerRules = SoccerRules(longest_hold=6)
    starts: SoccerStarts = SoccerStarts(
        blue_x=(1.5, 3.0), y=(-2.0, 2.0), ball_x=(-1.0, 1.0), ball_speed=(1.5, 4.0), coming=1.0, apart=0.8
    )


class Attack3v2Settings(SoccerSettings):
    """Three robots attack a goalkeeper, a marker and a blocker, for 10 s."""

    blue: tuple[Role, ...] = (LEARNER, LEARNER, LEARNER)
    yellow: tuple[Role, ...] = (GOALKEEPER, "mark", "wall")
    reward: SoccerReward = SoccerReward(passed=0.2, shared=0.5)
    starts: SoccerStarts = _ATTACKED.model_copy(update={"blue_x": (-1.0, 3.0)})


class Small3v3Settings(SoccerSettings):
    """Two field players, who learn, and a goalkeeper per side; a goal within 15 s decides."""

    blue: tuple[Role, ...] = (GOALKEEPER, LEARNER, LEARNER)
    yellow: tuple[Role, ...] = (GOALKEEPER, LEARNER, LEARNER)
    time_limit: int = 500
    keepers: KeeperSettings = KeeperSettings(speed=(1.5, 3.0))
    rules: SoccerRules = SoccerRules(held_by=None, dribbling=1.0)
    reward: SoccerReward = SoccerReward(passed=0.2, shared=0.5)
    starts: SoccerStarts = _OPEN_PLAY_STARTS


def _task(settings: type[SoccerSettings], played_by: str = "LearnedSkill") -> type[SoccerTask]:
    """Return the task with these settings."""
    name = settings.__name__.removesuffix("Settings")
    about = {"__module__": __name__, "__doc__": settings.__doc__}
    return type(name, (SoccerTask,), {"Settings": settings, "played_by": played_by, **about})


ScoreOnGoalkeeperAndDefenders = _task(ScoreOnGoalkeeperAndDefendersSettings, "Score")
ScoreOnGoalkeeperAndTwoDefenders = _task(ScoreOnGoalkeeperAndTwoDefendersSettings, "Score")
Save = _task(SaveSettings, "Goalkeeper")
Duel = _task(DuelSettings, "Duel")
DuelWithScript = _task(DuelWithScriptSettings, "Duel")
Keepaway = _task(KeepawaySettings)
Pass = _task(PassSettings)
Receive = _task(ReceiveSettings)
Redirect = _task(RedirectSettings)
Attack3v2 = _task(Attack3v2Settings)
Small3v3 = _task(Small3v3Settings)

_SUITE = (
    ScoreOnGoalkeeperAndDefenders,
    ScoreOnGoalkeeperAndTwoDefenders,
    Save,
    Duel,
    DuelWithScript,
    Keepaway,
    Pass,
    Receive,
    Redirect,
    Attack3v2,
    Small3v3,
)
SUITE: dict[str, type[SoccerSettings]] = {task.__name__: task.Settings for task in _SUITE}
"""The settings of the tasks by their names in Gymnasium."""

SCRIPT_ROLES: dict[str, Role] = {
    "score": "attack",
    "save": GOALKEEPER,
    "keep": "pass",
    "pass": "pass",
    "hold": "pass",
}
"""Scripts in the learners' place for a baseline, by aim; ``redirect`` if the ball may not be held long."""


def scripted(settings: SoccerSettings) -> SoccerSettings:
    """Return the ``settings`` with the script in place of blue's learners, and attackers for yellow's."""
    own: Role = "redirect" if settings.rules.longest_hold else SCRIPT_ROLES[settings.aim]
    return against(instead(settings, own), "attack")


Opponent = Role | PlaySettings
"""A role, or the play that moves a robot."""


def against(settings: SoccerSettings, opponent: Opponent) -> SoccerSettings:
    """Return the ``settings`` with scripted or played robots in the place of yellow's learners."""
    return _replaced(settings, len(settings.blue), len(settings.roles), opponent)


def instead(settings: SoccerSettings, player: Opponent) -> SoccerSettings:
    """Return the ``settings`` with scripted or played robots in the place of blue's learners."""
    return _replaced(settings, 0, len(settings.blue), player)


def _replaced(settings: SoccerSettings, begin: int, end: int, player: Opponent) -> SoccerSettings:
    """Return the ``settings`` with other robots in the place of the learners from ``begin`` up to ``end``."""
    given, roles, plays = iter(settings.plays), list(settings.roles), []
    for index, role in enumerate(settings.roles):
        if role == PLAY_ROLE:
            plays.append(next(given))
        elif role == LEARNER and begin <= index < end:
            roles[index] = PLAY_ROLE if isinstance(player, PlaySettings) else player
            if isinstance(player, PlaySettings):
                plays.append(player)
    blue = len(settings.blue)
    changes = {"blue": tuple(roles[:blue]), "yellow": tuple(roles[blue:]), "plays": tuple(plays)}
    return settings.model_copy(update=changes)
