"""A line between the orders without a name: its pattern over the gauges, its law, and the effect that it is."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import POINTS
from sideline_fixtures import measured

from swgsim.effects.base import Effect, Scene
from swgsim.effects.library import LIBRARY
from swgsim.effects.line_between import GAUGE_PATTERNS, FixedFrequency, FractionalOrder
from swgsim.effects.text import as_text, from_text
from swgsim.gear.conditions import Conditions
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_pattern import distinct_patterns
from swgsim.identification.interharmonics.line_search import search
from swgsim.identification.interharmonics.unattributed_lines import Unnamed
from swgsim.storage.labelled_signals import SENSORS

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]

KINDS = [LIBRARY["bearing_cage"]]
ROUND = "one wave that turns with the wave generator (or three against it)"
LINES = {
    "by load": FractionalOrder(2e-3, 0.0, "opposite in s1 and s3", "proportional to the load", 5.37),
    "by speed": FixedFrequency(2e-3, 0.0, "in s2 alone", "with the square of the speed", 217.0),
    "travelling": FractionalOrder(1e-3, 0.0, ROUND, "with the root of the load", 3.4),
    "both": FixedFrequency(2e-3, 0.0, "opposite in neighbours (two waves)", "proportional to load and speed", 91.0),
}


def found(effects: tuple[Effect, ...], seed: int, points=POINTS, known: tuple[Effect, ...] = ()) -> tuple[Unnamed, ...]:
    """Lines without a name, and none with one."""
    lines = search(gauge_spectra(measured(effects, seed, points)), KINDS, 0.005, known)
    assert lines.named == ()
    return lines.unnamed


@pytest.mark.parametrize("name", LINES)
def test_pattern_law_and_size_are_found_and_can_be_declared(name):
    hidden = LINES[name]
    (line,) = found((hidden,), 1)
    (part,) = line.parts
    assert (type(part.effect), part.effect.pattern) == (type(hidden), hidden.pattern)
    assert hidden.law in (part.effect.law, *part.rivals)
    assert len(part.rivals) <= 1
    place = {"order": 0.03, "frequency": 2.0}[line.kind]
    assert line.at == pytest.approx(getattr(hidden, line.kind), abs=place)
    assert part.effect.amplitude == pytest.approx(hidden.amplitude, rel=0.15 if part.effect.law == hidden.law else 0.5)
    assert hidden.pattern in str(line)
    assert hidden.law in str(line)
    # Written, read and declared, nothing of it is found again; nor with the line that was hidden.
    estimated = from_text(as_text([part.effect for part in line.parts]), "answer")
    assert estimated == tuple(part.effect for part in line.parts)
    for declared in (estimated, (hidden,)):
        assert found((hidden,), 1, known=declared) == ()


@pytest.mark.parametrize("quieter", [2.5, 10.0])
def test_gauges_of_no_common_phase_are_told_one_by_one(quieter):
    """A line in one is no noise beside that of another."""
    sizes = {"s3": 2e-2, "s0": 2e-2 / quieter}
    hidden = tuple(FractionalOrder(size, 0.0, f"in {sensor} alone", order=5.37) for sensor, size in sizes.items())
    (line,) = found(hidden, 3)
    assert [part.effect.pattern for part in line.parts] == ["in s3 alone", "in s0 alone"]
    assert [part.effect.amplitude for part in line.parts] == pytest.approx(list(sizes.values()), rel=0.1)
    assert "in s3, constant, amplitude" in str(line)
    assert str(line).endswith("; smaller, and in no simple pattern with it, in s0")
    assert found(hidden, 3, known=tuple(part.effect for part in line.parts)) == ()


def test_a_gauge_beside_a_pattern_is_told_too():
    opposite, beside = LINES["by load"], FractionalOrder(4e-4, 0.0, "in s0 alone", order=5.37)
    (line,) = found((opposite, beside), 8)
    assert [part.effect.pattern for part in line.parts] == [opposite.pattern, "in s0 alone"]


def test_patterns_are_those_that_the_recorded_gauges_tell_apart():
    assert distinct_patterns(SENSORS) == list(GAUGE_PATTERNS)
    assert distinct_patterns(["s1", "s3"]) == [
        "opposite in s1 and s3", "in s1 alone", "in s3 alone", "the same in s1 to s4",
    ]  # fmt: skip


def test_a_gauge_that_was_not_recorded_hides_no_pattern():
    recordings = measured((FractionalOrder(1e-3, order=5.37),), 6)
    without = [replace(r, channels={n: v for n, v in r.channels.items() if n != "s4"}) for r in recordings]
    (line,) = search(gauge_spectra(without), KINDS, 0.005).unnamed
    assert [part.effect.pattern for part in line.parts] == ["the same in all gauges"]


@pytest.mark.parametrize("line", [FractionalOrder(3e-2, order=5.3712), FixedFrequency(3e-2, frequency=217.3)])
def test_what_is_told_can_be_declared_of_long_recordings(line):
    """Their lines lie closer together than a hundredth of what is searched."""
    spectra = gauge_spectra(measured((line,), 7, POINTS[::3], revolutions=120))
    (told,) = search(spectra, KINDS, 0.005).unnamed
    assert search(spectra, KINDS, 0.005, [part.effect for part in told.parts]).unnamed == ()


def test_one_operating_point_tells_no_law():
    alike = [replace(POINTS[2], T_out=POINTS[2].T_out + 1e-3 * i) for i in range(4)]  # of other noise each
    (line,) = found((LINES["travelling"],), 4, alike)
    assert line.parts[0].effect.law == "constant"
    assert "with the root of the load" in line.parts[0].rivals


@pytest.mark.parametrize("kind", [FractionalOrder, FixedFrequency])
def test_a_line_turns_with_the_angle_or_with_time(kind):
    point, conditions = POINTS[-1], Conditions(temperature=45.0)
    time = np.linspace(0, 0.1, 500)
    phi = point.omega_in * time + 0.3 * np.sin(point.omega_in * time)
    scene = Scene(time, phi, np.full(500, point.T_out), point, conditions)
    line = kind(1e-3, 0.4, "opposite in s1 and s3", "proportional to the temperature above 25 degC")
    silent = dict.fromkeys(("phi_in", "T_out", "s0", "s1", "s2", "s3", "s4"), np.zeros(500))
    seen = line.acquisition(silent, scene)
    angle = 0.5 * phi if kind is FractionalOrder else 2 * np.pi * 25.0 * time
    np.testing.assert_allclose(seen["s1"], 2e-3 * np.cos(angle - 0.4), atol=1e-15)
    np.testing.assert_allclose(seen["s3"], -seen["s1"])
    assert not any(seen[name].any() for name in ("phi_in", "T_out", "s0", "s2", "s4"))


def test_bad_lines_are_refused():
    with pytest.raises(ValueError, match=r"unknown choice 'in T_in alone' of pattern of fractional order; choose from"):
        FractionalOrder(1e-3, pattern="in T_in alone")
    with pytest.raises(ValueError, match="unknown choice 'cubic' of law of fixed frequency; choose from"):
        FixedFrequency(1e-3, law="cubic")
    with pytest.raises(ValueError, match="frequency"):
        FixedFrequency(1e-3, frequency=5000.0)
