"""Lines between the orders are found and named; noise is not."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from loop_fixtures import POINTS
from sideline_fixtures import NOISE, measured

from swgsim.effects.base import Effect, Scene
from swgsim.effects.library import LIBRARY
from swgsim.effects.quantity import random_phase, shape, size
from swgsim.identification.data.features import Layout, features
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_search import cleaned, search
from swgsim.identification.interharmonics.named_interharmonics import ranked
from swgsim.identification.interharmonics.signal_shapes import ordinary, shapes
from swgsim.identification.interharmonics.unattributed_lines import unnamed
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]

KINDS = [LIBRARY["bearing_cage"], LIBRARY["mains_hum"]]


@dataclass(frozen=True)
class Whistle(Effect):
    """A line at an order that no effect of the library has."""

    amplitude: float = size(unit="mV/V", low=0, high=1, typical=1e-3)
    order: float = shape(5.37, unit="-", low=0, high=12)
    phase: float = random_phase()

    def gauge(self, signals, scene: Scene):
        return signals + self.amplitude * np.cos(self.order * scene.phi_in + self.phase)


@pytest.mark.parametrize(
    ("hidden", "place", "within"),
    [
        (LIBRARY["bearing_cage"](amplitude=1e-3, order=0.451), "order", 0.01),
        (LIBRARY["mains_hum"](amplitude=5e-4, frequency=60.0), "frequency", 0.0),
    ],
)
def test_a_line_is_found_with_its_name_place_and_size(hidden, place, within):
    best = ranked(gauge_spectra(measured((hidden,), 1)), KINDS)[0]
    assert type(best.effect) is type(hidden)
    assert best.chance < 1e-6
    assert getattr(best.effect, place) == pytest.approx(getattr(hidden, place), abs=within)
    assert best.effect.amplitude == pytest.approx(hidden.amplitude, abs=4 * best.deviation)
    assert best.agrees > 0.001


def test_the_rounding_of_a_converter_makes_no_line():
    """Without noise it is not random: it has lines of its own, of less than half a step."""
    step, rounded = 3e-3, []
    for each in measured((), 1):
        signal = step * np.round(0.17 * np.cos(2 * each.channels["phi_in"]) / step)
        rounded.append(replace(each, channels={**each.channels, **dict.fromkeys(SENSORS, signal)}))
    found = search(gauge_spectra(rounded), KINDS, 0.005)
    assert found.named == found.unnamed == ()


def test_a_converter_that_noise_dithers_makes_no_lines_that_a_weak_one_could_hide_in():
    recordings = measured((LIBRARY["mains_hum"](amplitude=3e-4, frequency=60.0),), 2)
    step = NOISE / 2
    rounded = [
        replace(each, channels={**each.channels, **{s: step * np.round(each.channels[s] / step) for s in SENSORS}})
        for each in recordings
    ]
    assert ranked(gauge_spectra(rounded), KINDS)[0].rank > 0.9 * ranked(gauge_spectra(recordings), KINDS)[0].rank


def without_torque(recordings: list[Recording]) -> list[Recording]:
    return [replace(r, channels={n: v for n, v in r.channels.items() if n != "T_out"}) for r in recordings]


def test_a_line_is_named_without_the_torque():
    """A ball pass of an integer order is then all in the orders that were fitted, and says nothing."""
    recordings = without_torque(measured((LIBRARY["bearing_cage"](amplitude=1e-3, order=0.451),), 1))
    (found,) = search(gauge_spectra(recordings), [*KINDS, LIBRARY["ball_pass"]], 0.005).named
    assert found.effect.name() == "bearing_cage"


def test_a_line_is_found_in_long_recordings():
    """Their lines lie closer together than the values that an effect declares to be tried."""
    cage = LIBRARY["bearing_cage"](amplitude=3e-4, order=0.4437)
    recordings = measured((cage,), 9, POINTS[:2], revolutions=60)
    spectra = gauge_spectra(recordings)
    (found,) = search(spectra, KINDS[:1], 0.005).named
    assert found.effect.order == pytest.approx(0.4437, abs=0.002)
    # Declared, as found or as it was hidden, it is not found again.
    for declared in (found.effect, cage):
        rest = search(spectra, KINDS[:1], 0.005, [declared])
        assert rest.named == rest.unnamed == ()


def test_speed_need_not_be_the_one_that_was_set():
    """Orders are counted by the angle."""
    slow = [replace(point, n_in_rpm=0.97 * point.n_in_rpm) for point in POINTS]
    recordings = [
        replace(r, point=point) for r, point in zip(measured((Whistle(1e-3),), 10, slow), POINTS, strict=True)
    ]
    assert unnamed(gauge_spectra(recordings), 0.005).at == pytest.approx(5.37, abs=0.06)
    assert (
        unnamed(gauge_spectra([replace(r, point=p) for r, p in zip(measured((), 11, slow), POINTS, strict=True)]), 1e-3)
        is None
    )


def test_a_line_of_the_wrong_law_does_not_agree():
    """Hum at full load only is no hum."""
    calm, humming = (measured(e, 3) for e in ((), (LIBRARY["mains_hum"](amplitude=2e-3, frequency=50.0),)))
    mixed = [humming[i] if POINTS[i].T_out == 70 else calm[i] for i in range(len(POINTS))]
    best = next(line for line in ranked(gauge_spectra(mixed), KINDS) if line.effect.name() == "mains_hum")
    assert best.chance < 1e-6
    assert best.agrees < 1e-4


def test_size_is_covered_by_its_deviation():
    missed = []
    for seed in range(20):
        recordings = measured((LIBRARY["mains_hum"](amplitude=3e-4, frequency=50.0),), 100 + seed, POINTS[:2])
        best = ranked(gauge_spectra(recordings), KINDS[1:])[0]
        missed.append((best.effect.amplitude - 3e-4) / best.deviation)
    assert 0.8 <= np.mean(np.abs(missed) < 1.96) <= 1.0


def test_noise_has_no_lines():
    chance = np.array(
        [min(s.chance for s in ranked(gauge_spectra(measured((), 200 + i, POINTS[:2])), KINDS)) for i in range(20)]
    )
    # Under a uniform chance 0.4 and 2 of them.
    assert (chance <= 0.02).sum() <= 3
    assert (chance <= 0.1).sum() <= 7


def test_slow_noise_has_no_lines():
    """It rises just where the sub-harmonics lie."""
    kinds = [*KINDS, LIBRARY["sub_orders"]]
    recordings = [measured((), 400 + i, POINTS[::3], slow=2e-3) for i in range(8)]
    chance = np.array([min(line.chance for line in ranked(gauge_spectra(each), kinds)) for each in recordings])
    assert (chance <= 0.01).sum() <= 1
    assert not any(unnamed(gauge_spectra(each), 0.001) for each in recordings)


def quieter(recordings: list[Recording], gauge: str) -> list[Recording]:
    """The same where a gauge has all but no noise."""
    return [replace(r, channels={**r.channels, gauge: 1e-5 * r.channels[gauge]}) for r in recordings]


def test_a_line_at_an_integer_order_says_nothing():
    """Over whole revolutions nothing of it but rounding lies between the orders."""
    said = [
        each.explained([LIBRARY["ball_pass"](amplitude=1e-3, order=12.0)]) for each in gauge_spectra(measured((), 12))
    ]
    assert [(each.freedom, each.gain, each.own_gain) for each in said] == [(0, 0.0, 0.0)] * len(said)


@pytest.mark.parametrize("name", ["mains_hum", "bearing_cage"])
def test_a_pattern_is_what_the_orders_leave_of_the_signals(name):
    """Taking the orders out of its spectrum is the same; a hum leaves gauges silent."""
    (seen, *_), effect = gauge_spectra(measured((), 12)), LIBRARY[name](amplitude=1e-3)
    signals, Q = shapes(effect, seen.scene, seen.gauges), np.linalg.qr(ordinary(seen.scene))[0]
    lines = np.fft.rfft(signals - (signals @ Q) @ Q.T)[..., 1 : seen.scale.shape[1] + 1] / signals.shape[-1]
    clear = lines * seen.scale * seen.clear
    expected = np.concatenate([clear.real, clear.imag], axis=-1)[..., None]
    expected = (expected - seen.alone @ (seen.alone.swapaxes(1, 2) @ expected)).reshape(len(signals), -1)
    np.testing.assert_allclose(seen.pattern(effect), expected, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("heard", [list, lambda recordings: quieter(recordings, "s0")])
def test_the_ends_of_slow_noise_explain_no_line_better_than_noise_does(heard):
    """A spectrum rings with the step from a recording's end to its start; it had the gain of 14 times the noise."""
    cage = LIBRARY["bearing_cage"](amplitude=1e-3, order=0.455)
    said = [each.explained([cage]) for seed in range(8) for each in gauge_spectra(heard(measured((), seed, slow=0.02)))]
    gain, freedom = sum(each.gain for each in said), sum(each.freedom for each in said)
    # The mean of 96 numbers is good to 14 %.
    assert gain / freedom == pytest.approx(1, abs=0.4)


