"""The examples of the documentation run as they stand, and each gives the number that its text speaks of."""

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from prepared_store import prepared

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]

# What holds of the variables of each example.
HOLDS: dict[str, Callable[[dict[str, Any]], bool]] = {
    "1_healthy_and_cracked": lambda found: found["share"][1] == pytest.approx(8.4, abs=0.1),
    "2_data_set_in_xarray": lambda found: found["cracked"].sizes["sample"] == 72,
    "3_table_of_the_paper": lambda found: found["table"].loc[(1, "knn"), "paper [%]"] == 97.95,
    "4_network_of_ones_own": lambda found: found["scores"].test_score > 95,
    "5_transfer_to_a_new_gear": lambda found: found["result"].table().loc[2].pipe(lambda of: of.error < of.unadapted),
    "6_close_the_loop": lambda found: found["answer"].table()["value"][0] == pytest.approx(10, abs=0.5),
    "7_robot_joint": lambda found: "load dependent friction" in found["answer"].sentence,
    "8_effect_of_ones_own": lambda found: found["shift"][1] == pytest.approx(2e-5 * found["point"].omega_in, rel=1e-3),
    "9_options_by_optuna": lambda found: found["study"].best_value > 100 / 6,
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder for all, as the examples share a data set."""
    return prepared(tmp_path_factory.mktemp("examples") / "mlruns").parent


def test_every_example_is_here() -> None:
    assert sorted(path.stem for path in EXAMPLES.glob("*.py")) == sorted(HOLDS)


@pytest.mark.parametrize("name", HOLDS)
def test_an_example_runs_and_draws(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    found = runpy.run_path(str(EXAMPLES / f"{name}.py"))
    assert found["figure"].axes
    assert HOLDS[name](found)


@pytest.mark.parametrize("name", HOLDS)
def test_an_example_is_short(name: str) -> None:
    assert len((EXAMPLES / f"{name}.py").read_text().splitlines()) <= 60
