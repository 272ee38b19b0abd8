"""Healthy variability: small changes of gear, gauges and amplifiers that the model does not contain.

Each of them can be a fault too. They are nuisance parameters only if healthy recordings determine their size.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from swgsim.effects.frozen import FULL_SPEED
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model, Situation
from swgsim.identification.fit.priors import Declared
from swgsim.storage.labelled_signals import SENSORS

# Standard deviations, all estimates. Of a lag behind the angle [s]: a filter of 10 kHz has 16 us, one of 3 kHz 50.
LAG = 5e-5
# Of a gauge's gain and zero with the temperature [1/K, mV/V per K] (physics.md SE6, AC6, SE5).
GAIN_PER_KELVIN, ZERO_PER_KELVIN = 3e-4, 2.5e-4
# Of a gauge's mean, which the drag of the wave generator moves with the speed [mV/V at full speed].
MEAN_AT_FULL_SPEED = 1e-3
# Of friction with the temperature of the grease [1/K] (physics.md DY3).
FRICTION, FRICTION_PER_KELVIN = ("b0", "b1"), 0.03
# By how much the grease may be warmer beside the recorded temperature than it was in the commissioning [K]: an estimate
# for a sensor on the housing. All later recordings share it.
WARMER_GREASE = 0.5


def of_gauges(
    predicted: Float[np.ndarray, "situation feature"], situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Lag, gain and zero with the temperature, and mean with the speed of every gauge, one standard deviation each."""
    speed = np.array([s.point.n_in_rpm for s in situations])[:, None]
    late = -layout.turning(predicted) * (2 * np.pi / 60 * speed)
    mean = (layout.order == 0)[None, :]
    moved = [
        LAG * late,
        GAIN_PER_KELVIN * _warmer(situations) * predicted,
        ZERO_PER_KELVIN * _warmer(situations) * mean,
        MEAN_AT_FULL_SPEED * speed / FULL_SPEED * mean,
    ]
    gauges = [name for name in layout.channels if name in SENSORS]
    columns = [each * (layout.channel == name) for name in gauges for each in moved]
    return np.stack(columns, axis=-1) if columns else np.zeros((*predicted.shape, 0))


def of_friction(
    model: Model,
    parameters: Mapping[str, Declared],
    J: Float[np.ndarray, "situation feature parameter"],
    situations: Sequence[Situation],
) -> Float[np.ndarray, "situation feature column"]:
    """Friction with the temperature, one standard deviation each.

    Parameters
    ----------
    model : Model
    parameters : mapping
        Those of :data:`FRICTION` among them.
    J : array (situation, feature, parameter)
        Change by one spread of each parameter.
    situations : sequence of Situation
    """
    return _per_kelvin(model, parameters, J) * _warmer(situations)[..., None]


def of_another_day(
    model: Model, parameters: Mapping[str, Declared], J: Float[np.ndarray, "situation feature parameter"]
) -> Float[np.ndarray, "situation feature friction"]:
    """Friction of a grease that is warmer than recorded, one standard deviation each; arguments of
    :func:`of_friction`.
    """
    return WARMER_GREASE * _per_kelvin(model, parameters, J)


def _per_kelvin(
    model: Model, parameters: Mapping[str, Declared], J: Float[np.ndarray, "situation feature parameter"]
) -> Float[np.ndarray, "situation feature friction"]:
    numbers = [list(parameters).index(name) for name in FRICTION]
    spreads = [FRICTION_PER_KELVIN * parameters[name].value(model) / parameters[name].sd for name in FRICTION]
    return J[..., numbers] * np.array(spreads)


def of_learned(
    learned: Float[np.ndarray, " feature"], situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Lines of speed and torques that were learned, which follow friction with the temperature, each as it may."""
    drive = [i for i, name in enumerate(layout.channel) if name not in SENSORS and learned[i] > 0]
    return FRICTION_PER_KELVIN * _warmer(situations)[..., None] * (learned * np.eye(len(layout)))[:, drive]


def _warmer(situations: Sequence[Situation]) -> Float[np.ndarray, "situation 1"]:
    """Temperature above the reference [K]."""
    return np.array([[s.conditions.warmer] for s in situations])