def test_a_grid_that_is_a_little_slow_is_still_one_in_long_recordings():
    """Of 60 revolutions: over their 1.8 s it slips by a third of a turn."""
    hum = LIBRARY["mains_hum"](5e-3, 50.0, deviation=-0.004)
    found = search(gauge_spectra(measured((hum,), 4, POINTS[:2], revolutions=60)), KINDS, 0.005)
    assert [line.effect.name() for line in found.named] == ["mains_hum"]
    assert found.named[0].effect.deviation == pytest.approx(-0.004, abs=0.001)
    assert found.unnamed == ()


def test_two_lines_are_found_one_after_the_other():
    cage, hum = LIBRARY["bearing_cage"](amplitude=1e-3, order=0.451), LIBRARY["mains_hum"](5e-4, 60.0)
    recordings = measured((cage, hum), 5)
    found = search(gauge_spectra(recordings), KINDS, 0.005)
    assert sorted(line.effect.name() for line in found.named) == ["bearing_cage", "mains_hum"]
    assert found.unnamed == ()


def test_a_hum_that_differs_from_cable_to_cable_and_its_harmonic_are_hum():
    """A line without a name explains more of it than a hum of all gauges or of one does."""
    hum = LIBRARY["mains_hum"]
    cables = [hum(size, 50.0, sensor=s) for s, size in ((1, 2e-3), (2, 1e-3), (4, 7e-4))]
    recordings = measured((*cables, hum(6e-4, 150.0, sensor=3), hum(3e-4, 150.0, sensor=2)), 5)
    found = search(gauge_spectra(recordings), KINDS, 0.005)
    assert [(line.effect.name(), line.effect.frequency) for line in found.named] == [
        ("mains_hum", 50), ("mains_hum", 150),
    ]  # fmt: skip
    assert found.unnamed == ()


