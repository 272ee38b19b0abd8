"""The diagnosis of a unit: loop and twin in one call."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from swgsim.chain.chain import SECTORS
from swgsim.common.checks import require, require_known
from swgsim.common.files import write_json, write_text
from swgsim.common.seeds import generator
from swgsim.dataset.faults import FAULTS
from swgsim.effects.base import Effect
from swgsim.gear.gear import Gear
from swgsim.identification.calls import Progress, commission, identify, nominal_unit
from swgsim.identification.data.measured import Measured
from swgsim.identification.decide.prior import HEALTHY
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import extended, fit
from swgsim.identification.fit.unit import Unit
from swgsim.identification.report.identification import Identification
from swgsim.oracle.cells import Partition, Resolution
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin.costs import Costs, costs_with
from swgsim.twin.diagnosis_report import page, report_of
from swgsim.twin.fault_posterior import Suspected, lack_of_fit

# Least and largest size of each fault, between which all are equally probable: from what hardly matters to what breaks.
SIZES: Mapping[str, tuple[float, float]] = {
    "reduced_damping": (0.5, 0.99),
    "reduced_stiffness": (0.7, 0.995),
    "eccentric_wave_generator": (2e-6, 100e-6),
    "root_tooth_crack": (0.01, 0.5),
    "tip_tooth_crack": (0.05, 1.0),
}
# Most gears that are examined are healthy; the faults share the rest.
PRIOR = {"healthy": HEALTHY, **dict.fromkeys(FAULTS, (1 - HEALTHY) / len(FAULTS))}
FALSE_ALARMS = 0.01
# A root crack has more cells, as its change grows with the inverse of the size.
RESOLUTION = Resolution(nodes=5, severities={**dict.fromkeys(FAULTS, 24), "root_tooth_crack": 72}, finer=4)


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """The result of :func:`swgsim.diagnose`.

    Attributes
    ----------
    report : mapping
        The content of ``diagnosis.json`` in SI units; its ``verdict`` is ``healthy``, ``faulty`` or
        ``something_else``, which is none of the five faults.
    loop : Identification
        What the loop found in the same recordings.
    """

    report: Mapping[str, Any]
    loop: Identification

    @property
    def sentence(self) -> str:
        """The diagnosis in one sentence, in engineering units."""
        return str(self.report["sentence"])

    def save(self, folder: Path | str) -> None:
        """Write ``diagnosis.json`` and ``page.html``, and the answer of the loop into the folder ``loop``.

        Raises
        ------
        OSError
            If the folder cannot be written.
        """
        folder = Path(folder)
        self.loop.save(folder / "loop")
        write_json(folder / "diagnosis.json", self.report)
        write_text(folder / "page.html", page(self.report, self.loop.report))

    def __repr__(self) -> str:
        return f"Diagnosis of {self.report['gear']!r}: {self.sentence}"


@threadpool_limits.wrap(limits=1)
def diagnose(
    recordings: Iterable[Recording],
    healthy: Iterable[Recording] | Unit,
    gear: Gear | None = None,
    *,
    declared: Iterable[Effect] = (),
    prior: Mapping[str, float] | None = None,
    false_alarms: float = FALSE_ALARMS,
    costs: Costs | None = None,
    effects: Iterable[type[Effect]] | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Diagnosis:
    """Whether a gear has a fault, which one, how large and where.

    The loop looks for what the model lacks, in the healthy recordings and in the new ones. What explains the
    healthy gear is declared, and the gear is commissioned with it: this is the twin, on which Bayes' rule judges.

    Parameters
    ----------
    recordings : iterable of Recording
        Those to examine, of one gear.
    healthy : iterable of Recording, or Unit
        Recordings of the same gear when it was healthy; or its unit, which is taken as it is.
    gear : Gear, optional
        The nominal gear, by default the paper's first one; a unit has its own.
    declared : iterable of Effect
        Effects that the model has from the start.
    prior : mapping, optional
        Probability of classes in :data:`PRIOR` that differ; all are scaled to a sum of 1.
    false_alarms : float
        Share of healthy gears that may be called faulty.
    costs : mapping, optional
        Decision (leave, inspect, replace) to class to cost, as far as they differ from :data:`.costs.COSTS`.
    effects : iterable of effect classes, optional
        The library that the loop searches; by default all effects.
    seed : int
        Of the simulated noise behind p-values and false alarms.
    progress : callable, optional
        Receives a line of text at each step, such as ``print``.

    Raises
    ------
    ValueError
        If a choice is unknown or beyond its limits, or recordings cannot be compared; the message says what to do.
    """
    chosen, kinds = _prior(prior or {}), None if effects is None else tuple(effects)
    prices = costs_with(costs or {})
    require("the diagnosis", "false_alarms", false_alarms, low=0.001, high=0.5)
    found = None
    if isinstance(healthy, Unit):
        unit = healthy
    else:
        gear, healthy, declared = gear or Gear(), tuple(healthy), tuple(declared)
        before = identify(healthy, nominal_unit(gear, declared), effects=kinds, seed=seed, progress=progress).answer
        # In a gear that even so is none of the series, effects would stand for what commissioning has to learn.
        explained = not before.unknown and lack_of_fit(before.decision.after)[1] >= false_alarms
        found = before.effects if explained else ()
        unit = commission(healthy, gear, declared=(*declared, *found), progress=progress)
    loop = identify(recordings, unit, effects=kinds, seed=seed, progress=progress)
    fitted, something_else = _without_faults(loop)
    suspected, rng = Suspected.of(fitted, partitions(), chosen), generator("diagnosis", seed)
    report = report_of(suspected, something_else, _healthy(unit), found, loop, false_alarms, prices, rng)
    return Diagnosis(report, loop)


def partitions() -> dict[str, Partition]:
    """The cells of every fault."""
    return {label: Partition.of(label, ends, RESOLUTION, SECTORS) for label, ends in SIZES.items()}


def _prior(changed: Mapping[str, float]) -> dict[str, float]:
    """Probability of every class, with some that differ from the default."""
    require_known("classes of the prior", changed, CLASSES)
    for label, probability in changed.items():
        require("the prior", label, probability, low=1e-9, high=1)
    weights = PRIOR | dict(changed)
    return {label: weights[label] / sum(weights.values()) for label in CLASSES}


def _without_faults(loop: Identification) -> tuple[Fitted, str | None]:
    """The model without a fault, and what the loop found that is none, in its words.

    Other effects are in the model if no answer of the loop's credible set does without them.
    """
    answer, decision = loop.answer, loop.answer.decision
    others = tuple(effect for effect in decision.effects if type(effect).name() not in FAULTS)
    explained = any(
        not option.unknown and all(type(effect).name() in FAULTS for effect in option.effects)
        for option, _ in decision.credible
    )
    found = answer.lines or answer.unnamed or (not explained and (answer.unknown or set(others) & set(answer.effects)))
    fitted = decision.before if explained or not others else extended(decision.before, others)
    return fitted, loop.sentence if found else None


def _healthy(unit: Unit) -> Fitted:
    """The healthy recordings beside the model of the series, without what commissioning learned beyond it."""
    series = nominal_unit(unit.nominal or unit.model.gear, unit.model.effects)
    return fit(Measured.of(unit.healthy), replace(series, zero=unit.zero))
