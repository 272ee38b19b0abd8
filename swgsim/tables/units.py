"""Units of columns: their factors to the unit of a quantity, and what a unit needs to have one."""

import re
from collections.abc import Mapping
from math import pi
from typing import Any

from swgsim.common.checks import require, require_known, require_one_of, require_positive
from swgsim.tables.file_defect import shown

# Unit of the quantity to unit of the column, and the factor between them.
FACTORS: Mapping[str, Mapping[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": pi / 180, "rev": 2 * pi},
    "rad/s": {"rad/s": 1.0, "mrad/s": 1e-3, "deg/s": pi / 180, "rpm": pi / 30, "rev/s": 2 * pi},
    "rpm": {"rpm": 1.0, "rad/s": 30 / pi, "mrad/s": 0.03 / pi, "deg/s": 1 / 6, "rev/s": 60.0},
    "N m": {"N m": 1.0, "mN m": 1e-3, "kN m": 1e3},
    "A": {"A": 1.0, "mA": 1e-3},
    "mV/V": {"mV/V": 1.0, "V/V": 1e3, "uV/V": 1e-3},
}
# Counts of an encoder need the counts of one revolution.
COUNTS: Mapping[str, tuple[str, str]] = {"rad": ("counts", "rev"), "rad/s": ("counts/s", "rev/s"),
                                         "rpm": ("counts/s", "rev/s")}  # fmt: skip
# Strain needs the gauge factor and the active arms of its bridge.
STRAIN = "um/m"
# Shares need the rated value that they are of.
SHARES: Mapping[str, float] = {"permille": 1e-3, "percent": 1e-2}
# Output of an amplifier or a converter needs its full scale.
OUTPUTS = ("V", "mV", "counts")
# As people write them.
SPELLINGS: Mapping[str, str] = {
    "°": "deg", "degrees": "deg", "°/s": "deg/s", "1/min": "rpm", "U/min": "rpm", "min-1": "rpm", "min^-1": "rpm",
    "Nm": "N m", "N*m": "N m", "N·m": "N m", "mNm": "mN m", "kNm": "kN m", "µs": "us", "μs": "us", "sec": "s",
    "µV/V": "uV/V", "μV/V": "uV/V", "µm/m": "um/m", "μm/m": "um/m", "ustrain": "um/m", "µε": "um/m", "‰": "permille",
    "%": "percent", "1/s": "rev/s", "rps": "rev/s", "U": "rev", "turns": "rev", "radians": "rad",
}  # fmt: skip
FULL_SCALE = re.compile(r"\s*([^\s=]+)\s+([^=]+?)\s*=\s*([^\s=]+)\s+([^=]+?)\s*")


def known_unit(unit: str) -> str:
    """A unit as this project writes it.

    >>> known_unit("µV/V"), known_unit("deg")
    ('uV/V', 'deg')
    """
    return SPELLINGS.get(unit.strip(), unit.strip())


def units_of(target: str) -> list[str]:
    """All units of a column whose quantity has a unit."""
    counts = [COUNTS[target][0]] if target in COUNTS else []
    strain = [STRAIN] if target == "mV/V" else []
    shares = list(SHARES) if target in ("N m", "A", "rad/s", "rpm") else []
    return list(dict.fromkeys([*FACTORS[target], *counts, *strain, *shares, *(OUTPUTS if target != "s" else ())]))


def unit_factor(
    owner: str,
    target: str,
    unit: str,
    *,
    per_revolution: Any = None,
    rated: Any = None,
    full_scale: Any = None,
    gauge_factor: Any = None,
    active_arms: Any = None,
) -> float:
    """Factor from the unit of a column to that of its quantity.

    Parameters
    ----------
    owner : str
        The quantity, for messages.
    target : str
        Unit of the quantity, a key of :data:`FACTORS`.
    unit : str
    per_revolution : float, optional
        Counts of one revolution.
    rated : float or str, optional
        Value of which a column is a share: a number in the unit of the quantity, or a text such as ``"2.4 A"``.
    full_scale : str, optional
        What an output stands for, such as ``"10 V = 2 mV/V"``.
    gauge_factor, active_arms : float and int, optional
        Of a bridge that is given as strain.

    Raises
    ------
    ValueError
        If the unit is unknown, or lacks what it needs.

    Examples
    --------
    >>> unit_factor("q", "rad", "counts", per_revolution=4096) * 4096 / pi
    2.0
    >>> unit_factor("s1", "mV/V", "V", full_scale="10 V = 2 mV/V")
    0.2
    """
    unit = known_unit(unit)
    require_known(f"the unit of {owner}", [unit], units_of(target))
    needs = {"per_revolution": per_revolution, "rated": rated, "full_scale": full_scale,
             "gauge_factor": gauge_factor, "active_arms": active_arms}  # fmt: skip
    given = {name for name, value in needs.items() if value is not None}
    if full_scale is not None and given == {"full_scale"}:
        return _full_scale(owner, target, unit, full_scale)
    if unit in FACTORS[target]:
        needed: set[str] = set()
    elif unit == STRAIN:
        needed = {"gauge_factor", "active_arms"}
    elif unit in SHARES:
        needed = {"rated"}
    else:
        needed = {"per_revolution"} if unit == COUNTS.get(target, ("",))[0] else {"full_scale"}
    if given != needed:
        example = {"full_scale": "'10 V = 2 mV/V'", "per_revolution": "4096", "rated": "'2.4 A'"}
        must = ", ".join(f"{name}: {example.get(name, '2')}" for name in sorted(needed))
        more = f"needs such as {must}" if needed - given else "has no use for " + ", ".join(sorted(given - needed))
        raise ValueError(f"{owner} in {unit} {more}")
    if unit in FACTORS[target]:
        return FACTORS[target][unit]
    if unit == STRAIN:
        return bridge_factor(owner, gauge_factor, active_arms)
    if unit in SHARES:
        return SHARES[unit] * _rated(owner, target, rated)
    require_positive(owner, per_revolution=per_revolution)
    return FACTORS[target][COUNTS[target][1]] / per_revolution


def bridge_factor(owner: str, gauge_factor: Any, active_arms: Any) -> float:
    """Bridge signal [mV/V] per strain [um/m] of each active arm: k / 4 for one arm.

    >>> bridge_factor("s1", 2.0, 4)
    0.002
    """
    require(owner, "gauge_factor", gauge_factor, low=0.5, high=300)
    require_one_of(owner, "active_arms", active_arms, (1, 2, 4))
    return gauge_factor / 4 * active_arms * 1e-3


def _rated(owner: str, target: str, rated: Any) -> float:
    """A rated value in the unit of its quantity."""
    if isinstance(rated, str):
        number, _, unit = rated.strip().partition(" ")
        require_known(f"the unit of rated of {owner}", [known_unit(unit)], FACTORS[target])
        return _number(owner, "rated", number) * FACTORS[target][known_unit(unit)]
    require_positive(owner, rated=rated)
    return float(rated)


def _full_scale(owner: str, target: str, unit: str, text: Any) -> float:
    """Factor from an output to its quantity."""
    found = FULL_SCALE.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise ValueError(f"full_scale of {owner} is {shown(text)}, must be such as '10 V = 2 mV/V'")
    output, of, value, meant = found.groups()
    if known_unit(of) != unit:
        raise ValueError(f"full_scale of {owner} is in {of}, and its column in {unit}: give both in the same unit")
    require_known(f"the unit of full_scale of {owner}", [known_unit(meant)], FACTORS[target])
    scale = _number(owner, "full_scale", value) * FACTORS[target][known_unit(meant)]
    return scale / _number(owner, "full_scale", output)


def _number(owner: str, name: str, text: str) -> float:
    """A number above 0 from text."""
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{name} of {owner} has {shown(text)}, must have a number") from None
    require_positive(owner, **{name: number})
    return number