def test_what_was_found_is_gone_from_the_spectra():
    recordings = measured((LIBRARY["mains_hum"](5e-3, 60.0, deviation=0.003),), 6)
    found = search(gauge_spectra(recordings), KINDS, 0.005)
    assert [line.effect.name() for line in found.named] == ["mains_hum"]
    noise = sum(float(each.left @ each.left) for each in gauge_spectra(measured((), 6)))
    assert found.named[0].gain > 1000
    assert sum(float(each.left @ each.left) for each in found.left) == pytest.approx(noise, rel=0.1)


def test_a_line_explains_as_much_between_two_lines_of_the_spectrum_as_on_one():
    revolutions = gauge_spectra(measured((), 7))[0].revolutions
    found = [
        unnamed(gauge_spectra(measured((Whistle(1e-3, (65 + off) / revolutions),), 7)), 0.005) for off in (0.0, 0.5)
    ]
    assert found[1].explained == pytest.approx(found[0].explained, rel=0.05)


def test_what_turns_with_the_circular_spline_is_no_line():
    """Twelve revolutions hardly tell it from order 2, beside which it leaks."""
    beating = (Whistle(0.02, 2 - 2 / 101), Whistle(0.01, 4 - 2 / 101), Whistle(0.01, 2 / 101))
    recordings = measured(beating, 9)
    found = search(gauge_spectra(recordings), KINDS[:1], 0.005)
    assert any(line.at == pytest.approx(2, abs=0.2) for line in found.unnamed)
    found = search(gauge_spectra(recordings, 100), KINDS, 0.005)
    assert found.named == found.unnamed == ()
    caged = gauge_spectra(measured((*beating, LIBRARY["bearing_cage"](2e-3, 0.451)), 9), 100)
    (cage,) = search(caged, KINDS[:1], 0.005).named
    assert cage.effect.order == pytest.approx(0.451, abs=0.01)


def in_one_gauge(whistle: Whistle, seed: int) -> list[Recording]:
    """Recordings in which s2 alone has a line."""
    loud, calm = measured((whistle,), seed), measured((), seed)
    return [replace(c, channels={**c.channels, "s2": w.channels["s2"]}) for w, c in zip(loud, calm, strict=True)]


def test_a_strong_line_of_one_gauge_is_not_called_by_names_that_explain_less():
    """At 2000 rpm order 3.7 lies where the mains' second harmonic may."""
    found = search(gauge_spectra(in_one_gauge(Whistle(1e-2, 3.7), 8)), KINDS, 0.005)
    assert found.named == ()
    assert found.unnamed[0].at == pytest.approx(3.7, abs=0.01)
    assert [part.effect.pattern for part in found.unnamed[0].parts] == ["in s2 alone"]


def leaked(recording: Recording, calm: Recording, order: int) -> float:
    """What a line puts on an order of s2, in its amplitude."""
    layout = Layout(("s2",))
    return abs(complex(layout.lines(features(recording, layout) - features(calm, layout))[0, order]))


def test_what_a_strong_line_leaks_into_the_orders_is_gone():
    recordings, calm = in_one_gauge(Whistle(3e-2, 3.7), 8), measured((), 8)
    effects = search(gauge_spectra(recordings), KINDS, 0.005).effects
    before = [leaked(each, none, 4) for each, none in zip(recordings, calm, strict=True)]
    after = [leaked(cleaned(each, effects), none, 4) for each, none in zip(recordings, calm, strict=True)]
    noise = NOISE * np.sqrt(2 / len(recordings[0].time))
    assert np.mean(before) > 20 * noise
    assert np.mean(after) < 4 * noise


def test_a_line_that_an_order_nearly_holds_leaves_no_more_behind_than_there_was():
    """Order 11.012 over 12 revolutions is a seventh of a line away: its neighbours differ by noise alone."""
    whistle = Whistle(1e-3, 11.012)
    recordings, calm = in_one_gauge(whistle, 8), measured((), 8)
    effects = [replace(whistle, amplitude=1.0, order=whistle.order + by) for by in (-0.005, 0, 0.005)]
    before = [leaked(each, none, 11) for each, none in zip(recordings, calm, strict=True)]
    after = [leaked(cleaned(each, effects), none, 11) for each, none in zip(recordings, calm, strict=True)]
    assert np.mean(before) > 0.9e-3
    assert np.mean(after) < 0.5 * np.mean(before)
