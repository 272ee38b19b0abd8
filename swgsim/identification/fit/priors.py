"""Declared parameters with their priors: those of the unit, and those of the effects in the model."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.effects.quantity import Role, quantities
from swgsim.flexspline.gauges import LIMITS
from swgsim.flexspline.structure_factors import SEEN_BY_S0, WAVES, smooth_modes
from swgsim.gear.gear import INTERFERENCE_LIMITS, W0_LIMITS, Gear, KinematicError
from swgsim.identification.data.model import Model

# Relative prior standard deviations of the bench: inertias, and speed control (each drive has its own); estimates.
BENCH, CONTROL = 0.3, 1.0
# Prior standard deviation of a share between 0 and 1.
SHARE_SD = 0.5
# Relative prior standard deviation of stiffness and friction in a series; and of friction with commissioning, because
# catalogues and greases differ by a factor of two; estimates.
SERIES, ANY_FRICTION = 0.1, 0.5
# Of a gauge's gain and of the wave generator's stroke in a series, as a share; an estimate.
STRAINED = 0.01
# Of each part of the kinematic error [rad], of a gauge's zero [mV/V], of its position and direction [rad]; estimates.
ERROR_PART, ZERO, PLACED = 0.3e-4, 0.02, 0.01
# Of the interference of wave generator and sleeve [m]; an estimate.
INTERFERENCE = 1e-5
# Spread of the factors of s0 relative to those of the other gauges: of waves that its arms nearly cancel, what is left
# depends on where they are; an estimate.
S0_ARMS = 3.0
# Wave numbers over which the factors of another structure keep much of their value; an estimate, by the trusses of two
# authors. Modes of their course below this share of the largest are nothing beside the declared error of the maps.
COURSE, LEAST_MODE = 2.0, 0.005
# A position or shape of an effect that is not seen at all stays within its range over this; an estimate.
UNSEEN_SHARE = 20.0
# Below this share of its nominal value, a stiffness, a friction or the stroke of the wave generator is that of no gear;
# nor is a stiffness, a friction or what belongs to the bench beyond so many times it.
LEAST_RATIO, MOST_RATIO = 0.05, 5.0


@dataclass(frozen=True)
class Declared:
    """One parameter of a model that a fit may move.

    Attributes
    ----------
    unit : str
    sd : float
        How far it may lie from where the model has it, as a standard deviation: over units of a series, an estimate.
    value : callable
        The parameter of a model.
    moved : callable
        The model with the parameter set to a value.
    low, high : float
        Its bounds.
    scale : float
        What features do over a hundredth of it is linear, if that is less than the standard deviation.
    """

    unit: str
    sd: float
    value: Callable[[Model], float]
    moved: Callable[[Model, float], Model]
    low: float = -np.inf
    high: float = np.inf
    scale: float = np.inf

    def at(self, model: Model, value: float) -> Model:
        """The model with the parameter at a value, or at the bound that is nearest."""
        return self.moved(model, float(np.clip(value, self.low, self.high)))


def _of_gear(
    unit: str, sd: float, value: Callable[[Gear], float], moved: Callable[[Gear, float], Gear],
    low: float = -np.inf, high: float = np.inf,
) -> Declared:  # fmt: skip
    return Declared(unit, sd, lambda m: value(m.gear), lambda m, to: replace(m, gear=moved(m.gear, to)), low, high)


def _of_transmission(name: str, unit: str, sd: float, low: float = -np.inf, high: float = np.inf) -> Declared:
    return _of_gear(
        unit,
        sd,
        lambda gear: float(getattr(gear.transmission, name)),
        lambda gear, to: replace(gear, transmission=replace(gear.transmission, **{name: to})),  # type: ignore[arg-type]
        low,
        high,
    )


def _of_size(name: str, unit: str, nominal: float, spread: float) -> Declared:
    """A stiffness, friction or the like, whose spread is a share of it."""
    if not nominal > 0:
        raise ValueError(
            f"{name} of the gear is {nominal:g} {unit}, must be more than 0 for a loop, which looks for it within a "
            "share of that: give an estimate in the gear file"
        )
    return _of_transmission(name, unit, spread * nominal, LEAST_RATIO * nominal, MOST_RATIO * nominal)


def _of_gauge(name: str, sensor: int, unit: str, sd: float) -> Declared:
    return _of_gear(
        unit,
        sd,
        lambda gear: float(getattr(gear.gauges, name)[sensor]),
        partial(_with_gauge, name, sensor),
        *LIMITS[name],
    )


def _with_gauge(name: str, sensor: int, gear: Gear, to: float) -> Gear:
    values = list(getattr(gear.gauges, name))
    values[sensor] = to
    return replace(gear, gauges=replace(gear.gauges, **{name: tuple(values)}))  # type: ignore[arg-type]


def _of_kinematic_error(order: int, part: str, sd: float) -> Declared:
    """Sine or cosine part of one order of A sin(order phi + phase): amplitude and phase, but linear."""
    return _of_gear(
        "rad",
        sd,
        lambda gear: _phasor(order, gear).real if part == "sine" else _phasor(order, gear).imag,
        partial(_with_phasor, order, part),
    )


def _phasor(order: int, gear: Gear) -> complex:
    terms = [term for term in gear.transmission.kinematic_error if term.order == order]
    return complex(sum(term.amplitude * np.exp(1j * term.phase) for term in terms))


def _with_phasor(order: int, part: str, gear: Gear, to: float) -> Gear:
    now = _phasor(order, gear)
    sought = complex(to, now.imag) if part == "sine" else complex(now.real, to)
    term = KinematicError(order, float(abs(sought)), float(np.angle(sought)))
    others = tuple(each for each in gear.transmission.kinematic_error if each.order != order)
    return replace(gear, transmission=replace(gear.transmission, kinematic_error=(*others, term)))


def of_structure(spread: float, presses_only: bool = False) -> dict[str, Declared]:
    """The factors of another structure, as independent modes of their course over the wave number.

    Parameters
    ----------
    spread : float
        Standard deviation of the logarithm of a factor, and of its phase [rad]; 0 for a structure that is known.
    presses_only : bool
        Whether the wave generator only presses, so that the compliance of the sleeve matters.
    """
    if not spread:
        return {}
    smooth, single = smooth_modes(COURSE, LEAST_MODE), S0_ARMS * np.eye(WAVES)[list(SEEN_BY_S0)]
    kinds = {"wave_generator": smooth, "teeth": smooth, "wave_generator_s0": single, "teeth_s0": single}
    nothing = np.zeros(WAVES)
    of_compliance = {
        f"compliance {number}": _of_factors("compliance", [mode], "-", spread)
        for number, mode in enumerate(smooth if presses_only else [], 1)
    }
    return of_compliance | {
        f"response to {kind.replace('_', ' ')}, {part} {number}": _of_factors(kind, parts, unit, spread)
        for kind, modes in kinds.items()
        for number, mode in enumerate(modes, 1)
        for part, unit, parts in (("amplitude", "-", [mode, nothing]), ("phase", "rad", [nothing, mode]))
    }


def _of_factors(kind: str, parts: Sequence[Float[np.ndarray, " wave"]], unit: str, spread: float) -> Declared:
    """One mode of the factors on a kind of load: of the logarithms of their amplitudes, and of their phases."""
    mode = np.concatenate(parts)
    return _of_gear(unit, spread, partial(_along_mode, kind, mode), partial(_with_mode, kind, mode))


def _along_mode(kind: str, mode: np.ndarray, gear: Gear) -> float:
    return float(np.array(getattr(gear.factors, kind) or np.zeros(len(mode))) @ mode / (mode @ mode))


def _with_mode(kind: str, mode: np.ndarray, gear: Gear, to: float) -> Gear:
    logs = np.array(getattr(gear.factors, kind) or np.zeros(len(mode))) + (to - _along_mode(kind, mode, gear)) * mode
    return replace(gear, factors=replace(gear.factors, **{kind: tuple(logs.tolist())}))


def of_unit(
    gear: Gear, friction: float = SERIES, structure: float = 0.0, of_gauges: float = 1.0
) -> dict[str, Declared]:
    """The parameters by which units differ from the nominal gear, with their spread in a series, and the bench.

    Parameters
    ----------
    gear : Gear
        The nominal one.
    friction : float
        Spread of b0, b1 and mu, as a share.
    structure : float
        Spread of the factors of the structure (:func:`of_structure`).
    of_gauges : float
        Spread of gains, positions and directions of the gauges, relative to that of a series.
    """
    t = gear.transmission
    found = {
        "k1": _of_size("k1", "N m/rad", t.k1, SERIES),
        "b0": _of_size("b0", "N m", t.b0, friction),
        "b1": _of_size("b1", "N m s/rad", t.b1, friction),
        "mu": _of_size("mu", "-", t.mu, friction),
        **of_bench(gear),
        "w0": _of_gear(
            "m",
            STRAINED * gear.wave_generator.w0,
            lambda each: each.wave_generator.w0,
            lambda each, to: replace(each, wave_generator=replace(each.wave_generator, w0=to)),
            max(LEAST_RATIO * gear.wave_generator.w0, W0_LIMITS[0]),
            W0_LIMITS[1],
        ),
    }
    if gear.wave_generator.presses_only:
        found["interference"] = _of_gear(
            "m",
            INTERFERENCE,
            lambda each: each.wave_generator.interference,
            lambda each, to: replace(each, wave_generator=replace(each.wave_generator, interference=to)),
            *INTERFERENCE_LIMITS,
        )
    for term in t.kinematic_error:
        for part in ("sine", "cosine"):
            found[f"kinematic error {term.order} {part}"] = _of_kinematic_error(term.order, part, ERROR_PART)
    for sensor in range(5):
        found[f"gain of s{sensor}"] = _of_gauge("gain", sensor, "-", of_gauges * STRAINED)
        found[f"zero of s{sensor}"] = _of_gauge("offset", sensor, "mV/V", ZERO)
        found[f"position of s{sensor}"] = _of_gauge("position", sensor, "rad", of_gauges * PLACED)
        found[f"grid angle of s{sensor}"] = _of_gauge("grid_angle", sensor, "rad", of_gauges * PLACED)
    return found | of_structure(structure, gear.wave_generator.presses_only)


def of_bench(gear: Gear) -> dict[str, Declared]:
    """Inertias, torque flanges and speed control of the test bench, of which a gear file says little."""
    t = gear.transmission
    return {
        "J_in": _of_size("J_in", "kg m^2", t.J_in, BENCH),
        "J_out": _of_size("J_out", "kg m^2", t.J_out, BENCH),
        "rotor share": _of_transmission("rotor_share", "-", SHARE_SD, 0.0, 1.0),
        "load share": _of_transmission("load_share", "-", SHARE_SD, 0.0, 1.0),
        "error lever": _of_transmission("error_lever", "-", SHARE_SD, 0.0, 1.0),
        "control frequency": _of_size("control_frequency", "Hz", t.control_frequency, CONTROL),
        "control damping": _of_size("control_damping", "-", t.control_damping, CONTROL),
    }


def of_effects(model: Model, another_structure: bool = False) -> dict[str, Declared]:
    """The parameters of the effects that a model has, free within their bounds.

    Choices are not among them, nor shapes of which a search tries the typical value only.

    Parameters
    ----------
    model : Model
    another_structure : bool
        Whether the gear's structure is another one than the model's.
    """
    found = {}
    for number, effect in enumerate(model.effects):
        for name, quantity in quantities(type(effect)).items():
            fixed = quantity.role is Role.SHAPE and not quantity.open(another_structure)
            if quantity.role in (Role.CHOICE, Role.RANDOM) or fixed:
                continue
            angular = quantity.role in (Role.PHASE, Role.ANGLE)
            span = 2 * np.pi if angular else quantity.high - quantity.low
            bounds = {} if angular else {"low": quantity.low, "high": quantity.high}
            # A size is free; where a position or a shape is not seen at all it stays near where the search left it.
            sd = span if quantity.role in (Role.SIZE, Role.PHASE) else span / UNSEEN_SHARE
            found[name_of(effect, number, name)] = Declared(
                quantity.unit, sd, _reader(number, name), _mover(number, name), **bounds, scale=quantity.scale
            )
    return found


def name_of(effect: Effect, number: int, parameter: str) -> str:
    """Name of a parameter of an effect of a model, such as ``cam form 1: amplitude``."""
    return f"{effect.title()} {number + 1}: {parameter}"


def _reader(number: int, name: str) -> Callable[[Model], float]:
    return lambda model: float(getattr(model.effects[number], name))


def _mover(number: int, name: str) -> Callable[[Model, float], Model]:
    def moved(model: Model, to: float) -> Model:
        effect = replace(model.effects[number], **{name: to})
        return replace(model, effects=(*model.effects[:number], effect, *model.effects[number + 1 :]))

    return moved


def at(model: Model, parameters: Mapping[str, Declared], position: Mapping[str, float]) -> Model:
    """A model with its parameters away from where it has them by so many spreads."""
    for name, by in position.items():
        parameter = parameters[name]
        model = parameter.at(model, parameter.value(model) + by * parameter.sd)
    return model
