"""Files a person writes or reads: YAML with positions, errors that name file and field, atomic writes."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "new_figure": "figures",
    "save_figure": "figures",
}

if TYPE_CHECKING:
    from robobt.config.figures import new_figure as new_figure
    from robobt.config.figures import save_figure as save_figure
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
