"""All checks of a TorchScript network, in the order in which they make it safe to go on."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import torch
from torch import Tensor

from robobt.models.checks.arguments import check_arguments
from robobt.models.checks.bounds import Bounds
from robobt.models.checks.limits import LARGEST_BATCH
from robobt.models.checks.operations import check_frozen, check_loaded


def load_frozen(archive: bytes) -> tuple[Any, list[Tensor]]:
    """Load an archive whose source has been checked, and check what torch made of it.

    Returns:
        The frozen module, and the tensors that are constants in it.
    """
    loaded = torch.jit.load(BytesIO(archive), map_location="cpu")  # type: ignore[no-untyped-call]
    loaded.eval()
    check_loaded(loaded.inlined_graph)
    check_arguments(loaded._c)
    # Freezing runs whatever does not depend on the input.
    with Bounds(LARGEST_BATCH):
        module = torch.jit.freeze(loaded)
    return module, check_frozen(module.inlined_graph)


def run_bounded(module: Any, constants: list[Tensor], size: int) -> None:
    """Run a frozen module within bounds, for each number of observations that it will be given."""
    with torch.inference_mode():
        for count in (LARGEST_BATCH, 1):
            observations = torch.zeros(count, size)
            with Bounds(count, constants):
                module(observations)
