"""
A network of one's own
======================

Every classifier with ``fit``, ``predict``, ``predict_proba`` and ``classes_`` can be judged: scikit-learn's contract.
On the command line it is ``PYTHONPATH=FOLDER swg train classifier=my_module:MyNet``, with ``my_module.py`` in FOLDER.
The networks of the workbench are in ``learn/methods/networks.py``.
"""

import numpy as np
import torch

import learn
import swgsim as swg


class MyNet:
    """Two layers on standardised features, trained on all rows at once."""

    def fit(self, X: np.ndarray, y: np.ndarray) -> "MyNet":
        self.classes_, numbers = np.unique(y, return_inverse=True)
        X = np.asarray(X, "f4")
        self.mean, self.scale = X.mean(axis=0), X.std(axis=0) + 1e-9
        torch.manual_seed(0)
        self.net = torch.nn.Sequential(
            torch.nn.Linear(X.shape[1], 64), torch.nn.ReLU(), torch.nn.Linear(64, len(self.classes_))
        )
        optimiser = torch.optim.AdamW(self.net.parameters(), lr=1e-2)
        rows, targets = torch.as_tensor((X - self.mean) / self.scale), torch.as_tensor(numbers)
        for _ in range(60):
            optimiser.zero_grad()
            torch.nn.functional.cross_entropy(self.net(rows), targets).backward()
            optimiser.step()
        return self

    def predict_proba(self, X: np.ndarray) -> np.ndarray:
        rows = torch.as_tensor((np.asarray(X, "f4") - self.mean) / self.scale)
        with torch.no_grad():
            return self.net(rows).softmax(dim=1).numpy()

    def predict(self, X: np.ndarray) -> np.ndarray:
        return self.classes_[self.predict_proba(X).argmax(axis=1)]


# %%
data = learn.load(swg.generate("small", "clean", data="data"), features="harmonics")
scores = learn.evaluate(data, MyNet, protocol="leave_one_gear_out")
print(scores)
print(scores.table())
figure = scores.plot()
