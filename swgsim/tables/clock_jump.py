"""Why a time runs back: a counter that was full, midnight, or another recording."""

from swgsim.tables.units import FACTORS

# Counters of controllers.
BITS = (16, 32)
# A step back is shorter than the period by one step of the clock.
PERIOD_TOLERANCE = 0.01
DAY = 86400.0


def bits_of(back: float) -> int:
    """Bits of a counter that begins anew after so many ticks; 0 if it is no such number.

    >>> bits_of(2**32 - 4000), bits_of(1000)
    (32, 0)
    """
    return next((bits for bits in BITS if abs(back / 2**bits - 1) < PERIOD_TOLERANCE), 0)


def jump_remedy(back: float) -> str:
    """What to do about a time that runs back by so many seconds.

    >>> jump_remedy(4294.96)
    'the counter of us was full: set bits: 32 in the time of a map'
    """
    for unit in ("ns", "us", "ms"):
        if bits := bits_of(back / FACTORS["s"][unit]):
            return f"the counter of {unit} was full: set bits: {bits} in the time of a map"
    if abs(back / DAY - 1) < PERIOD_TOLERANCE:
        return "the time passes midnight: give its stamps with the date, or as a format such as '%H:%M:%S.%f'"
    if back > 0:
        return (
            "use a clock that always increases; for several recordings in one file, see each and rows (docs/formats.md)"
        )
    return "use a clock that always increases, or write the time with more digits"
