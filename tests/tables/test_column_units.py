"""Units: each factor, what a unit needs, and messages for what has no sense."""

from math import pi
from typing import Any

import numpy as np
import pytest

from swgsim.tables.clock import read_clock
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.measured_column import read_column
from swgsim.tables.units import FACTORS, SPELLINGS, unit_factor, units_of

KNOWN: tuple[tuple[str, str, dict[str, Any], float], ...] = (
    ("rad", "°", {}, pi / 180),
    ("rad", "counts", {"per_revolution": 4194304}, 2 * pi / 4194304),
    ("rpm", "counts/s", {"per_revolution": 60}, 1.0),
    ("rad/s", "1/min", {}, pi / 30),
    ("A", "permille", {"rated": "2400 mA"}, 2.4e-3),
    ("N m", "%", {"rated": 50}, 0.5),
    ("mV/V", "V", {"full_scale": "10 V = 2 mV/V"}, 0.2),
    ("N m", "mV", {"full_scale": "5000 mV = 1 kN m"}, 0.2),
    ("mV/V", "counts", {"full_scale": "32768 counts = 3.2768 mV/V"}, 1e-4),
    ("mV/V", "µm/m", {"gauge_factor": 2.0, "active_arms": 4}, 0.002),
)


@pytest.mark.parametrize(("target", "unit", "needs", "factor"), KNOWN)
def test_a_unit_has_its_factor(target: str, unit: str, needs: dict[str, Any], factor: float) -> None:
    assert unit_factor("x", target, unit, **needs) == pytest.approx(factor, rel=1e-12)
    if needs:
        with pytest.raises(ValueError, match=rf"x in .* needs such as .*{next(iter(needs))}"):
            unit_factor("x", target, unit)


def test_spellings_are_of_known_units() -> None:
    known = {unit for target in FACTORS for unit in units_of(target)}
    assert set(SPELLINGS.values()) <= known


BAD: tuple[tuple[dict[str, Any], str], ...] = (
    ({"unit": "bar"}, "unknown choice 'bar' of the unit of x"),
    ({"unit": "mV/V", "rated": 3}, "x in mV/V has no use for rated"),
    ({"unit": "V", "full_scale": "10 = 2"}, "must be such as '10 V = 2 mV/V'"),
    ({"unit": "V", "full_scale": "10 mV = 2 mV/V"}, "is in mV, and its column in V"),
    ({"unit": "V", "full_scale": "0 V = 2 mV/V"}, "full_scale of x is 0"),
    ({"unit": "V", "full_scale": "ten V = 2 mV/V"}, "has 'ten', must have a number"),
    ({"unit": "mV/V", "factor": 0}, "factor of x is 0"),
    ({"unit": "mV/V", "wraps": True}, "unknown choice 'wraps' of x"),
    ({"unit": "mV/V", "inverted": "yes"}, "inverted of x is 'yes', must be true or false"),
    ({"unit": "um/m", "gauge_factor": 2.0, "active_arms": 3}, "must be one of 1, 2, 4"),
)


@pytest.mark.parametrize(("entry", "message"), BAD)
def test_an_entry_without_sense_is_named(entry: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_column("x", {"column": "a"} | entry, "mV/V")


def test_a_value_is_factor_times_number_plus_offset_in_its_unit() -> None:
    column = read_column("q", {"column": "a", "unit": "deg", "factor": 2, "offset": 10, "inverted": True}, "rad")
    np.testing.assert_allclose(column.values(np.array([0, 85])), [-pi / 18, -pi])


def test_an_angle_wraps_at_the_revolution_of_its_numbers() -> None:
    angle = np.linspace(0, 9 * pi, 200)
    entry = {"column": "a", "unit": "counts", "per_revolution": 1000, "wraps": True}
    column = read_column("q", entry, "rad")
    np.testing.assert_allclose(column.values(angle / (2 * pi) * 1000 % 1000), angle, atol=1e-9)


def test_joints_that_follow_one_another_are_told_apart() -> None:
    column = read_column("q", {"column": 2, "unit": "rad"}, "rad", interleaved=3)
    assert column.place == 1
    np.testing.assert_array_equal(column.own(np.arange(12)), [1, 4, 7, 10])
    np.testing.assert_array_equal(column.own(np.arange(10)), [1, 4, 7, np.nan])  # the recording was cut: a lost reading
    with pytest.raises(ValueError, match="must be an integer from 1 to 3"):
        read_column("q", {"column": 4, "unit": "rad"}, "rad", interleaved=3)


def test_stamps_lose_no_digits() -> None:
    clock = read_clock({"columns": ["s", "ns"], "units": ["s", "ns"]})
    read = {"s": np.array([1750000000, 1750000001]), "ns": np.array([999_999_999, 1])}
    np.testing.assert_allclose(clock.seconds(read, "log"), [0, 2e-9 + 0], atol=1e-15)
    stamps = {"t": np.array(["2026-03-12T10:22:31.000001", "2026-03-12T11:22:31.000002+01:00"], object)}
    np.testing.assert_allclose(read_clock({"column": "t", "unit": "iso"}).seconds(stamps, "log"), [0, 1e-6], atol=1e-12)
    with pytest.raises(FileDefect, match="column t: found 'noon', expected a time stamp by ISO 8601"):
        read_clock({"column": "t", "unit": "iso"}).seconds({"t": np.array(["noon"], object)}, "log")
    with pytest.raises(ValueError, match="give one of the two pairs"):
        read_clock({"column": "t", "unit": "s", "columns": ["a"], "units": ["s"]})
    with pytest.raises(ValueError, match="unknown choice 'fortnight' of the unit of time"):
        read_clock({"column": "t", "unit": "fortnight"})


def test_a_clock_goes_on_after_midnight_and_a_counter_when_it_is_full() -> None:
    of_day = {"t": np.array(["23:59:59.5", "NaN", "00:00:00.3", "00:00:00.2"], object)}
    clock = read_clock({"column": "t", "unit": "%H:%M:%S.%f"})
    np.testing.assert_allclose(clock.seconds(of_day, "log"), [0, np.nan, 0.8, 0.7])  # a step back stays one
    dated = {"d": np.array(["1.3.2026", "2.3.2026"], object), "t": np.array(["23:59:59", "00:00:01"], object)}
    clock = read_clock({"columns": ["d", "t"], "units": ["%d.%m.%Y", "%H:%M:%S"]})
    np.testing.assert_allclose(clock.seconds(dated, "log"), [0, 2])
    counter = {"t": np.array([2**16 - 2, 2**16 - 1, 1, 2], np.uint16)}
    np.testing.assert_allclose(
        read_clock({"column": "t", "unit": "ms", "bits": 16}).seconds(counter, "log"), [0, 0.001, 0.003, 0.004]
    )
