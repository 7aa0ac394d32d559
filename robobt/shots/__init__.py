"""Shot data: the table, who fills it, and the predictors that learn from it.

``best_predictor()`` is the unfitted estimator that predicts best; fit it on
``shot_inputs(table)`` and ``goals(table)`` of a table that ``read_shots`` returns.
These names are loaded when they are asked for: collecting shots needs no torch.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robobt.shots.data.files import read_shots, write_shots
    from robobt.shots.data.inputs import goals, shot_inputs
    from robobt.shots.predict.predictors import PREDICTORS, best_predictor, calibrated, make_predictor

__all__ = [
    "PREDICTORS",
    "best_predictor",
    "calibrated",
    "goals",
    "make_predictor",
    "read_shots",
    "shot_inputs",
    "write_shots",
]

_HOMES = {
    **dict.fromkeys(("read_shots", "write_shots"), "data.files"),
    **dict.fromkeys(("goals", "shot_inputs"), "data.inputs"),
    **dict.fromkeys(("PREDICTORS", "best_predictor", "calibrated", "make_predictor"), "predict.predictors"),
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
