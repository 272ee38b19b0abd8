"""Time of the training loop, compared with bare optimiser steps and with a loop over PyTorch's DataLoader."""

import time
from collections.abc import Iterable
from copy import deepcopy
from dataclasses import replace
from math import ceil
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn
from torch.utils.data import DataLoader, TensorDataset

from learn.methods.networks import Network
from learn.methods.neural import convolutional_network
from learn.methods.training import Recipe, one_thread, train
from swgsim.common.seeds import generator

CLASSES = 6
ROUNDS = 9


def measure(recordings: int = 4320, channels: int = 5, points: int = 64, auxiliary: int = 9) -> dict[str, Any]:
    """Time the convolutional network on made-up rows.

    Parameters
    ----------
    recordings : int
        Number of rows.
    channels, points, auxiliary : int
        Size of the signal, and number of other columns.

    Returns
    -------
    dict
        ``recordings``; ``seconds`` of a fit; ``samples_per_second``, where each epoch counts all rows;
        ``over_bare_step``, time of an epoch of :func:`learn.methods.training.train` divided by that of equally many
        bare steps on one resident batch; ``dataloader_loop_over_ours``, time of an epoch of a DataLoader loop divided
        by that of ours.
    """
    rng = generator("training benchmark", recordings)
    X, number = rng.standard_normal((recordings, channels * points + auxiliary)), np.arange(recordings) % CLASSES
    X[np.arange(recordings), number * points // CLASSES] += 3.0  # a pulse at the angle of the class
    model = convolutional_network(channels, points, device="cpu")
    start = time.perf_counter()
    model.fit(X, np.array([f"class {each}" for each in number]))
    seconds = time.perf_counter() - start

    rows, classes = torch.as_tensor(X, dtype=torch.float32), torch.from_numpy(number)
    recipe = replace(model.recipe, epochs=1)
    steps = ceil(recordings / recipe.batch)
    size = ceil(recordings / steps)
    batch = (rows[:size].clone(), classes[:size].clone())
    loader = DataLoader(TensorDataset(rows, classes), recipe.batch, shuffle=True)
    loops = (
        lambda network: train(network, rows, classes, recipe, seed=0),
        lambda network: _bare_steps(network, [batch] * steps, recipe),
        lambda network: _bare_steps(network, loader, recipe),
    )
    times = np.empty((1 + ROUNDS, len(loops)))
    with one_thread():  # the time of the process is then that of the work, even if another process uses the core
        for turn in times:  # loops take turns, so that other load of the machine affects all of them
            for column, loop in enumerate(loops):
                network = deepcopy(model.network_)
                start = time.process_time()
                loop(network)
                turn[column] = time.process_time() - start
    ours, bare_steps, dataloader = times[1:].T  # the first round warms up
    return {
        "recordings": recordings,
        "seconds": seconds,
        "samples_per_second": recordings * model.recipe.epochs / seconds,
        "over_bare_step": float(np.median(ours / bare_steps)),
        "dataloader_loop_over_ours": float(np.median(dataloader / ours)),
    }


def _bare_steps(network: Network, batches: Iterable[Iterable[Tensor]], recipe: Recipe) -> None:
    """Forward, backward and optimiser steps only."""
    optimiser = torch.optim.AdamW(network.parameters(), recipe.rate, weight_decay=recipe.decay, fused=True)
    network.train()
    for X, y in batches:
        optimiser.zero_grad()
        nn.functional.cross_entropy(network(X), y).backward()
        optimiser.step()
