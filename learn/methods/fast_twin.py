"""The fast twin: one network for all gears of a series, which is given the references of the gear that it judges.

It approximates the posterior of the twin (:mod:`learn.methods.twin`), which is fitted to each gear anew. Training takes
simulated gears and no recording of a data set, so it is done once; the network is kept in a file.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.rows import Inputs, chunks
from learn.methods.contract import believed_classes
from swgsim.common.checks import require_integer
from swgsim.common.files import replacing, sole_maker
from swgsim.common.seeds import seed_hash

if TYPE_CHECKING:
    from torch import Tensor

    from learn.methods.fault_outputs import FaultOutputs
    from learn.methods.networks import Network
    from swgsim.dataset.plan import Plan

SCALED = 30_000  # largest number of healthy rows for the scaling


class FastTwin:
    """A network that is trained on simulated gears, and given the references of the gear that it judges.

    It takes rows of ``features=referenced``. ``fit`` learns nothing from its rows but the names of the classes: it
    reads the network of these choices, or trains it if there is none. Training gears have other seeds than
    data sets.

    Parameters
    ----------
    gear, grid, condition, window, mesh : mapping
        What is believed, as ``conf/generate.yaml`` has it: the nominal gear; the population, extremes of severities,
        operating points and references; the bench; sampling; the mesh.
    models : str
        Folder of the file.
    workers : int or None
        Processes that simulate; None: one per core.
    gears, variants : int
        Number of gears in training, and of variants of every class of each; every gear stands in four directions.
    layers, neurons : int
        As in :func:`learn.methods.networks.perceptron`.
    epochs, batch, rate, decay
        As in :class:`learn.methods.training.Recipe`.
    seed : int
        Of the gears, the initial weights and the training.
    """

    def __init__(
        self,
        gear: Mapping[str, Any],
        grid: Mapping[str, Any],
        condition: Mapping[str, Any],
        window: Mapping[str, Any],
        mesh: Mapping[str, Any],
        models: str,
        workers: int | None,
        gears: int = 1200,
        variants: int = 8,
        layers: int = 3,
        neurons: int = 256,
        epochs: int = 4,
        batch: int = 512,
        rate: float = 2e-3,
        decay: float = 1e-2,
        seed: int = 0,
    ):
        require_integer("the fast twin", "gears", gears, low=2, high=100_000)
        drawn = {"population": {**(grid["population"] or {}), "count": gears}, "drawn": True}
        grid = {**grid, **drawn, "variants": variants, "seed": seed_hash("fast twin", seed) >> 1}
        believed = {"gears": {"nominal": gear}, "grid": grid, "condition": condition, "window": window, "mesh": mesh}
        self._believed = json.dumps(believed, sort_keys=True)
        self._options: dict[str, int | float] = {"layers": layers, "neurons": neurons, "dropout": 0.0}
        self._recipe = epochs, batch, rate, decay
        self.seed, self.models, self.workers = seed, Path(models), workers

    def fit(self, X: Inputs, y: np.ndarray) -> "FastTwin":
        """Note the names of the classes, and read or train the network.

        Raises
        ------
        ValueError
            If a class is not among those that are believed, or the file is damaged.
        """
        self.classes_ = believed_classes(y, self.outputs.classes)
        # Jobs of a sweep with the same network start together; the first one trains it.
        with sole_maker(self.path, wait=True):
            if not self.path.exists():
                self._train()
        self.network_ = self._read()
        return self

    def predict(self, X: Inputs) -> np.ndarray:
        """Likeliest class of each row."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def predict_proba(self, X: Inputs) -> Float[np.ndarray, "row class"]:
        """Probability of each class, all of them equally frequent; raises like :meth:`diagnosis`."""
        p = self.outputs.probabilities(self._outputs_of(X))[:, [self.outputs.classes.index(n) for n in self.classes_]]
        return p / p.sum(axis=1, keepdims=True)

    def diagnosis(self, X: Inputs) -> pd.DataFrame:
        """Probability of every class, and severity and position with intervals (:mod:`swgsim.oracle.diagnosis`).

        Raises
        ------
        ValueError
            If the rows are no rows of ``features=referenced`` at the operating points of the training.
        """
        return self.outputs.diagnosis(self._outputs_of(X))

    @property
    def plan(self) -> "Plan":
        """The plan of the gears in training."""
        from swgsim.jobs import settings

        return settings.plan(json.loads(self._believed))

    @property
    def outputs(self) -> "FaultOutputs":
        """What the outputs of the network mean."""
        from learn.methods.fault_outputs import FaultOutputs

        grid = json.loads(self._believed)["grid"]
        ends = {label: (min(sizes), max(sizes)) for label, sizes in grid["severities"].items()}
        return FaultOutputs({label: ends[label] for label in grid["classes"] if label in ends})

    @property
    def path(self) -> Path:
        """File of the network, which holds the weights of these choices and this code."""
        from swgsim.common.version import code_version

        digest = hashlib.sha256(code_version().encode())
        digest.update(json.dumps([self._believed, self._options, self._recipe, self.seed]).encode())
        for folder in (Path(__file__).parent, Path(__file__).parents[1] / "inputs"):
            for source in sorted(folder.glob("*.py")):
                digest.update(source.read_bytes())
        return self.models / f"fast_twin-{digest.hexdigest()[:16]}.pt"

    def _untrained(self, columns: int) -> "Network":
        from learn.methods.networks import Architecture

        return Architecture("perceptron", self._options).network(columns, len(self.outputs), self.seed)

    def _train(self) -> None:
        """Simulate the gears, train the network and write it."""
        import torch

        from learn.methods.training import Recipe, train
        from learn.methods.training_gears import training_gears
        from swgsim.common.compute import Engine

        self.models.mkdir(parents=True, exist_ok=True)
        X, y = training_gears(self.plan, self.outputs, Engine(self.workers), self.models)
        network = self._untrained(X.shape[1])
        # Healthy recordings show the noise of every input, by which small faults are measured.
        network.set_scaling(np.asarray(X[np.flatnonzero(y[:, 0] == 0)[:SCALED]]))
        targets = torch.from_numpy(y.astype(np.float32))
        train(network, X, targets, Recipe(*self._recipe), self.seed, loss_of=self.outputs.loss)
        with replacing(self.path) as aside, aside.open("wb") as raw:
            torch.save(network.state_dict(), raw)

    def _read(self) -> "Network":
        """The network in the file; no code in the file is run."""
        import torch

        try:
            state = torch.load(self.path, map_location="cpu", weights_only=True)
            network = self._untrained(len(state["centre"]))
            network.load_state_dict(state)
        except Exception as error:  # PyTorch raises many kinds
            raise ValueError(f"{self.path} is no such network, or damaged: remove it to train anew") from error
        return network.eval()

    def _outputs_of(self, X: Inputs) -> "Tensor":
        """Outputs of the network."""
        import torch

        from learn.inputs.reference_lines import ReferenceLines
        from learn.methods.training import one_thread
        from swgsim.common.build import build
        from swgsim.gear.acquisition import Window
        from swgsim.jobs import settings

        believed = json.loads(self._believed)
        inputs = ReferenceLines(build(Window, believed["window"]), settings.grid(believed["grid"]).points)
        with torch.inference_mode(), one_thread():
            made = [torch.from_numpy(inputs(rows).astype(np.float32)) for rows in chunks(X)]
            return torch.cat([self.network_(rows) for rows in made])
