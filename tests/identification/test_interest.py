"""Whether a change matters: compared with healthy units of a series on the same bench."""

import pytest
from chain_fixtures import GEAR

from swgsim.bench.scatter import Bench
from swgsim.blind.bench import Setting, in_question
from swgsim.blind.sealed import Sealed
from swgsim.blind.strata import FULL, SINGLE
from swgsim.effects.library import LIBRARY
from swgsim.gear.acquisition import Window
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit import map_fit, priors
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.interest import shares_of_spread


@pytest.mark.slow
def test_an_unknown_bench_makes_no_change_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Inertias that a gear file hardly knows say nothing of how far healthy units differ."""
    monkeypatch.setattr(map_fit, "MOST_STEPS", 1)
    ripple = LIBRARY["motor_torque_ripple"](order=2, amplitude=0.01)
    setting = Setting(GEAR, Bench(), Window(), (type(ripple),), 4, (60,), 3)
    case = Sealed(0, SINGLE, FULL.name, FULL.points[:2], 1, 17, 60, True, False, (1.0, 1.0), "mesh")
    fitted = fit(Measured.of(in_question(case, setting, (ripple,))), Unit(Model(GEAR)), Model(GEAR).plus(ripple))
    known = shares_of_spread(fitted)
    monkeypatch.setattr(priors, "BENCH", 10 * priors.BENCH)
    assert shares_of_spread(fitted) == known
    monkeypatch.setattr(priors, "ERROR_PART", 10 * priors.ERROR_PART)
    assert shares_of_spread(fitted) < known
