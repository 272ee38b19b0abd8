"""What differs between units of a series, as parameters of a fit with their declared spread.

b1 and k1, the kinematic error, the gauges, and the imperfections of the wave generator that a healthy unit may have.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, cos, hypot, sin, sqrt

from swgsim.bench.scatter import Bench
from swgsim.common.checks import require_known
from swgsim.effects import CamForm, EccentricWaveGenerator
from swgsim.gear.gear import Gear
from swgsim.identification.data.model import Model
from swgsim.identification.fit.priors import Declared, of_unit

# Parameters of a unit that a population shares, or that belong to the bench: recordings without torques and speed
# hardly show them.
SHARED = (
    "b0",
    "mu",
    "w0",
    "interference",
    "J_in",
    "J_out",
    "rotor share",
    "load share",
    "error lever",
    "control frequency",
    "control damping",
)


def start_of(gear: Gear) -> Model:
    """The nominal gear, from which the spreads are counted, with its imperfections at zero.

    The part b3 of the friction depends on where the output stands. Its mean over all recordings is zero.
    """
    return Model(gear.with_transmission(b3=0.0), (EccentricWaveGenerator(0.0), CamForm(3, 0.0), CamForm(5, 0.0)))


def parameters_of(gear: Gear, bench: Bench, structure: float = 0.0, further: Sequence[str] = ()) -> dict[str, Declared]:
    """The parameters of :func:`start_of`, with the spreads of a series and of a bench.

    Parameters
    ----------
    gear : Gear
        The nominal one.
    bench : Bench
    structure : float
        Spread of the factors by which the structure differs from the truss (:mod:`swgsim.flexspline`).
    further : sequence of str
        Those of :data:`SHARED` by which units differ nevertheless.

    Raises
    ------
    ValueError
        If one of them is unknown; the message lists the choices.
    """
    require_known("further parameters of a unit", further, SHARED)
    known = set(SHARED) - set(further)
    of_gear = {name: each for name, each in of_unit(gear, structure=structure).items() if name not in known}
    return of_gear | {
        f"{effect.title()} {number + 1} {part}": _along(number, size, angle, part, largest)
        for number, (effect, size, angle, largest) in enumerate((
            (EccentricWaveGenerator, "r", "theta", bench.eccentricity),
            (CamForm, "amplitude", "phase", bench.cam_form),
            (CamForm, "amplitude", "phase", bench.cam_form),
        ))
        for part in ("cosine", "sine")
        if largest
    }  # fmt: skip


def _along(number: int, size: str, angle: str, part: str, largest: float) -> Declared:
    """Cosine or sine part of an effect with a size, drawn evenly up to the largest, and any angle.

    Its standard deviation is that of one coordinate: largest / sqrt(6).
    """

    def parts(model: Model) -> tuple[float, float]:
        effect = model.effects[number]
        return getattr(effect, size) * cos(getattr(effect, angle)), getattr(effect, size) * sin(getattr(effect, angle))

    def moved(model: Model, to: float) -> Model:
        x, y = parts(model)
        x, y = (to, y) if part == "cosine" else (x, to)
        turned = replace(model.effects[number], **{size: hypot(x, y), angle: atan2(y, x)})
        return replace(model, effects=(*model.effects[:number], turned, *model.effects[number + 1 :]))

    def value(model: Model) -> float:
        return parts(model)[part == "sine"]

    # Within the limits of the effects, for any direction.
    return Declared("m", largest / sqrt(6), value, moved, low=-3 * largest, high=3 * largest)
