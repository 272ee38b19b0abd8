"""A line between the orders without a name: its pattern over the gauges, its law, and the effect that it is."""

from dataclasses import replace

import numpy as np
import pytest
from loop_fixtures import POINTS
from sideline_fixtures import measured

from swgsim.conditions import Conditions
from swgsim.effects.base import Effect, Scene
from swgsim.effects.fixed_frequency import HIGHEST, FixedFrequency
from swgsim.effects.fractional_order import FractionalOrder
from swgsim.effects.library import LIBRARY
from swgsim.effects.line_between import LineBetween
from swgsim.effects.text import as_text, from_text
from swgsim.loop.between import between
from swgsim.loop.lines import search
from swgsim.loop.unnamed import Unnamed

KINDS = [LIBRARY["bearing_cage"], LIBRARY["mains_hum"]]
ROUND = "one wave that turns with the wave generator (or three against it)"
LINES = {
    "by load": FractionalOrder(2e-3, 0.0, "opposite in s1 and s3", "proportional to the load", 5.37),
    "by speed": FixedFrequency(2e-3, 0.0, "in s2 alone", "with the square of the speed", 217.0),
    "travelling": FractionalOrder(1e-3, 0.0, ROUND, "with the root of the load", 3.4),
    "both": FixedFrequency(2e-3, 0.0, "opposite in neighbours (two waves)", "proportional to load and speed", 91.0),
}


def found(effects: tuple[Effect, ...], seed: int, points=POINTS, known: tuple[Effect, ...] = ()) -> tuple[Unnamed, ...]:
    """Lines without a name, and none with one."""
    lines = search(between(measured(effects, seed, points)), KINDS, 0.005, known)
    assert lines.named == ()
    return lines.unnamed


@pytest.mark.parametrize("name", LINES)
def test_pattern_law_and_size_are_told(name):
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


@pytest.mark.parametrize("name", LINES)
def test_what_is_told_can_be_declared(name):
    """Written, read and given back, nothing of it is left; nor with the line that was hidden."""
    (line,) = found((LINES[name],), 2)
    told = from_text(as_text([part.effect for part in line.parts]), "answer")
    assert told == tuple(part.effect for part in line.parts)
    for declared in (told, (LINES[name],)):
        assert found((LINES[name],), 2, known=declared) == ()


def test_gauges_of_no_common_phase_are_told_one_by_one():
    loud, quiet = (FractionalOrder(a, 0.0, f"in {s} alone", order=5.37) for a, s in ((5e-3, "s3"), (2e-3, "s0")))
    (line,) = found((loud, quiet), 3)
    assert [part.effect.pattern for part in line.parts] == ["in s3 alone", "in s0 alone"]
    assert [part.effect.amplitude for part in line.parts] == pytest.approx([5e-3, 2e-3], rel=0.2)
    assert "in 2 gauges of no common phase, most of it in s3 alone" in str(line)


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
        FixedFrequency(1e-3, frequency=2 * HIGHEST)
    assert issubclass(FractionalOrder, LineBetween)
