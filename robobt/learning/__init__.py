"""Learning: environments, learners, shot data, predictors, export. Torch lives here.

Importing it makes the environments known to Gymnasium: ``GoToBall-v0``,
``GoToBallAmongRobots-v0``, ``ShootTowardsGoal-v0`` and ``ScoreOnGoalkeeper-v0``, also as
``robobt/GoToBall-v0`` and so on, and the tasks of several robots, for ``gymnasium.make`` and, with
``vectorization_mode="vector_entry_point"``, for ``gymnasium.make_vec``.
"""

from robobt.config.extras import need

need("learn", "gymnasium", "scipy", "pyarrow", "matplotlib")

import gymnasium  # noqa: E402

_ROOMS = {
    "GoToBall": "go_to_ball.env",
    "GoToBallAmongRobots": "go_to_ball.among_robots",
    "ShootTowardsGoal": "shoot.env",
    "ScoreOnGoalkeeper": "score_on_goalkeeper.env",
}
TEAMS = (
    "Soccer",
    "ScoreOnGoalkeeperAndDefenders",
    "ScoreOnGoalkeeperAndTwoDefenders",
    "Save",
    "Duel",
    "DuelWithScript",
    "Keepaway",
    "Pass",
    "Receive",
    "Redirect",
    "Attack3v2",
    "Small3v3",
)
"""Tasks of several robots; what each is says :mod:`robobt.learning.envs.soccer.suite`."""

for _name, _room in _ROOMS.items():
    _class = f"robobt.learning.envs.{_room}:{_name}"
    for _id in (f"{_name}-v0", f"robobt/{_name}-v0"):
        # The environments end their episodes themselves, and a second import must not warn.
        if _id not in gymnasium.registry:
            gymnasium.register(id=_id, entry_point=f"{_class}Env", vector_entry_point=f"{_class}VectorEnv")
for _name in TEAMS:
    _class = "robobt.learning.envs.soccer.env:Soccer"
    for _id in (f"{_name}-v0", f"robobt/{_name}-v0"):
        if _id not in gymnasium.registry:
            gymnasium.register(
                id=_id,
                entry_point=f"{_class}Env",
                vector_entry_point=f"{_class}VectorEnv",
                kwargs={"task": _name},
            )
