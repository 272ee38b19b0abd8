"""Maximum a posteriori fit of the declared parameters, with Gaussian priors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq, lsq_linear

from swgsim.chain import SECTORS, NoSteadyState
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model, Situation, predict, predict_with_others
from swgsim.identification.fit.priors import Declared, at

# Gauss-Newton: fall of the cost below which it rests, and at most so many steps, each of at most so many spreads.
SETTLED, MOST_STEPS, LONGEST_STEP = 0.05, 24, 5.0
# The next steps are half as long where the cost fell by less than the first share of what was expected, as the model is
# not linear, and twice as long where it fell by more than the second. What makes them shorter is damping, which bends
# them along curved valleys.
LITTLE, MUCH = 0.25, 0.75
# A line that is no gear's.
NOWHERE = 1e9
# Difference for the derivatives, in spreads or scales; small against a nonlinearity, large against rounding.
DIFFERENCE = 0.01


@dataclass(frozen=True)
class Calibrated:
    """A model at its likeliest parameters.

    Attributes
    ----------
    model : Model
    position : mapping
        Parameter to its deviation from where the fit began, in units of its spread.
    predicted : array (situation, feature)
    J : array (situation, feature, parameter)
        Change by one spread of each parameter.
    settled : bool
        Whether the fit came to rest.
    lack_of_fit : float
        Mean square of the residual in standard deviations, at least 1. A large one limits the accuracy of all that is
        fitted, and iterations need not go further.
    """

    model: Model
    position: dict[str, float]
    predicted: Float[np.ndarray, "situation feature"]
    J: Float[np.ndarray, "situation feature parameter"]
    settled: bool
    lack_of_fit: float = 1.0


def linearised(
    model: Model,
    parameters: Mapping[str, Declared],
    situations: Sequence[Situation],
    layout: Layout,
    sectors: int = SECTORS,
) -> tuple[Float[np.ndarray, "situation feature"], Float[np.ndarray, "situation feature parameter"]]:
    """Prediction of a model, and its change by one spread of each parameter.

    It is 0 for a parameter next to whose value the gear has no steady state: a fit leaves such a parameter where it is.

    Raises
    ------
    NoSteadyState
        If the model itself has none.
    """
    models, moved = [], []
    for parameter in parameters.values():
        value, by = parameter.value(model), DIFFERENCE * min(1.0, parameter.scale / parameter.sd)
        moved.append(by if value + by * parameter.sd <= parameter.high else -by)
        models.append(parameter.at(model, value + moved[-1] * parameter.sd))
    predicted, beside = predict_with_others(model, models, situations, layout, sectors=sectors)
    changes = (beside - predicted) / np.array(moved)[:, None, None]
    return predicted, np.moveaxis(np.where(np.isnan(changes), 0.0, changes), 0, -1)


def calibrate(
    start: Model,
    parameters: Mapping[str, Declared],
    measured: Float[np.ndarray, "recording feature"],
    errors: Covariance,
    situations: Sequence[Situation],
    of_recording: np.ndarray,
    layout: Layout,
    position: Mapping[str, float] | None = None,
    sectors: int = SECTORS,
) -> Calibrated:
    """The likeliest parameters of a model.

    Parameters
    ----------
    start : Model
        Where the spreads are counted from.
    parameters : mapping
        Fitted parameters with their prior standard deviations.
    measured : array (recording, feature)
    errors : Covariance
        Covariance of all errors and nuisance directions, rows (recording, feature).
    situations : sequence of Situation
    of_recording : array (recording,)
        Which situation belongs to each recording.
    layout : Layout
    position : mapping, optional
        Where to begin, in spreads.
    sectors : int
        Of the flex spline's truss.
    """
    names = list(parameters)
    if not names:
        return Calibrated(start, {}, *linearised(start, parameters, situations, layout, sectors), True)
    low, high = _bounds(start, parameters)
    here = np.clip([(position or {}).get(name, 0.0) for name in names], low, high)

    def model_at(there: Float[np.ndarray, " parameter"]) -> Model:
        return at(start, parameters, dict(zip(names, there.tolist(), strict=True)))

    def missed(
        predicted: Float[np.ndarray, "situation feature"], there: Float[np.ndarray, " parameter"]
    ) -> tuple[Float[np.ndarray, " row"], float]:
        r = errors.whiten((measured - predicted[of_recording]).ravel())
        return r, float(r @ r + there @ there)

    model = model_at(here)
    # A fit that begins where motions are found at once takes no step to where they are not; the search takes long.
    search = bool((_predicted(model, situations, layout, sectors, False) == NOWHERE).any())
    predicted, J = linearised(model, parameters, situations, layout, sectors)
    r, cost = missed(predicted, here)
    length, settled = 1.0, False
    for _ in range(MOST_STEPS):
        columns = errors.whiten(J[of_recording].reshape(-1, len(here)))
        curvature, slope = columns.T @ columns + np.eye(len(here)), columns.T @ r - here
        little = SETTLED * max(1.0, cost / len(r))
        room = low - here, high - here
        while True:
            step = _step(curvature, slope, room, length)
            expected = float(step @ (2 * slope - curvature @ step))
            there = model_at(here + step)
            predicted_there = _predicted(there, situations, layout, sectors, search)
            r_there, cost_there = missed(predicted_there, here + step)
            if cost_there <= cost or not expected >= little:  # nor is it a number
                break
            length /= 2  # uphill, as the model is not linear, or where nothing turns steadily
        fell = cost - cost_there
        settled = bool(fell < little * length or expected < little)
        if fell >= 0:
            model, here, predicted, r, cost = there, here + step, predicted_there, r_there, cost_there
        if settled or not fell >= 0:
            break
        length *= 0.5 if fell < LITTLE * expected else 2.0 if fell > MUCH * expected and length < 1 else 1.0
        J = linearised(model, parameters, situations, layout, sectors)[1]
    position_found = dict(zip(names, here.tolist(), strict=True))
    return Calibrated(model, position_found, predicted, J, settled, max(1.0, cost / len(r)))


def _predicted(
    model: Model, situations: Sequence[Situation], layout: Layout, sectors: int, search: bool
) -> Float[np.ndarray, "situation feature"]:
    """What a model predicts; worse than anything where it has no steady state, or none that is found at once."""
    try:
        return predict([model], situations, layout, sectors=sectors, search=search)[0]
    except NoSteadyState:
        return np.full((len(situations), len(layout)), NOWHERE)


def _bounds(start: Model, parameters: Mapping[str, Declared]) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the parameters, in spreads about where the fit began."""
    low = [(p.low - p.value(start)) / p.sd for p in parameters.values()]
    high = [(p.high - p.value(start)) / p.sd for p in parameters.values()]
    return np.array(low), np.array(high)


