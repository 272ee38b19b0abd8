"""Outputs of a network as a posterior over class, size and position of a fault.

The loss is the mean negative logarithm of the posterior density of what is true: no network has a lower expected loss
than Bayes' rule. Sizes have a truncated normal distribution, positions one of von Mises.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
import torch
from jaxtyping import Float
from scipy.special import i0e, i1e
from scipy.stats import truncnorm
from torch import Tensor

from swgsim.dataset.faults import WITHOUT_POSITION
from swgsim.oracle.diagnosis import ENDS, FOUND

# Numbers that describe a size and a position: mean and logarithm of the deviation; direction and logarithm of the
# concentration.
SIZE, POSITION = 2, 3
# Limits of the logarithms: deviations from a thousandth of the range to beyond it; any angle to a tenth of a degree.
LOG_DEVIATION, LOG_CONCENTRATION = (-7.0, 2.0), (-5.0, 13.0)


@dataclass(frozen=True)
class FaultOutputs:
    """Outputs of each row: logits of the classes, then sizes, then positions of every fault.

    Attributes
    ----------
    severities : mapping
        Least and largest severity of each fault, both above 0.
    """

    severities: Mapping[str, tuple[float, float]]

    @property
    def classes(self) -> tuple[str, ...]:
        """Names of the classes."""
        return ("healthy", *self.severities)

    def __len__(self) -> int:
        return len(self.classes) + len(self.severities) * (SIZE + POSITION)

    def targets(self, facts: pd.DataFrame) -> Float[np.ndarray, "row 3"]:
        """Number of the class, logarithm of the severity from -1 to 1 between its extremes, and position [rad].

        Parameters
        ----------
        facts : DataFrame
            With ``label``, ``severity`` and ``position``; what a class has not is NaN.
        """
        label = facts["label"].astype(str).map({name: number for number, name in enumerate(self.classes)})
        middle, half = self._ranges
        fault = np.maximum(label.to_numpy() - 1, 0)
        size = (np.log(facts["severity"].to_numpy()) - middle[fault]) / half[fault]
        return np.column_stack([label, size, facts["position"]]).astype(float)

    def loss(self, outputs: Float[Tensor, "row output"], targets: Float[Tensor, "row 3"]) -> Float[Tensor, ""]:
        """Mean negative logarithm of the posterior density, but for constants."""
        label = targets[:, 0].long()
        logits, sizes, positions = self._parts(outputs)
        loss = torch.nn.functional.cross_entropy(logits, label, reduction="sum")
        sized, placed = (targets[:, number].isfinite().nonzero()[:, 0] for number in (1, 2))
        loss = loss + _size_loss(sizes[sized, label[sized] - 1], targets[sized, 1])
        loss = loss + _position_loss(positions[placed, label[placed] - 1], targets[placed, 2])
        return loss / len(targets)

    def probabilities(self, outputs: Float[Tensor, "row output"]) -> Float[np.ndarray, "row class"]:
        """Probability of each class."""
        return np.asarray(self._parts(outputs)[0].double().softmax(dim=1).numpy())

    def diagnosis(self, outputs: Float[Tensor, "row output"]) -> pd.DataFrame:
        """Probabilities, and severity and position of the likeliest class (:mod:`swgsim.oracle.diagnosis`)."""
        probabilities = self.probabilities(outputs)
        table = pd.DataFrame(probabilities, columns=list(self.classes))
        table[list(FOUND)] = np.nan
        rows = np.flatnonzero(probabilities.argmax(axis=1))
        fault = probabilities[rows].argmax(axis=1) - 1
        _, sizes, positions = (part.double().numpy() for part in self._parts(outputs))
        mean, deviation = np.tanh(sizes[rows, fault, 0]), np.exp(sizes[rows, fault, 1].clip(*LOG_DEVIATION))
        middle, half = self._ranges
        for name, probability in zip(FOUND, (0.5, *ENDS), strict=False):
            size = truncnorm.ppf(probability, (-1 - mean) / deviation, (1 - mean) / deviation, mean, deviation)
            table.loc[rows, name] = np.exp(middle[fault] + half[fault] * size)
        cosine, sine, concentration = positions[rows, fault].T
        concentration = np.exp(concentration.clip(*LOG_CONCENTRATION))
        # Mean resultant length of a von Mises distribution.
        spread = np.sqrt(-2 * np.log(i1e(concentration) / i0e(concentration)))
        placed = ~np.isin(np.array(self.classes[1:])[fault], WITHOUT_POSITION)
        where = np.column_stack([np.arctan2(sine, cosine) % (2 * np.pi), spread])
        table.loc[rows, list(FOUND[3:])] = np.where(placed[:, None], where, np.nan)
        return table

    @property
    def _ranges(self) -> tuple[Float[np.ndarray, " fault"], Float[np.ndarray, " fault"]]:
        """Middle and half of the range of the logarithm of the severity."""
        ends = np.log([[min(each), max(each)] for each in self.severities.values()])
        return ends.mean(axis=1), np.maximum(np.diff(ends)[:, 0] / 2, np.finfo(float).eps)

    def _parts(
        self, outputs: Float[Tensor, "row output"]
    ) -> tuple[Float[Tensor, "row class"], Float[Tensor, "row fault 2"], Float[Tensor, "row fault 3"]]:
        """Logits, sizes and positions."""
        faults = len(self.severities)
        logits, sizes, positions = outputs.split([1 + faults, SIZE * faults, POSITION * faults], dim=1)
        return logits, sizes.unflatten(1, (faults, SIZE)), positions.unflatten(1, (faults, POSITION))


def _size_loss(found: Float[Tensor, "row 2"], size: Float[Tensor, " row"]) -> Float[Tensor, ""]:
    """Of a normal distribution that is truncated to the range from -1 to 1."""
    mean, log_deviation = found[:, 0].tanh(), found[:, 1].clamp(*LOG_DEVIATION)
    deviation = log_deviation.exp()
    inside = torch.special.ndtr((1 - mean) / deviation) - torch.special.ndtr((-1 - mean) / deviation)
    return (0.5 * ((size - mean) / deviation) ** 2 + log_deviation + inside.log()).sum()


def _position_loss(found: Float[Tensor, "row 3"], position: Float[Tensor, " row"]) -> Float[Tensor, ""]:
    """Of a von Mises distribution."""
    direction = torch.nn.functional.normalize(found[:, :2], dim=1)
    cosine = direction[:, 0] * position.cos() + direction[:, 1] * position.sin()
    concentration = found[:, 2].clamp(*LOG_CONCENTRATION).exp()
    return (concentration * (1 - cosine) + torch.special.i0e(concentration).log()).sum()
