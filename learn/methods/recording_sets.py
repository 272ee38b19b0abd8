"""Body of a network on units: the same layers for every recording, whose outputs are pooled."""

from typing import cast

import torch
from jaxtyping import Float
from torch import Tensor, nn


class RecordingSets(nn.Module):
    """Layers that all recordings of a unit share, then layers on mean and maximum over the recordings.

    These are the deep sets of Zaheer et al. (NeurIPS 2017). The columns of each recording are scaled by themselves, so
    that speed and load do not show; a learned offset says which operating point it is.

    Parameters
    ----------
    features, recordings : int
        A row has every feature at each recording, feature by feature.
    neurons : int
        Units in each layer.
    dropout : float
        Share of the units that each training step leaves out.
    """

    def __init__(self, features: int, recordings: int, neurons: int, dropout: float) -> None:
        super().__init__()
        self.features, self.recordings = features, recordings
        self.first = nn.Linear(features, neurons)
        self.at_point = nn.Parameter(torch.zeros(recordings, neurons))
        self.second = nn.Sequential(nn.ReLU(), nn.Dropout(dropout), nn.Linear(neurons, neurons), nn.ReLU())
        self.together = nn.Sequential(
            nn.Dropout(dropout), nn.Linear(2 * neurons, neurons), nn.ReLU(), nn.Dropout(dropout)
        )

    def forward(self, X: Float[Tensor, "row column"]) -> Float[Tensor, "row width"]:
        """Features of scaled rows."""
        of_recordings = X.unflatten(1, (self.features, self.recordings)).transpose(1, 2)
        each = self.second(self.first(of_recordings) + self.at_point)  # (row, recording, neuron)
        return cast(Tensor, self.together(torch.cat([each.mean(1), each.amax(1)], dim=1)))
