"""Units from recordings, against products by hand."""

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import specimens
from learn.evaluation.units import units
from swgsim.storage.labelled_signals import CLASSES


def predictions() -> pd.DataFrame:
    """Two specimens at two operating points, in mixed order; one recording of the first is wrong by a little."""
    facts = pd.DataFrame({
        "gear": [1, 1, 1, 1],
        "label": pd.Categorical(["healthy", "tip_tooth_crack", "healthy", "tip_tooth_crack"], CLASSES),
        "variant": [0, 0, 0, 0],
        "severity": [np.nan, 0.7, np.nan, 0.7],
    })  # fmt: skip
    p = np.array([
        [0.4, 0.5, 0.1, 0, 0, 0],
        [0.0, 0.1, 0.0, 0, 0, 0.9],
        [0.8, 0.1, 0.1, 0, 0, 0],
        [0.2, 0.2, 0.0, 0, 0, 0.6],
    ])  # fmt: skip
    return facts.join(pd.DataFrame(p, columns=list(CLASSES)))


def test_a_unit_has_the_product_of_its_posteriors() -> None:
    found = units(predictions())
    assert found["label"].tolist() == ["healthy", "tip_tooth_crack"]
    product = np.array([0.32, 0.05, 0.01])
    np.testing.assert_allclose(found.loc[0, list(CLASSES[:3])].astype(float), product / product.sum(), rtol=1e-9)
    np.testing.assert_allclose(found[list(CLASSES)].sum(axis=1), 1)
    assert np.isnan(found["severity"][0])
    assert found["severity"][1] == 0.7


def test_units_err_less_often_than_recordings() -> None:
    assert specimens(predictions())["error"].tolist() == [50.0, 0.0]
    assert specimens(units(predictions()))["error"].tolist() == [0.0, 0.0]


def test_a_class_without_a_vote_is_not_impossible() -> None:
    """Votes of a forest for a class may be none at one operating point and all at the others."""
    table = predictions()
    table.loc[0, list(CLASSES)] = np.eye(6)[1]
    table.loc[2, list(CLASSES)] = [1 - 1e-9, 1e-9, 0, 0, 0, 0]
    assert np.isfinite(units(table)[list(CLASSES)].to_numpy()).all()
