"""Distribution of actions whose entries are normal, or thresholds such as that of a kick.

All entries are independent. Thresholds are Bernoulli: 1 or -1, with the policy's output as log-odds.

In arrays of numpy, because for so few numbers an operation of torch takes several times as long.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float32]

_LOG_ROOT = np.float32(0.5 * np.log(2.0 * np.pi))


class MixedActions:
    """Draws actions and weighs them, given the policy's outputs and the log standard deviations.

    Outputs and actions are (action, m): an output is the mean of a normal entry or the log-odds of a
    threshold. Log standard deviations are (normal entries, 1).

    Args:
        continuous: (action,) which entries are normal; the others are thresholds.

    Attributes:
        normal: places of the normal entries.
        thresholds: places of the thresholds.
    """

    def __init__(self, continuous: Sequence[bool]) -> None:
        self.normal, self.thresholds = _places(continuous), _places([not each for each in continuous])
        self._counts = sum(continuous), len(continuous) - sum(continuous)

    def draw(self, output: Numbers, log_std: Numbers, rng: np.random.Generator) -> Numbers:
        """Draw actions (action, m)."""
        normal, thresholds = self._counts
        noise = rng.standard_normal((output.shape[1], normal), np.float32).T
        uniform = rng.random((output.shape[1], thresholds), np.float32).T
        action = np.empty_like(output)
        action[self.normal] = output[self.normal] + np.exp(log_std) * noise
        action[self.thresholds] = np.where(uniform < _sigmoid(output[self.thresholds]), 1.0, -1.0)
        return action

    def log_probability(self, output: Numbers, action: Numbers, log_std: Numbers) -> Numbers:
        """Return the log-probability (m,) of actions."""
        off = (action[self.normal] - output[self.normal]) * np.exp(-log_std)
        off *= off
        likely = _log_sigmoid(output[self.thresholds] * action[self.thresholds])
        result: Numbers = likely.sum(0) - 0.5 * off.sum(0) - (log_std + _LOG_ROOT).sum()
        return result

    def entropy(self, output: Numbers, log_std: Numbers) -> Numbers:
        """Return the entropy (m,)."""
        odds = output[self.thresholds]
        threshold = odds * _sigmoid(-odds) - _log_sigmoid(odds)
        result: Numbers = (log_std + np.float32(0.5) + _LOG_ROOT).sum() + threshold.sum(0)
        return result

    def slopes(
        self, output: Numbers, action: Numbers, log_std: Numbers, weight: Numbers, bonus: float
    ) -> tuple[Numbers, Numbers]:
        """Return the gradients of sum(weight * log-probability) + bonus * mean(entropy).

        Args:
            output: the policy's.
            action: as drawn.
            log_std: log standard deviations.
            weight: (m,) of the actions.
            bonus: weight of the mean entropy.

        Returns:
            The gradients with respect to ``output`` and to ``log_std``, (normal entries,).
        """
        slope, precision = np.empty_like(output), np.exp(-log_std)
        off = (action[self.normal] - output[self.normal]) * precision
        pull = off * weight
        slope[self.normal] = pull * precision
        odds, kicks = output[self.thresholds], action[self.thresholds]
        steepness = odds * _sigmoid(odds) * _sigmoid(-odds)
        share = np.float32(bonus / output.shape[1])
        slope[self.thresholds] = kicks * _sigmoid(-odds * kicks) * weight - steepness * share
        return slope, np.einsum("im,im->i", pull, off) - weight.sum() + np.float32(bonus)


def _sigmoid(x: Numbers) -> Numbers:
    result: Numbers = np.float32(0.5) + np.float32(0.5) * np.tanh(np.float32(0.5) * x)
    return result


def _log_sigmoid(x: Numbers) -> Numbers:
    result: Numbers = np.minimum(x, np.float32(0.0)) - np.log1p(np.exp(-np.abs(x)))
    return result


def _places(which: Sequence[bool]) -> slice | NDArray[np.int64]:
    """Return where ``which`` is true, as a slice if that is one block, which costs no copy."""
    places = [place for place, true in enumerate(which) if true]
    first, end = (places[0], places[-1] + 1) if places else (0, 0)
    return slice(first, end) if end - first == len(places) else np.array(places)
