"""Units in names of columns and in rows of units, as people write them."""

import re

from swgsim.tables.units import FACTORS, SPELLINGS, STRAIN, known_unit

# The quantity of each unit, in the words of this room.
QUANTITIES = {"s": "time", "rad": "angle", "rad/s": "speed", "rpm": "speed", "N m": "torque", "A": "current",
              "mV/V": "gauge"}  # fmt: skip
# Units that no map has, which say what a column is not.
FOREIGN = {
    "°C": "temperature", "C": "temperature", "K": "temperature", "degC": "temperature", "N": "force", "bar": "pressure",
    "rad/s^2": "acceleration", "rad/s²": "acceleration", "deg/s^2": "acceleration", "°/s²": "acceleration",
    "°/s^2": "acceleration", "m/s²": "acceleration", "m/s^2": "acceleration", "g": "acceleration", "Hz": "rate",
    "W": "power", "uV": "voltage", "µV": "voltage",
}  # fmt: skip
# Besides those of the maps, where a name or a row of units says them.
MORE = {
    "Grad": "deg", "grad": "deg", "degree": "deg", "seconds": "s", "Sekunden": "s", "Sek": "s", "microstrain": "um/m",
    "ue": "um/m", "rads": "rad/s", "radps": "rad/s", "degps": "deg/s", "rad_s": "rad/s", "deg_s": "deg/s",
    "mrad_s": "mrad/s", "Grad/s": "deg/s", "rpm": "rpm", "upm": "rpm", "Upm": "rpm", "r/min": "rpm", "rev/min": "rpm",
    "um_m": "um/m", "mv_v": "mV/V", "uv_v": "uV/V", "v_v": "V/V", "nsec": "ns", "nsecs": "ns", "secs": "s",
    "msec": "ms", "usec": "us", "inc": "counts", "Inc": "counts", "cnt": "counts", "ticks": "counts",
    "inc/s": "counts/s", "nm": "N m", "mnm": "mN m", "amps": "A", "amp": "A", "Ampere": "A", "a": "A", "ma": "mA",
    "‰": "permille", "volt": "V", "mNm": "mN m", "revolutions": "rev", "Umdr": "rev", "ms": "ms", "strain": "um/m",
}  # fmt: skip
# A single letter at the end of a name is a unit behind these words only; else it may be the name of an axis.
SINGLE = {
    "s": {"t", "time", "stamp", "timestamp", "zeit", "elapsed", "clock"}, "v": {"u", "voltage", "out", "output", "sg"},
    "a": {"i", "iq", "q", "cur", "current", "strom", "motorstrom"}, "c": {"temp", "temperature", "temperatur"},
}  # fmt: skip
# At the end of a name behind an underscore, longer ones first.
SUFFIX = re.compile(
    r"(?i)_(mrad_s|rad_s|deg_s|radps|degps|rads|mv_v|uv_v|um_m|counts|permille|percent|rpm|mrad|rad|deg"
    r"|nsecs?|msec|usec|ms|us|ns|mnm|nm|ma|s|a|v|mv|c)$"
)
BRACKETS = re.compile(r"\s*[\[({<]\s*([^\[\](){}<>]*?)\s*[\])}>]\s*$")
IN_WORDS = re.compile(r"\s+in\s+(\S+)$")


def unit_in(text: str) -> str:
    """The unit that a text is, as the maps write it; the text itself if it is none of them.

    >>> unit_in("(µm/m)"), unit_in("[°]"), unit_in("U/min"), unit_in("Kanal")
    ('um/m', 'deg', 'rpm', 'Kanal')
    """
    bare = text.strip().strip("[](){}<>").strip()
    if known_unit(bare) in ALL:
        return known_unit(bare)
    if bare in FOREIGN:
        return bare
    return MORE.get(bare, MORE.get(bare.lower(), known_unit(bare)))


def is_unit(text: str) -> bool:
    """Whether a text is a unit, or the sign for none."""
    return text.strip("[]() ") in ("-", "1") or unit_in(text) in ALL or unit_in(text) in FOREIGN


def split_unit(name: str) -> tuple[str, str]:
    """A name of a column without its unit, and the unit; empty if it says none.

    >>> split_unit("Torque [Nm]"), split_unit("Winkel in °"), split_unit("joint_1_vel_rad_s"), split_unit("q[4]")
    (('Torque', 'N m'), ('Winkel', 'deg'), ('joint_1_vel', 'rad/s'), ('q[4]', ''))
    """
    for pattern in (BRACKETS, IN_WORDS, SUFFIX):
        found = pattern.search(name)
        if not found or not is_unit(found[1]) or found[1].isdigit():
            continue
        if pattern is not SUFFIX or len(found[1]) > 1 or not _is_axis(name):
            return name[: found.start()].strip(), unit_in(found[1])
    return name.strip(), ""


def _is_axis(name: str) -> bool:
    """Whether the single letter at the end of a name is more likely an axis than a unit.

    >>> _is_axis("pos_a"), _is_axis("motor_current_a")
    (True, False)
    """
    *words, last = re.findall(r"[a-z]+", name.lower())
    return last in SINGLE and not SINGLE[last] & set(words)


def quantity_of(unit: str) -> str:
    """The quantity of a unit, in the words of this room; empty for a unit of several, such as volts or counts."""
    if unit == STRAIN:
        return "gauge"
    if unit in FOREIGN:
        return FOREIGN[unit]
    if unit == "counts/s":
        return "speed"
    return next((QUANTITIES[target] for target, units in FACTORS.items() if unit in units), "")


ALL = {unit for units in FACTORS.values() for unit in units} | {
    STRAIN, "counts", "counts/s", "permille", "percent", "V", "mV", *SPELLINGS.values(),
}  # fmt: skip
