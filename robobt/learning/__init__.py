"""Learning: tasks, the arenas they are trained in, agents, training, export.

Importing it makes the tasks known to Gymnasium: ``GoToBall-v0``, ``Duel-v0`` and so on, also as
``robobt/GoToBall-v0``, for ``gymnasium.make`` and, with ``vectorization_mode="vector_entry_point"``, for
``gymnasium.make_vec``. :data:`TASKS` has them by name and takes tasks of one's own.
"""

from robobt.config.extras import need

need("learn", "gymnasium", "scipy", "pyarrow", "matplotlib")

from robobt.learning.tasks import TASKS as TASKS  # noqa: E402
