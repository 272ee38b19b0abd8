"""The structure of another author: parameters with a smooth prior, whose spread healthy recordings tell."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR
from loop_fixtures import fitted_to

from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, WAVES
from swgsim.identification.commissioning.structural_spread import OF_GAUGES, WIDEST_SPREAD, most_probable
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model
from swgsim.identification.fit.map_fit import Calibrated
from swgsim.identification.fit.priors import COURSE, at, of_structure, of_unit
from swgsim.identification.fit.unit import Unit

LAYOUT = Layout(("s0", "s1", "s2"))


def test_a_unit_without_healthy_recordings_has_the_structure_of_the_truss():
    assert not [name for name in Unit(Model(GEAR)).declared if name.startswith("response")]
    assert not of_structure(0.0)


@pytest.mark.parametrize("presses_only", [False, True])
def test_a_parameter_moves_its_own_mode_of_the_factors_only(presses_only):
    parameters, model = of_structure(0.3, presses_only), Model(GEAR)
    assert any(name.startswith("compliance") for name in parameters) == presses_only
    position = dict(zip(parameters, np.random.default_rng(1).standard_normal(len(parameters)).tolist(), strict=True))
    moved = at(model, parameters, position)
    found = {name: parameter.value(moved) / parameter.sd for name, parameter in parameters.items()}
    assert found == pytest.approx(position)
    back = at(moved, parameters, {name: -by for name, by in position.items()})
    assert np.abs(back.gear.factors.teeth).max() < 1e-12
    assert model.gear.factors == EXACT_STRUCTURE


def test_interference_matters_only_where_the_sleeve_may_lift_off():
    pressing = replace(GEAR, wave_generator=replace(GEAR.wave_generator, presses_only=True))
    assert "interference" not in of_unit(GEAR)
    parameter = of_unit(pressing)["interference"]
    moved = parameter.at(Model(pressing), 4e-6)
    assert moved.gear.wave_generator.interference == parameter.value(moved) == 4e-6
    assert parameter.value(parameter.at(moved, 1.0)) == parameter.high


def test_factors_of_neighbouring_waves_are_alike_within_their_spread():
    parameters = {name: p for name, p in of_structure(0.3).items() if "to teeth, " in name}
    logs = []
    rng = np.random.default_rng(2)
    for _ in range(400):
        drawn = dict(zip(parameters, rng.standard_normal(len(parameters)).tolist(), strict=True))
        logs.append(at(Model(GEAR), parameters, drawn).gear.factors.teeth)
    for part in np.hsplit(np.array(logs), 2):
        assert part.std(axis=0) == pytest.approx(np.full(WAVES, 0.3), rel=0.2)
        neighbours = np.mean(part[:, 1:] * part[:, :-1]) / np.mean(part**2)
        assert neighbours == pytest.approx(np.exp(-1 / (2 * COURSE**2)), abs=0.05)


@pytest.mark.parametrize(("structure", "of_gauges"), [(0.01, 1.0), (0.1, 3.0), (0.5, 1.0)])
def test_the_spreads_that_recordings_were_drawn_with_are_the_most_probable(structure, of_gauges):
    rng = np.random.default_rng(3)
    fitted = fitted_to(LAYOUT, rng)
    unit = replace(fitted.unit, seen_healthy=True, structure=WIDEST_SPREAD, of_gauges=OF_GAUGES[-1])
    truth, parameters = replace(unit, structure=structure, of_gauges=of_gauges).declared, unit.declared
    situations = len(fitted.measured.situations)
    J = 3e3 * rng.standard_normal((situations, len(LAYOUT), len(parameters)))
    drawn = [truth[name].sd / p.sd * rng.standard_normal() for name, p in parameters.items()]
    measured = replace(fitted.measured, values=(J @ drawn)[fitted.measured.of_recording])
    calibrated = Calibrated(unit.model, dict.fromkeys(parameters, 0.0), fitted.calibrated.predicted, J, settled=True)
    found = most_probable(replace(fitted, unit=unit, parameters=parameters, measured=measured, calibrated=calibrated))
    assert (found.structure, found.of_gauges) == (structure, of_gauges)
