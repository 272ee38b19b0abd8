"""Bodies of networks that convolve a signal over the revolution."""

from typing import Literal, cast

import torch
from jaxtyping import Float
from torch import Tensor, nn

# Three blocks halve the number of points.
STRIDE = 8
FEATURES = 64  # at the output of the convolutional body
Mode = Literal["circular", "zeros"]


class Convolutions(nn.Module):
    """Convolutions over the revolution, pooled over the angle, and joined with the auxiliary columns.

    A periodic signal is padded circularly, another one with zeros. With strides of 2 in three blocks, circular shifts
    of a periodic signal by multiples of 8 points do not change the output; other shifts do.

    Parameters
    ----------
    channels, points, side : int
        Size of the signal, and number of auxiliary columns.
    width : int
        Number of filters of the first block; the other two have twice as many.
    dropout : float
        Share of the pooled features that each training step leaves out.
    periodic, residual : bool
        Whether the signal is periodic, and whether the second and third block are :class:`ResidualBlock`.
    """

    def __init__(
        self, channels: int, points: int, side: int, width: int, dropout: float, periodic: bool, residual: bool
    ) -> None:
        super().__init__()
        self.channels, self.points = channels, points
        mode: Mode = "circular" if periodic else "zeros"
        widths = (width, 2 * width), (2 * width, 2 * width)
        further = [
            layer
            for before, after in widths
            for layer in ([ResidualBlock(before, after, mode)] if residual else _block(before, after, 5, mode))
        ]
        self.blocks = nn.Sequential(*_block(channels, width, 9, mode), *further)
        self.side = nn.Sequential(nn.Linear(side, 32), nn.ReLU()) if side else nn.Identity()
        joined = 4 * width + (32 if side else 0)
        self.joined = nn.Sequential(nn.Dropout(dropout), nn.Linear(joined, FEATURES), nn.ReLU())

    def forward(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row width"]:
        """Features of scaled rows."""
        end = self.channels * self.points
        angle = self.blocks(X[:, :end].unflatten(1, (self.channels, self.points)))  # (row, 2 width, points / 8)
        return cast(Tensor, self.joined(torch.cat([angle.mean(2), angle.amax(2), self.side(X[:, end:])], dim=1)))


class ResidualBlock(nn.Module):
    """Two convolutions that add to their input, which passes by them (He et al., 2016); halves the points."""

    def __init__(self, channels: int, width: int, mode: Mode) -> None:
        super().__init__()
        second = nn.Conv1d(width, width, 5, padding=2, bias=False, padding_mode=mode)
        self.change = nn.Sequential(*_block(channels, width, 5, mode), second, nn.BatchNorm1d(width))
        self.bypass = nn.Sequential(nn.Conv1d(channels, width, 1, 2, bias=False), nn.BatchNorm1d(width))

    def forward(self, X: Float[Tensor, "row channel point"]) -> Float[Tensor, "row width half"]:
        """Signal of half as many points."""
        return torch.relu(self.change(X) + self.bypass(X))


def _block(channels: int, width: int, kernel: int, mode: Mode) -> list[nn.Module]:
    convolution = nn.Conv1d(channels, width, kernel, 2, kernel // 2, bias=False, padding_mode=mode)
    return [convolution, nn.BatchNorm1d(width), nn.ReLU()]
