"""Networks on flat rows: first the signal, channel by channel over one revolution, then side columns.

Whatever a network needs of the source gears, scaling included, is in its state dict, so that it travels with the
weights.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, cast

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from swgsim.common.checks import require, require_integer, require_known
from swgsim.common.seeds import seed_hash

# Of a Gaussian: interquartile range and median absolute deviation to standard deviation.
QUARTILES, DEVIATION = 1 / 1.349, 1.4826
# A column of which nothing but rounding is seen varies by less than this part of its typical value.
LEAST_SPREAD = 1e-6
# Points that one shift of the convolutional network spans: three blocks halve the revolution.
STRIDE = 8
FEATURES = 64  # at the end of the convolutional body


class Network(nn.Module):
    """A body that finds features and a linear head that tells classes from them.

    Parameters
    ----------
    body : Module
        Maps scaled rows (row, column) to features (row, width).
    width, classes, columns : int
        Number of features, of classes and of columns of the input.
    channels, points : int
        Of the signal in the first channels*points columns, whose points are alike and share a scale; 0 channels if
        there is none.
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
        """Features that the head sees.

        A single fault can be hundred times the noise: on a linear scale it would drown the small ones, so the rows
        pass through asinh, which is linear up to about one standard deviation and logarithmic beyond.
        """
        return cast(Tensor, self.body(torch.asinh((X - self.centre) / self.scale)))

    def set_scaling(self, X: Float[np.ndarray, "row column"]) -> None:
        """Take centre and scale from the rows of the source gears, robustly, because most rows are faults.

        Every column has its own median. A side column is divided by its interquartile range, a channel of the signal
        by the median absolute deviation over all its points, for a scale per point would distort the waveform; both
        are expressed as the standard deviation of a Gaussian. What does not vary is divided by 1.
        """
        if X.shape[1] != len(self.centre):
            raise ValueError(f"rows have {X.shape[1]} columns, the network was made for {len(self.centre)}")
        centre = np.median(X, axis=0)
        signal, side = np.split(X - centre, [self.channels * self.points], axis=1)
        low, high = np.percentile(side, (25, 75), axis=0)
        scale = _positive(QUARTILES * (high - low), side, X[:, signal.shape[1] :])
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
    """The robust scale; the standard deviation where most rows are equal; 1 where all are, but for rounding."""
    least = LEAST_SPREAD * np.median(np.abs(values), axis=0)
    scale = np.where(robust > least, robust, deviation.std(axis=0))
    return np.where(scale > least, scale, 1.0)


class Convolutions(nn.Module):
    """Convolutions over the revolution, pooled over the angle and joined by the side columns.

    A signal that is periodic in the angle is padded with itself. With strides of 2 in three blocks, the output stays
    the same under circular shifts of the scaled signal by whole multiples of 8 points, and under no others. What is
    not periodic is padded with zeros.
    """

    def __init__(self, channels: int, points: int, side: int, width: int, dropout: float, periodic: bool) -> None:
        super().__init__()
        self.channels, self.points = channels, points
        mode: Literal["circular", "zeros"] = "circular" if periodic else "zeros"
        self.blocks = nn.Sequential(
            *_block(channels, width, 9, mode),
            *_block(width, 2 * width, 5, mode),
            *_block(2 * width, 2 * width, 5, mode),
        )
        self.side = nn.Sequential(nn.Linear(side, 32), nn.ReLU()) if side else nn.Identity()
        joined = 4 * width + (32 if side else 0)
        self.joined = nn.Sequential(nn.Dropout(dropout), nn.Linear(joined, FEATURES), nn.ReLU())

    def forward(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row width"]:
        """Features of scaled rows."""
        end = self.channels * self.points
        angle = self.blocks(X[:, :end].unflatten(1, (self.channels, self.points)))  # (row, 2 width, points / 8)
        return cast(Tensor, self.joined(torch.cat([angle.mean(2), angle.amax(2), self.side(X[:, end:])], dim=1)))


def _block(channels: int, width: int, kernel: int, mode: Literal["circular", "zeros"]) -> list[nn.Module]:
    convolution = nn.Conv1d(channels, width, kernel, 2, kernel // 2, bias=False, padding_mode=mode)
    return [convolution, nn.BatchNorm1d(width), nn.ReLU()]


def perceptron(
    columns: int, classes: int, layers: int = 2, neurons: int = 256, dropout: float = 0.3,
    *, channels: int = 0, points: int = 0, periodic: bool = True, seed: int = 0,
) -> Network:  # fmt: skip
    """Fully connected layers of ReLU units.

    Parameters
    ----------
    columns, classes : int
        Of the input, signal included, and of the output.
    layers, neurons : int
        Hidden layers and units in each.
    dropout : float
        Share of the units that training leaves out at a time.
    channels, points, periodic : int, int, bool
        Of the signal; they matter for its scaling only: the points of a periodic one are alike and share a scale.
    seed : int
        Of the initial weights.
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
    *, periodic: bool = True, seed: int = 0,
) -> Network:  # fmt: skip
    """Three blocks of convolutions over the angle, pooled; see :class:`Convolutions`.

    Parameters
    ----------
    channels, points : int
        Of the signal; points of a periodic one are a multiple of 8.
    columns, classes : int
        Of the input, signal included, and of the output.
    width : int
        Filters of the first block; the other two have twice as many.
    dropout : float
        Share of the pooled features that training leaves out at a time.
    periodic : bool
        Whether the points are angles of a revolution; else they are unlike, as features in a row are, and each has a
        scale of its own.
    seed : int
        Of the initial weights.
    """
    owner = "the convolutional network"
    _require_common(owner, columns, classes, channels, points, dropout)
    if channels < 1 or (periodic and points % STRIDE):
        raise ValueError(
            f"{owner} is given {channels} channels of {points} points, needs a signal whose points are a multiple of "
            f"{STRIDE}, for three blocks halve the revolution; without a signal take the perceptron"
        )
    require_integer(owner, "width", width, low=1, high=1024)
    with seeded(seed_hash("initial weights", seed)):
        body = Convolutions(channels, points, columns - channels * points, width, dropout, periodic)
        return Network(body, FEATURES, classes, columns, channels * periodic, points * periodic)


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


ARCHITECTURES: Mapping[str, Callable[..., Network]] = {"perceptron": perceptron, "convolutional": convolutional}


@dataclass(frozen=True)
class Architecture:
    """A kind of network with its options: what can be written to a file, and made anew from it.

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
    """PyTorch's global generators of the processor and of ``device``, seeded, and afterwards as they were before."""
    accelerators = [device] if device is not None and device.type == "cuda" else []
    with torch.random.fork_rng(devices=accelerators):
        torch.default_generator.manual_seed(seed)
        for each in accelerators:
            with torch.cuda.device(each):
                torch.cuda.manual_seed(seed)
        yield
