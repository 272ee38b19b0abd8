"""Time of the training loop, compared with bare optimiser steps and with a loop over PyTorch's DataLoader."""

import os
import time
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import replace
from math import ceil
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn
from torch.utils.data import DataLoader, TensorDataset

from learn.methods.networks import Network
from learn.methods.neural import convolutional_network
from learn.methods.training import Recipe, one_thread, train
from swgsim.common.seeds import generator

CLASSES = 6
# Compared loops take turns, so that other load of the machine affects all of them.
ROUNDS = 9
THREAD_ROUNDS, THREAD_STEPS = 5, 4


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
        ``seconds`` of a fit; ``samples_per_second``, where each epoch counts all rows; ``over_bare_step``, time of an
        epoch of :func:`learn.methods.training.train` divided by that of equally many bare steps on one resident batch;
        ``dataloader_loop_over_ours``, time of an epoch of a DataLoader loop divided by that of ours; ``threads``,
        seconds of a bare step with 1 thread and with all cores; ``recordings``; ``cores``.
    """
    X, y = _rows(recordings, channels, points, auxiliary)
    model = convolutional_network(channels, points, device="cpu")
    seconds = _seconds(lambda: model.fit(X, y), time.perf_counter)

    rows, classes = torch.as_tensor(X, dtype=torch.float32), torch.from_numpy(np.unique(y, return_inverse=True)[1])
    recipe = replace(model.recipe, epochs=1)
    steps = ceil(recordings / recipe.batch)
    size = ceil(recordings / steps)
    batch = (rows[:size].clone(), classes[:size].clone())

    def fresh() -> Network:
        return deepcopy(model.network_)

    def bare(count: int) -> None:
        _bare_steps(fresh(), [batch] * count, recipe)

    # With one thread, the time of the process is that of the work even if another process uses the core.
    with one_thread():
        ours, bare_steps, dataloader = _in_turns(
            ROUNDS,
            time.process_time,
            lambda: train(fresh(), rows, classes, recipe, seed=0),
            lambda: bare(steps),
            lambda: _dataloader_epoch(fresh(), rows, classes, recipe),
        )
    one, all_cores = _in_turns(
        THREAD_ROUNDS,
        time.perf_counter,
        lambda: _with_threads(1, lambda: bare(THREAD_STEPS)),
        lambda: _with_threads(len(os.sched_getaffinity(0)), lambda: bare(THREAD_STEPS)),
    )
    return {
        "recordings": recordings,
        "seconds": seconds,
        "samples_per_second": recordings * model.recipe.epochs / seconds,
        "over_bare_step": float(np.median(ours / bare_steps)),
        "dataloader_loop_over_ours": float(np.median(dataloader / ours)),
        "threads": {"1": float(np.median(one)) / THREAD_STEPS, "all": float(np.median(all_cores)) / THREAD_STEPS},
        "cores": len(os.sched_getaffinity(0)),
    }


def _in_turns(
    rounds: int, clock: Callable[[], float], *works: Callable[[], object]
) -> Float[np.ndarray, "work round"]:  # fmt: skip
    """Times of functions that take turns [s], after one turn without timing."""
    times = [[_seconds(work, clock) for work in works] for _ in range(1 + rounds)]
    return np.array(times[1:]).T


def _with_threads(count: int, work: Callable[[], None]) -> None:
    with one_thread():
        torch.set_num_threads(count)
        work()


def _seconds(work: Callable[[], object], clock: Callable[[], float]) -> float:
    start = clock()
    work()
    return clock() - start


def _rows(recordings: int, channels: int, points: int, auxiliary: int) -> tuple[np.ndarray, np.ndarray]:
    """Noise with a pulse whose angle is the class."""
    rng = generator("training benchmark", recordings)
    X, number = rng.standard_normal((recordings, channels * points + auxiliary)), np.arange(recordings) % CLASSES
    X[np.arange(recordings), number * points // CLASSES] += 3.0
    return X, np.array([f"class {each}" for each in number])


def _bare_steps(network: Network, batches: Iterable[Iterable[Tensor]], recipe: Recipe) -> None:
    """Forward, backward and optimiser steps only."""
    optimiser = torch.optim.AdamW(network.parameters(), recipe.rate, weight_decay=recipe.decay, fused=True)
    network.train()
    for X, y in batches:
        optimiser.zero_grad()
        nn.functional.cross_entropy(network(X), y).backward()
        optimiser.step()


def _dataloader_epoch(network: Network, X: Tensor, y: Tensor, recipe: Recipe) -> None:
    """One epoch with PyTorch's loader of shuffled batches."""
    _bare_steps(network, DataLoader(TensorDataset(X, y), recipe.batch, shuffle=True), recipe)
