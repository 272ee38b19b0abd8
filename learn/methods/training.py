"""The training loop of all networks, from scratch and for transfer."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil

import torch
from jaxtyping import Float, Shaped
from torch import Tensor, nn

from learn.inputs.rows import Rows, as_tensor
from learn.methods.networks import Network, seeded
from swgsim.common.checks import require, require_integer
from swgsim.common.seeds import generator, seed_hash


@dataclass(frozen=True)
class Recipe:
    """Duration and rate of training.

    Attributes
    ----------
    epochs : int
        Passes through all rows.
    batch : int
        Largest number of rows in a step.
    rate, decay : float
        Highest learning rate of the cycle, and weight decay of AdamW.
    steps : int
        Least number of steps. Few rows have few steps in an epoch, and are passed through more often.
    """

    epochs: int = 15
    batch: int = 256
    rate: float = 3e-3
    decay: float = 1e-2
    steps: int = 0

    def __post_init__(self) -> None:
        owner = "the recipe"
        require_integer(owner, "epochs", self.epochs, low=1, high=100_000)
        require_integer(owner, "batch", self.batch, low=2, high=1_000_000)
        require(owner, "rate", self.rate, low=1e-9, high=10)
        require(owner, "decay", self.decay, low=0, high=10)
        require_integer(owner, "steps", self.steps, low=0, high=10_000_000)


def train(
    network: Network, X: Float[Tensor, "row column"] | Rows, y: Shaped[Tensor, "*row"], recipe: Recipe, seed: int,
    *, parameters: Iterable[nn.Parameter] | None = None, penalty: Callable[[Network], Tensor] | None = None,
    frozen_statistics: bool = False, loss_of: Callable[[Tensor, Tensor], Tensor] = nn.functional.cross_entropy,
) -> None:  # fmt: skip
    """Fit a network in place with AdamW, and leave it in evaluation mode.

    The number of steps is fixed. Early stopping would need rows of the target gear, or source rows that training lacks.

    Parameters
    ----------
    network : Network
        Network on its device.
    X, y : tensor (row, column), tensor (row,)
        Rows and numbers of their classes, on any device, or targets of another loss. Rows in a file are read batch by
        batch.
    recipe : Recipe
    seed : int
        Seed of the order of the rows and of dropout.
    parameters : iterable of Parameter, optional
        Parameters to train, such as ``network.head.parameters()``; all by default.
    penalty : callable, optional
        Term that is added to the loss in each step, such as a distance to the initial weights.
    frozen_statistics : bool
        Whether batch normalisation keeps its mean and variance, which few rows cannot estimate.
    loss_of : callable
        Mean loss of outputs and targets; by default the cross entropy.

    Raises
    ------
    ValueError
        If there is no row, or the last loss is not finite.
    """
    if not len(X):
        raise ValueError("there are 0 rows to train on, at least 1 is needed")
    device = network.centre.device
    batch, y = _reader(X, network), y.to(device)
    trained = list(network.parameters() if parameters is None else parameters)
    steps = ceil(len(X) / recipe.batch)
    epochs = max(recipe.epochs, ceil(recipe.steps / steps))
    optimiser = torch.optim.AdamW(trained, lr=recipe.rate, weight_decay=recipe.decay, fused=True)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, recipe.rate, total_steps=epochs * steps)
    order = generator("order of the rows", seed)
    network.train()
    if frozen_statistics:
        for module in network.modules():
            if isinstance(module, nn.modules.batchnorm._BatchNorm):
                module.eval()
    with one_thread(), seeded(seed_hash("training", seed), device):
        for _ in range(epochs):
            # Batch sizes differ by at most one row, as batch normalisation needs no small batch.
            for rows in torch.from_numpy(order.permutation(len(X))).to(device).tensor_split(steps):
                loss = loss_of(network.head(network.body(batch(rows))), y.index_select(0, rows))
                if penalty is not None:
                    loss = loss + penalty(network)
                optimiser.zero_grad()
                loss.backward(inputs=trained)  # no gradients for fixed weights
                optimiser.step()
                schedule.step()
    network.eval()
    if not torch.isfinite(loss):
        raise ValueError(f"training ended with a loss of {loss.item()}: lower the rate, which is {recipe.rate:g}")


def _reader(X: Float[Tensor, "row column"] | Rows, network: Network) -> Callable[[Tensor], Tensor]:
    """Function from row numbers to scaled rows on the device of the network."""
    device = network.centre.device
    if isinstance(X, Rows):
        return lambda rows: network.scaled(as_tensor(X[rows.cpu().numpy()]).to(device))
    resident = network.scaled(X.to(device))  # once, as asinh takes up to a quarter of a step
    return lambda rows: resident.index_select(0, rows)


def choose_device(device: str) -> torch.device:
    """The named device; ``auto`` is the accelerator if there is one, else the processor.

    Raises
    ------
    ValueError
        If the name is unknown or PyTorch does not find the device.
    """
    found = torch.cuda.is_available()
    try:
        chosen = torch.device("cuda" if found else "cpu") if device == "auto" else torch.device(device)
    except RuntimeError as error:
        raise ValueError(f"unknown device {device!r}; choose from auto, cpu, cuda") from error
    if chosen.type not in ("cpu", "cuda") or (chosen.type == "cuda" and not found):
        raise ValueError(f"PyTorch does not find device {device!r}; choose auto or cpu")
    return chosen


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit PyTorch to one thread inside the context.

    Jobs of a sweep run in parallel, and more threads than cores are several times slower. The order of sums, and so
    the last digit of every weight, is then independent of the number of cores.
    """
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)
