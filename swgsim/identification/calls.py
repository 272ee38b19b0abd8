"""The two calls of an identification: commission a unit, then identify what the model of the unit lacks."""

import logging
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from threadpoolctl import threadpool_limits

from swgsim.effects.base import Effect
from swgsim.effects.library import SEARCHED
from swgsim.gear.gear import Gear
from swgsim.identification.commissioning.commissioning import learn_unit
from swgsim.identification.data.angle_zero import from_zero, require_same_zero, zero_defects, zero_of
from swgsim.identification.data.features import COMPARED
from swgsim.identification.data.gauge_order import order_defects
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.unit import Unit
from swgsim.identification.interharmonics.interharmonic_spectrum import gauge_spectra
from swgsim.identification.interharmonics.line_search import all_cleaned, lines_of_healthy
from swgsim.identification.interharmonics.named_interharmonics import has_sidelines
from swgsim.identification.report.answer import answer
from swgsim.identification.report.identification import Identification
from swgsim.identification.report.interest import INTEREST
from swgsim.identification.report.next_experiment import next_experiments
from swgsim.identification.report.report_fields import report
from swgsim.identification.search.screening import ALPHA
from swgsim.recordings.checks.across import session_defects
from swgsim.recordings.read import require_usable
from swgsim.recordings.recording import Recording
from swgsim.recordings.recording_set import RecordingSet

STEPS = logging.getLogger("swgsim.identification")
Progress = Callable[[str], None]


@threadpool_limits.wrap(limits=1)  # so that bytes do not depend on the number of cores
def commission(
    recordings: Iterable[Recording], gear: Gear, *, declared: Sequence[Effect] = (), progress: Progress | None = None
) -> Unit:
    """Learn a unit from recordings of its healthy state.

    Parameters
    ----------
    recordings : iterable of Recording
        Of one healthy gear: all operating points, three repeats or more.
    gear : Gear
        The nominal gear.
    declared : sequence of Effect
        Effects that the model has from the start.
    progress : callable, optional
        Receives a line of text at each step, such as ``print``.

    Raises
    ------
    ValueError
        If recordings are of several gears, lack a channel, or do not fit the nominal gear at all.
    """
    with _steps_to(progress):
        healthy = require_comparable(tuple(recordings), "recordings of the healthy gear")
        unit = nominal_unit(gear, declared)
        unit = replace(unit, zero=zero_of(healthy, unit.model))
        healthy = from_zero(healthy, unit.zero)
        STEPS.info("searching interharmonic lines in %d recordings", len(healthy))
        N = gear.transmission.N
        lines = lines_of_healthy(gauge_spectra(healthy, N), ALPHA, unit.interharmonics)
        STEPS.info("commissioning on %d recordings", len(healthy))
        learned = learn_unit(Measured.of(all_cleaned(healthy, lines.effects, N)), unit)
        return replace(learned, healthy=healthy, lines=lines.usual_effects)


@threadpool_limits.wrap(limits=1)
def identify(
    recordings: Iterable[Recording],
    unit: Unit | Gear,
    *,
    effects: Sequence[type[Effect]] | None = None,
    interest: float = INTEREST,
    seed: int = 0,
    progress: Progress | None = None,
) -> Identification:
    """Find what the model of a unit lacks.

    Parameters
    ----------
    recordings : iterable of Recording
        Of one gear. Channels that the commissioning did not have are ignored. A
        :class:`~swgsim.recordings.recording_set.RecordingSet` adds its warnings and its source to the report.
    unit : Unit or Gear
        A unit from :func:`commission`; or a nominal gear, if there are no recordings of the healthy state.
    effects : sequence of effect classes, optional
        The library that is searched; by default all effects.
    interest : float
        Smallest change that matters, in standard deviations of an order line over healthy units of a series.
    seed : int
        Of the simulated noise from which p-values are computed.
    progress : callable, optional
        Receives a line of text at each step, such as ``print``.

    Raises
    ------
    ValueError
        If recordings cannot be compared with the unit; the message says what to change.
    """
    start = time.perf_counter()
    kinds = SEARCHED if effects is None else tuple(effects)
    read = recordings if isinstance(recordings, RecordingSet) else RecordingSet(tuple(recordings))
    source = read.source or "recordings"
    given = require_comparable(read.recordings, source)
    if isinstance(unit, Gear):
        unit = nominal_unit(unit)
    with _steps_to(progress):
        if unit.healthy:
            given = _of_unit(given, unit, source)
        else:
            unit = replace(unit, zero=zero_of(given, unit.model))
            given = from_zero(given, unit.zero)
        found = answer(given, unit, kinds, known=unit.interharmonics, interest=interest, seed=seed)
        STEPS.info("report: next experiments")
        experiments = next_experiments(found)
        warnings = (*read.defects, *zero_defects(given, unit.zero), *session_defects(given, unit.healthy))
        seconds = time.perf_counter() - start
        return Identification(found, report(found, kinds, experiments, warnings, seconds, source))


