"""Files shipped with robobt: scenarios and models.

In a checkout they are beside the package (``examples/scenarios``, ``models``); a wheel carries them inside it
(``robobt/_data``).
"""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
_DATA = _PACKAGE / "_data"


def scenarios_folder() -> Path:
    """Return the folder of the bundled scenario files."""
    return _folder("scenarios", _PACKAGE.parent / "examples" / "scenarios")


def models_folder() -> Path:
    """Return the folder of the shipped models, each with its model card."""
    return _folder("models", _PACKAGE.parent / "models")


def bundled_scenarios() -> dict[str, Path]:
    """Return the bundled scenario files by name, in the order of their names."""
    return {path.stem: path for path in sorted(scenarios_folder().glob("*.yaml"))}


def _folder(name: str, in_checkout: Path) -> Path:
    in_wheel = _DATA / name
    return in_wheel if in_wheel.is_dir() else in_checkout