def _step(
    curvature: Float[np.ndarray, "parameter parameter"],
    slope: Float[np.ndarray, " parameter"],
    room: tuple[Float[np.ndarray, " parameter"], Float[np.ndarray, " parameter"]],
    share: float,
) -> Float[np.ndarray, " parameter"]:
    """The step of Gauss-Newton, damped to a share of its length and of the longest (Levenberg, Marquardt).

    The damping is that of the step without bounds, which costs one decomposition; what bounds change is cut.
    """
    full = _least(curvature, slope, room)
    size = float(np.abs(full).max())
    longest = share * min(size, LONGEST_STEP)
    if size <= longest:
        return full
    stiffness, axes = np.linalg.eigh(curvature)
    along = axes.T @ slope

    def too_long(by: float) -> float:
        return float(np.abs(axes @ (along / (stiffness + by))).max()) - longest

    most = 2 * float(np.linalg.norm(slope)) / longest  # makes it half as long, or less
    by = brentq(too_long, 0.0, most, rtol=1e-3) if too_long(0.0) > 0 else 0.0
    step = _least(curvature + by * np.eye(len(slope)), slope, room)
    return step * min(1.0, longest / float(np.abs(step).max()))


def _least(
    curvature: Float[np.ndarray, "parameter parameter"],
    slope: Float[np.ndarray, " parameter"],
    room: tuple[Float[np.ndarray, " parameter"], Float[np.ndarray, " parameter"]],
) -> Float[np.ndarray, " parameter"]:
    """The step to the least cost within the bounds; a parameter at its bound leaves the others free to follow."""
    free = np.linalg.solve(curvature, slope)
    if np.all((room[0] <= free) & (free <= room[1])):
        return free
    root = np.linalg.cholesky(curvature).T
    bounds = room[0] - 1e-12, room[1] + 1e-12
    return lsq_linear(root, np.linalg.solve(root.T, slope), bounds, method="bvls").x