def nominal_unit(gear: Gear, declared: Sequence[Effect] = ()) -> Unit:
    """A unit of which only the nominal gear and declared effects are known."""
    interharmonics = tuple(effect for effect in declared if has_sidelines(type(effect)))
    model = Model(gear, tuple(effect for effect in declared if effect not in interharmonics))
    return Unit(model, interharmonics=interharmonics)


def require_comparable(recordings: tuple[Recording, ...], source: str) -> tuple[Recording, ...]:
    """The recordings, if they are of one gear and have the channels that an identification needs.

    Raises
    ------
    ValueError
        Otherwise; the message begins with ``source``.
    """
    if not recordings:
        raise ValueError(f"{source}: no recordings, give at least one")
    gears = list(dict.fromkeys(recording.gear for recording in recordings))
    if len(gears) > 1:
        raise ValueError(
            f"{source} holds recordings of the gears {', '.join(gears)}: identification needs one gear, put each into "
            "a folder of its own"
        )
    channels = recordings[0].channels
    if "phi_in" not in channels:
        raise ValueError(
            f"{source} has no phi_in_rad, the angle of the wave generator, against which everything is compared: "
            "record it, or integrate the speed from an index pulse"
        )
    if not set(channels) & set(COMPARED):
        raise ValueError(f"{source} has no channel besides the angle: record at least one of {', '.join(COMPARED)}")
    return recordings


def require_same_gear(recordings: Sequence[Recording], healthy: Sequence[Recording]) -> None:
    """Raise a ValueError if the gears differ, or if a recording is in both."""
    one, other = recordings[0].gear, healthy[0].gear
    if one != other:
        raise ValueError(
            f"the recordings are of gear {one!r}, those of the commissioning of {other!r}: commission the "
            "same gear, or correct the name in the manifest"
        )
    common = [name for name in recordings[0].channels if name in healthy[0].channels]
    names = {each.numbers: each.name for each in with_channels(healthy, common)}
    for each in with_channels(recordings, common):
        if each.numbers in names:
            raise ValueError(
                f"recording {each.name} is also in the commissioning, as {names[each.numbers]}: its effects would be "
                "learned as healthy, give recordings of the healthy state"
            )


def with_channels(recordings: Sequence[Recording], names: Iterable[str]) -> tuple[Recording, ...]:
    """The recordings with these of their channels only."""
    names = list(names)
    return tuple(
        replace(each, channels={name: each.channels[name] for name in names if name in each.channels})
        for each in recordings
    )


def _of_unit(recordings: Sequence[Recording], unit: Unit, source: str) -> tuple[Recording, ...]:
    """The recordings with the channels and the zero of the angle of a commissioned unit.

    Raises
    ------
    ValueError
        If they are of another gear, lack a channel, have another zero of the angle, or gauges were exchanged.
    """
    channels = unit.healthy[0].channels
    missing = [name for name in channels if name not in recordings[0].channels]
    if missing:
        raise ValueError(
            f"{source} has no {', '.join(missing)}, which the unit was commissioned with: record the same channels, or "
            "commission with fewer"
        )
    given = from_zero(with_channels(recordings, channels), unit.zero)
    require_same_gear(given, unit.healthy)
    require_same_zero(Path(source), given, unit.model)
    require_usable(Path(source), order_defects(given, unit.healthy))
    return given


@contextmanager
def _steps_to(progress: Progress | None) -> Iterator[None]:
    """Hand every step that the identification logs to a callable; without one, steps go where logging sends them."""
    if progress is None:
        yield
        return
    handler = logging.Handler()
    handler.emit = lambda record: progress(record.getMessage())  # type: ignore[method-assign]
    level, propagate = STEPS.level, STEPS.propagate
    STEPS.addHandler(handler)
    STEPS.setLevel(logging.INFO)
    STEPS.propagate = False
    try:
        yield
    finally:
        STEPS.removeHandler(handler)
        STEPS.setLevel(level)
        STEPS.propagate = propagate
