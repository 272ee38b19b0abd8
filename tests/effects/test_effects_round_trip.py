"""Every effect that a loop searches is added to a model and taken away again, and nothing of it changes nothing."""

from dataclasses import replace

import numpy as np
import pytest
from chain_fixtures import GEAR, SECTORS

from swgsim.chain import influence, structure
from swgsim.chain.steady_state_cache import forget
from swgsim.effects.base import Effect
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.kinematic_error_order import KinematicErrorOrder
from swgsim.effects.library import SEARCHED
from swgsim.effects.quantity import quantities, size_of
from swgsim.effects.zero_offset import ZeroOffset
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import COMPARED, ORDERS, Layout
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.data.unit_lines import LAWS, Lines
from swgsim.studies.effect_signature import typical

pytestmark = pytest.mark.end_to_end
LAYOUT = Layout(COMPARED)
WARM = Conditions(temperature=45.0, elapsed=1800.0)
# Nearly all effects act under load. Without it and slowly the flanks slide on thin films, and the large ripple of the
# first effect turns the torque around, so that a gap between them opens.
SITUATIONS = [Situation(OperatingPoint(*point), WARM) for point in ((2000, 70), (700, 0))]
FIRST, LAST = KinematicErrorOrder(2, 3e-4), ZeroOffset(2, 0.01)
MODEL = Model(GEAR, (FIRST, LAST))


def predicted(model: Model) -> np.ndarray:
    """Features (situation, feature) for which nothing is remembered but the ellipse that all structures begin with."""
    forget()
    structure._computed.cache_clear()
    influence.load_amplitudes.cache_clear()
    [found] = predict([model], SITUATIONS, LAYOUT, SECTORS)
    return found


@pytest.fixture(scope="module")
def before() -> np.ndarray:
    """What the model predicts before any effect of the library was asked for."""
    return predicted(MODEL)


def test_an_effect_is_added_and_taken_away_again(before: np.ndarray) -> None:
    added = [Model(GEAR, (FIRST,)).plus(typical(kind), LAST) for kind in SEARCHED]
    # More than a recording tells of a line of the gauges, about 2e-5 mV/V.
    changes = [np.abs(found - before).max() for found in predict(added, SITUATIONS, LAYOUT, SECTORS)]
    assert [kind.name() for kind, change in zip(SEARCHED, changes, strict=True) if not change > 2e-5] == []
    assert {each.without(1) for each in added} == {MODEL}
    np.testing.assert_array_equal(predicted(added[-1].without(1)), before)


@pytest.mark.parametrize("kind", SEARCHED, ids=[kind.name() for kind in SEARCHED])
def test_nothing_of_an_effect_changes_nothing(before: np.ndarray, kind: type[Effect]) -> None:
    size = size_of(kind)
    nothing = replace(typical(kind), **{size: quantities(kind)[size].nothing})
    np.testing.assert_allclose(predicted(MODEL.plus(nothing)), before, rtol=1e-12, atol=1e-12)


def test_a_model_loses_the_effect_that_is_named_and_nothing_else() -> None:
    """Also where another one is equal to it; and the model that had it keeps it."""
    lines = Lines(("s0",), np.ones((len(LAWS), 1, ORDERS + 1), complex), GEAR.gauges)
    gain = GaugeGain(1, 0.01)
    model = Model(GEAR, (FIRST,), lines).plus(gain, LAST).plus(gain)
    assert model == Model(GEAR, (FIRST, gain, LAST, gain), lines)
    left = [model.without(number) for number in range(4)]
    assert [each.effects for each in left] == [
        (gain, LAST, gain), (FIRST, LAST, gain), (FIRST, gain, gain), (FIRST, gain, LAST)
    ]  # fmt: skip
    assert all((each.gear, each.own_lines) == (GEAR, lines) for each in left)
    assert model.effects == (FIRST, gain, LAST, gain)
