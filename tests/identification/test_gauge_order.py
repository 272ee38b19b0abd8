"""Gauges that are exchanged against the commissioning are told by what those of one unit differ by, and no fault is."""

from dataclasses import replace
from functools import cache

import pytest
from chain_fixtures import GEAR, SECTORS

from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Sessions, record_sessions
from swgsim.effects import EccentricWaveGenerator, Effect
from swgsim.effects.gauge_gain import GaugeGain
from swgsim.effects.gauge_position import GaugePosition
from swgsim.effects.tilted_wave_generator import TiltedWaveGenerator
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.gauge_order import order_defects
from swgsim.recordings.recording import Recording
from swgsim.studies.examples import EXAMPLES

pytestmark = pytest.mark.end_to_end
OF_UNIT = (GaugeGain(1, 0.01), GaugePosition(3, 0.005), GaugeGain(4, -0.01))
POINTS = (OperatingPoint(2000.0, 10.0), OperatingPoint(4000.0, 70.0))


@cache
def recorded(*effects: Effect, seed: int = 1, points: tuple[OperatingPoint, ...] = POINTS) -> tuple[Recording, ...]:
    """A unit whose gauges differ by about a hundredth, as those of any unit do."""
    plan = Sessions(points, repeats=2, revolutions=5)
    return record_sessions(
        GEAR, (*OF_UNIT, *effects), plan, Bench(), seed=seed, window=Window(), sectors=SECTORS, name="A"
    )


def exchanged(recordings: tuple[Recording, ...], *pairs: tuple[str, str]) -> tuple[Recording, ...]:
    for a, b in pairs:
        recordings = tuple(
            replace(each, channels={**each.channels, a: each.channels[b], b: each.channels[a]}) for each in recordings
        )
    return recordings


@pytest.mark.parametrize("pair", [("s1", "s3"), ("s2", "s4")])
def test_a_pair_that_is_exchanged_is_refused(pair):
    (defect,) = order_defects(exchanged(recorded(seed=2), pair), recorded())
    assert (defect.kind, defect.severity, defect.channel) == ("gauges_exchanged", "refuse", " ".join(pair))
    assert "swap their columns" in defect.remedy


def test_a_ring_that_is_numbered_from_the_opposite_gauge_is_refused():
    recordings = exchanged(recorded(seed=2), ("s1", "s3"), ("s2", "s4"))
    assert [defect.channel for defect in order_defects(recordings, recorded())] == ["s1 s3", "s2 s4"]


@pytest.mark.parametrize(
    "effect",
    [
        *EXAMPLES.values(),
        GaugeGain(1, -0.05),
        GaugeGain(1, -0.01),
        EccentricWaveGenerator(30e-6, 1.0),
        TiltedWaveGenerator(1e-3, 1.0),
    ],
    ids=lambda effect: type(effect).name(),
)
def test_a_sick_gear_keeps_its_gauges(effect):
    assert order_defects(recorded(effect, seed=2), recorded()) == []


def test_nothing_is_told_without_a_common_operating_point():
    elsewhere = exchanged(recorded(seed=2, points=(OperatingPoint(3000.0, 39.0),)), ("s1", "s3"))
    assert order_defects(elsewhere, recorded()) == []


def test_gauges_that_were_not_recorded_are_not_compared():
    few = [
        tuple(replace(each, channels={k: v for k, v in each.channels.items() if k != "s3"}) for each in recordings)
        for recordings in (exchanged(recorded(seed=2), ("s2", "s4")), recorded())
    ]
    assert [defect.channel for defect in order_defects(*few)] == ["s2 s4"]
