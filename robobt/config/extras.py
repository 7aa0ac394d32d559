"""Parts of robobt that need packages which a light installation leaves out."""

from __future__ import annotations

from importlib.util import find_spec

from robobt.config.errors import RobobtError

EXTRAS = {
    "foxglove_schemas_protobuf": "mcap",
    "gymnasium": "learn",
    "tensorboard": "learn",
    "PIL": "plots",
    "google": "league",
    "matplotlib": "plots",
    "mcap_protobuf": "mcap",
    "onnx": "onnx",
    "onnxruntime": "onnx",
    "optuna": "sweep",
    "pettingzoo": "agents",
    "pyarrow": "record",
    "ray": "ray",
    "scipy": "shots",
    "sklearn": "shots",
    "stable_baselines3": "sb3",
    "websockets": "live",
}
"""The extra that installs a package, by the package's import name."""

_DISTRIBUTIONS = {
    "foxglove_schemas_protobuf": "foxglove-schemas-protobuf",
    "google": "protobuf",
    "mcap_protobuf": "mcap-protobuf-support",
    "PIL": "pillow",
    "sklearn": "scikit-learn",
    "stable_baselines3": "stable-baselines3",
}


class MissingExtraError(RobobtError, ImportError):
    """A feature needs an extra that is not installed; the message says how to install it."""

    def __init__(self, package: str, extra: str) -> None:
        named = _DISTRIBUTIONS.get(package.partition(".")[0], package)
        super().__init__(f'this needs {named}, which is not installed: pip install "robobt[{extra}]"')


def need(extra: str, *packages: str) -> None:
    """Check that an extra's packages are installed, by their import names.

    Raises:
        MissingExtraError: one is not.
    """
    for package in packages:
        if not _is_there(package):
            raise MissingExtraError(package, extra)


def _is_there(package: str) -> bool:
    try:
        return find_spec(package) is not None
    except (ModuleNotFoundError, ValueError):
        return False


def missing_extra(error: BaseException) -> MissingExtraError | None:
    """Return the readable error for a failed import of an extra's package, else None."""
    package = str(getattr(error, "name", "")).partition(".")[0]
    if not isinstance(error, ModuleNotFoundError) or package not in EXTRAS:
        return None
    return MissingExtraError(package, EXTRAS[package])
