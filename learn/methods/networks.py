"""Networks on flat rows: first the signal, channel by channel over one revolution, then auxiliary columns.

The state dict holds everything that depends on the source gears, including the scaling.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import cast

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from learn.methods.convolutions import FEATURES, STRIDE, Convolutions
from learn.methods.recording_sets import RecordingSets
from swgsim.common.checks import require, require_integer, require_known
from swgsim.common.seeds import seed_hash

# Factors from interquartile range and median absolute deviation to the standard deviation of a Gaussian.
QUARTILES, DEVIATION = 1 / 1.349, 1.4826
# A column that varies by less than this share of its typical value contains rounding errors only.
LEAST_SPREAD = 1e-6


class Network(nn.Module):
    """A body that computes features, and a linear head that classifies them.

    Parameters
    ----------
    body : Module
        Maps scaled rows (row, column) to features (row, width).
    width, classes, columns : int
        Numbers of features, of classes and of columns of the input.
    channels, points : int
        Size of the signal in the first channels*points columns. All points of a channel share a scale. 0 channels: no
        signal.
    """

    def __init__(
        self, body: nn.Module, width: int, classes: int, columns: int, channels: int = 0, points: int = 0
    ) -> None:
        super().__init__()
        self.body, self.head = body, nn.Linear(width, classes)
        self.channels, self.points = channels, points
        self.centre: Tensor
        self.scale: Tensor
        self.register_buffer("centre", torch.zeros(columns))
        self.register_buffer("scale", torch.ones(columns))

    def forward(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row class"]:
        """Logits of the classes."""
        return cast(Tensor, self.head(self.embed(X)))

    def embed(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row width"]:
        """Input features of the head."""
        return cast(Tensor, self.body(self.scaled(X)))

    def scaled(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row column"]:
        """Input of the body.

        A large fault can exceed the noise a hundredfold and would hide the small ones. Rows therefore pass through
        asinh, which is linear up to about one standard deviation and logarithmic beyond.
        """
        return torch.asinh((X - self.centre) / self.scale)

    def set_scaling(self, X: Float[np.ndarray, "row column"]) -> None:
        """Estimate centre and scale from the rows of the source gears, robustly, as most rows are faults.

        The centre is the median of each column. The scale of an auxiliary column is its interquartile range, that of a
        channel the median absolute deviation over all points, as a scale for each point would distort the waveform.
        Both are converted to the standard deviation of a Gaussian. Constant columns have a scale of 1.
        """
        if X.shape[1] != len(self.centre):
            raise ValueError(f"rows have {X.shape[1]} columns, the network was made for {len(self.centre)}")
        centre = np.median(X, axis=0)
        signal, auxiliary = np.split(X - centre, [self.channels * self.points], axis=1)
        low, high = np.percentile(auxiliary, (25, 75), axis=0)
        scale = _positive(QUARTILES * (high - low), auxiliary, X[:, signal.shape[1] :])
        if self.channels:
            deviation, values = self._by_channel(signal), self._by_channel(X[:, : signal.shape[1]])
            channel = _positive(DEVIATION * np.median(np.abs(deviation), axis=0), deviation, values)
            scale = np.concatenate([np.repeat(channel, self.points), scale])
        self.centre.copy_(torch.from_numpy(centre))
        self.scale.copy_(torch.from_numpy(scale))

    def _by_channel(self, signal: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row_point channel"]:
        return signal.reshape(-1, self.channels, self.points).swapaxes(1, 2).reshape(-1, self.channels)


def _positive(
    robust: Float[np.ndarray, " group"],
    deviation: Float[np.ndarray, "row group"],
    values: Float[np.ndarray, "row group"],
) -> Float[np.ndarray, " group"]:
    """The robust scale; the standard deviation if most rows are equal; 1 if all rows are equal, up to rounding."""
    least = LEAST_SPREAD * np.median(np.abs(values), axis=0)
    scale = np.where(robust > least, robust, deviation.std(axis=0))
    return np.where(scale > least, scale, 1.0)


def perceptron(
    columns: int, classes: int, layers: int = 2, neurons: int = 256, dropout: float = 0.3,
    *, channels: int = 0, points: int = 0, periodic: bool = True, seed: int = 0,
) -> Network:  # fmt: skip
    """Fully connected layers of ReLU units.

    Parameters
    ----------
    columns, classes : int
        Numbers of columns of the input, signal included, and of classes.
    layers, neurons : int
        Numbers of hidden layers, and of units in each.
    dropout : float
        Share of the units that each training step leaves out.
    channels, points, periodic : int, int, bool
        Layout of the signal. It affects the scaling only: all points of a periodic signal share a scale.
    seed : int
        Seed of the initial weights.
    """
    owner = "the perceptron"
    _require_common(owner, columns, classes, channels, points, dropout)
    require_integer(owner, "layers", layers, low=1, high=10)
    require_integer(owner, "neurons", neurons, low=1, high=10_000)
    with seeded(seed_hash("initial weights", seed)):
        widths = [columns, *[neurons] * layers]
        hidden = [
            layer
            for before, after in pairwise(widths)
            for layer in (nn.Linear(before, after), nn.ReLU(), nn.Dropout(dropout))
        ]
        return Network(nn.Sequential(*hidden), neurons, classes, columns, channels * periodic, points * periodic)


def convolutional(
    channels: int, points: int, columns: int, classes: int, width: int = 32, dropout: float = 0.2,
    *, residual: bool = False, periodic: bool = True, seed: int = 0,
) -> Network:  # fmt: skip
    """Three blocks of convolutions over the angle, pooled; see :class:`Convolutions`.

    Parameters
    ----------
    channels, points : int
        Size of the signal; a periodic one has a multiple of 8 points.
    columns, classes : int
        Numbers of columns of the input, signal included, and of classes.
    width, dropout, residual : int, float, bool
        As in :class:`Convolutions`.
    periodic : bool
        Whether the points are angles of a revolution. Otherwise they are features, each with a separate scale.
    seed : int
        Seed of the initial weights.
    """
    owner = "the convolutional network"
    _require_common(owner, columns, classes, channels, points, dropout)
    if channels < 1 or (periodic and points % STRIDE):
        raise ValueError(
            f"{owner} has {channels} channels of {points} points, needs a signal with a multiple of {STRIDE} points, "
            "as three blocks halve their number; without a signal take the perceptron"
        )
    require_integer(owner, "width", width, low=1, high=1024)
    with seeded(seed_hash("initial weights", seed)):
        body = Convolutions(channels, points, columns - channels * points, width, dropout, periodic, residual)
        return Network(body, FEATURES, classes, columns, channels * periodic, points * periodic)


def set_network(
    channels: int, points: int, columns: int, classes: int, neurons: int = 128, dropout: float = 0.3, *, seed: int = 0
) -> Network:
    """The same layers for every recording of a unit, pooled; see :class:`RecordingSets`.

    Parameters
    ----------
    channels, points : int
        Numbers of features and of recordings of a unit.
    columns, classes : int
        Numbers of columns of the input and of classes.
    neurons, dropout : int, float
        As in :class:`RecordingSets`.
    seed : int
        Seed of the initial weights.
    """
    owner = "the set network"
    _require_common(owner, columns, classes, channels, points, dropout)
    require_integer(owner, "neurons", neurons, low=1, high=10_000)
    if channels * points != columns:
        raise ValueError(f"{owner} has {columns} columns for {channels} features of {points} recordings")
    with seeded(seed_hash("initial weights", seed)):
        return Network(RecordingSets(channels, points, neurons, dropout), neurons, classes, columns)


def _require_common(owner: str, columns: int, classes: int, channels: int, points: int, dropout: float) -> None:
    require_integer(owner, "columns", columns, low=1, high=1_000_000)
    require_integer(owner, "classes", classes, low=2, high=1000)
    require_integer(owner, "channels", channels, low=0, high=1000)
    require_integer(owner, "points", points, low=1 if channels else 0, high=100_000)
    require(owner, "dropout", dropout, low=0, high=0.95)
    if channels * points > columns:
        raise ValueError(
            f"{owner} has {columns} columns, fewer than the {channels * points} of {channels} channels with {points} "
            "points: give the channels and points that the rows were made with"
        )


ARCHITECTURES: Mapping[str, Callable[..., Network]] = {
    "perceptron": perceptron,
    "convolutional": convolutional,
    "residual": partial(convolutional, residual=True),
    "set": set_network,
}


@dataclass(frozen=True)
class Architecture:
    """A kind of network with its options, as stored in files.

    Attributes
    ----------
    kind : str
        One of ``ARCHITECTURES``.
    options : mapping
        All arguments but ``columns``, ``classes`` and ``seed``.
    """

    kind: str
    options: Mapping[str, int | float]

    def __post_init__(self) -> None:
        require_known("the architectures", [self.kind], ARCHITECTURES)

    def network(self, columns: int, classes: int, seed: int) -> Network:
        """An untrained network."""
        return ARCHITECTURES[self.kind](columns=columns, classes=classes, seed=seed, **self.options)


@contextmanager
def seeded(seed: int, device: torch.device | None = None) -> Iterator[None]:
    """Seed PyTorch's global generators of the processor and of ``device``, and restore them afterwards."""
    accelerators = [device] if device is not None and device.type == "cuda" else []
    with torch.random.fork_rng(devices=accelerators):
        torch.default_generator.manual_seed(seed)
        for each in accelerators:
            with torch.cuda.device(each):
                torch.cuda.manual_seed(seed)
        yield
