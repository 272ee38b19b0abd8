"""Draws the truth of a case: effects within their bounds, of the size that brings the strength that was planned."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from swgsim.blind.altered import Alteration, Altered, StrayOrder
from swgsim.blind.bench import Setting, commissioning, in_question
from swgsim.blind.outside import OUTSIDE
from swgsim.blind.sealed import Sealed
from swgsim.blind.strata import HARD_NULL, OUTSIDE_STRATA, TAKEN_OUT, UNTESTABLE, WRITTEN, Plan, searched
from swgsim.blind.strength import likeness, sized
from swgsim.common.seeds import generator, seed_hash
from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities, size_of
from swgsim.identification.commissioning.commissioning import learn_unit
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model, predict
from swgsim.identification.fit.errors import per_channel
from swgsim.identification.fit.fitted import Fitted
from swgsim.identification.fit.fitting import fit
from swgsim.identification.fit.unit import Unit
from swgsim.storage.labelled_signals import SENSORS

# How far laws are off the library's: by this power of the load, or with sizes that vary by this share over operating
# points; estimates, within the form tolerance (form_error.FORM_TOLERANCE).
EXPONENT, SPREAD = 0.2, 0.1
# Size of a stray order relative to the effect's own ripple.
STRAY = (0.1, 0.2)
# Strength of untestable effects: at most one standard deviation of a nuisance parameter.
ABSORBED = (0.1, 1.0)
# Running in takes up to this share of damping and stiffness.
RUN_IN = 0.1
# An effect that its bounds keep below this strength is nearly nothing in these recordings; another one is drawn.
LEAST_STRENGTH = 30.0


def draw(plan: Plan, setting: Setting) -> Sealed:
    """The truth of a planned case."""
    rng = generator("blind case", setting.seed, plan.number)
    run_in = (1.0, 1.0)
    if plan.stratum == HARD_NULL and not plan.commissioned:
        run_in = (1 - rng.uniform(0, RUN_IN), 1 - rng.uniform(0, RUN_IN))
    case = Sealed(
        number=plan.number,
        stratum=plan.stratum,
        design=plan.design.name,
        points=plan.design.points,
        repeats=plan.design.repeats,
        seed=seed_hash("blind unit", setting.seed, plan.number) % 2**31,
        sectors=int(rng.choice(setting.sectors)),
        commissioned=plan.commissioned,
        hard=plan.stratum == HARD_NULL,
        run_in=run_in,
        form=plan.form,
    )
    if not plan.kinds:
        return case
    measured = Measured.of(in_question(case, setting, ()))
    fitted = fit(measured, unit_known(case, setting))
    if plan.form == "load law":
        case = replace(case, alteration=Alteration(exponent=EXPONENT))
    elif plan.form == "scattered size":
        case = replace(case, alteration=Alteration.scattered(SPREAD, rng))
    drawn: list[Effect] = []
    found: list[float] = []
    invisible: list[str] = []
    others = OUTSIDE if plan.stratum == WRITTEN else setting.library
    spares = [others[i] for i in rng.permutation(len(others))]
    for kind in plan.kinds:
        effect, strength = _sized(kind, plan, fitted, case, rng)
        while strength < LEAST_STRENGTH and plan.stratum != UNTESTABLE and spares:
            spare = spares.pop()
            if not searched(spare) or spare in (*plan.kinds, *map(type, drawn)):
                continue
            invisible.append(effect.name())
            effect, strength = _sized(spare, plan, fitted, case, rng)
        drawn.append(effect)
        found.append(strength)
    case = replace(case, effects=tuple(drawn), strengths=tuple(found), invisible=tuple(invisible))
    if plan.stratum == TAKEN_OUT:
        case = replace(case, taken_out=case.names)
    if plan.form == "stray order":
        case = replace(case, stray=_stray(drawn[0], fitted, rng))
    if plan.stratum in OUTSIDE_STRATA:
        share, nearest = likeness(drawn[0], setting.given(case), fitted)
        case = replace(case, likeness=share, nearest=nearest)
    return case


def unit_known(case: Sealed, setting: Setting) -> Unit:
    """The unit before the recordings to examine."""
    return _learned(case.seed, case.sectors, setting) if case.commissioned else Unit(Model(setting.gear))


@lru_cache(maxsize=16)  # 6 MB each
def _learned(seed: int, sectors: int, setting: Setting) -> Unit:
    """The commissioned unit of a case; the process that draws the cases of a small set learns it for the answer too."""
    return learn_unit(Measured.of(commissioning(seed, sectors, setting)), Unit(Model(setting.gear)))


def drawn_inner(kind: type[Effect], rng: np.random.Generator) -> Effect:
    """An effect with its inner parameters drawn, on one side of nothing."""
    values: dict[str, float] = {}
    for name, q in quantities(kind).items():
        if q.role is Role.CHOICE:
            values[name] = q.tried[int(rng.integers(len(q.tried)))]
        elif q.role in (Role.PHASE, Role.ANGLE, Role.RANDOM):
            values[name] = float(rng.uniform(0, 2 * np.pi))
        elif q.role is Role.SHAPE and q.open(another_structure=False):
            values[name] = float(rng.uniform(q.low, q.high))
        elif q.role is Role.SHAPE:
            values[name] = float(np.clip(q.typical * rng.uniform(0.85, 1.15), q.low, q.high))
        else:
            span = q.typical - q.nothing
            other = np.clip(q.nothing - span, q.low, q.high)
            both = q.low < q.nothing < q.high and rng.uniform() < 0.5
            values[name] = float(other if both else q.typical)
    return kind(**values)


def _sized(
    kind: type[Effect], plan: Plan, fitted: Fitted, case: Sealed, rng: np.random.Generator
) -> tuple[Effect, float]:
    """An effect of the strength that was planned; an untestable one less than noise would pass for."""
    target = rng.uniform(*ABSORBED) if plan.stratum == UNTESTABLE else plan.strength
    return sized(drawn_inner(kind, rng), target, fitted, lambda each: _dressed(each, case))


def _dressed(effect: Effect, case: Sealed) -> Effect:
    return Altered(effect, case.alteration) if case.alteration else effect


def _stray(effect: Effect, fitted: Fitted, rng: np.random.Generator) -> StrayOrder:
    """An unrelated order in the channel in which an effect is largest in units of the noise."""
    measured = fitted.measured
    seen = predict([fitted.model, fitted.model.plus(effect)], measured.situations, measured.layout)
    change = measured.rows(seen[1] - seen[0])
    sizes = dict(zip(measured.layout.channels, per_channel(measured, change), strict=True))
    white = (change.reshape(measured.values.shape) ** 2 / measured.variance).sum(axis=0)
    power = {c: float(white[measured.layout.channel == c].sum()) for c in sizes if c in SENSORS}
    channel = max(power, key=lambda name: power[name])
    amplitude = rng.uniform(*STRAY) * np.sqrt(2) * float(sizes[channel])
    number = SENSORS.index(channel)
    bound = quantities(StrayOrder)[size_of(StrayOrder)].high
    return StrayOrder(number, int(rng.integers(3, 12)), float(min(amplitude, bound)), float(rng.uniform(0, 2 * np.pi)))
