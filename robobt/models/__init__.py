"""Policies and predictors at run time: card, file format, checks, loading, export."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "GO_TO_BALL_ACTION": "actions",
    "Measured": "card",
    "ModelCard": "card",
    "ModelError": "file",
    "ObservationCard": "card",
    "action_outputs": "card",
    "export_model": "export",
    "load_policy": "policy",
}

if TYPE_CHECKING:
    from robobt.models.actions import GO_TO_BALL_ACTION as GO_TO_BALL_ACTION
    from robobt.models.card import Measured as Measured
    from robobt.models.card import ModelCard as ModelCard
    from robobt.models.card import ObservationCard as ObservationCard
    from robobt.models.card import action_outputs as action_outputs
    from robobt.models.export import export_model as export_model
    from robobt.models.file import ModelError as ModelError
    from robobt.models.policy import load_policy as load_policy
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
