"""The gear of a twin, fitted to references by the code that commissions gears for the loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.chain.steady_state_cache import forget
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.data.model import Model, predict
from swgsim.identification.fit.map_fit import calibrate
from swgsim.identification.fit.priors import Declared
from swgsim.oracle.model import ORDERS
from swgsim.oracle.oracle import FEATURES
from swgsim.storage.labelled_signals import SENSORS
from swgsim.twin.knowledge import Knowledge
from swgsim.twin.references import References
from swgsim.twin.revolution_features import RevolutionFeatures

# Fits, each with the scatter of the gear that the one before found: with that of another gear, the common errors of
# the largest lines, which are hundreds of times the noise, point into a slightly wrong direction.
TURNS = 2
# Spreads of the factors by which the structure differs from the truss, as in the commissioning for the loop; 0 is the
# truss itself. The first fit has the last one, with which all waves are free, and the next one the likeliest.
SPREADS = (0.0, 0.01, 0.03, 0.1, 0.3)
# Lacks of fit that are tried, as shares of a line: 0.01 is the mesh of the truss, and 0.3 the truss of another author.
LACKS = (0.0, 0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3)


@dataclass(frozen=True, eq=False)
class FittedGear:
    """A gear as its references show it.

    Attributes
    ----------
    model : Model
        Gear and imperfections at the likeliest values.
    offset : array (point, feature)
        What references show of the healthy gear beyond the model; zero if the model describes it.
    unsure : array (point, feature, direction)
        How far the healthy observations may still lie off, one standard deviation of each independent direction.
    lack : float
        How far lines of this gear lie off the model, as a share of each: the most probable of :data:`LACKS`, 0 for a
        gear of the model.
    misfit : float
        Mean square of what the fit leaves of the references, in standard deviations: 1 for a gear of the model, far
        above 1 for one that the model does not describe.
    """

    model: Model
    offset: Float[np.ndarray, "point feature"]
    unsure: Float[np.ndarray, "point feature direction"]
    lack: float
    misfit: float


def fit_gear(
    knowledge: Knowledge,
    references: References,
    start: Model | None = None,
    parameters: Mapping[str, Declared] | None = None,
    turns: int = TURNS,
) -> FittedGear:
    """The likeliest gear of the series, given its references.

    Parameters
    ----------
    knowledge : Knowledge
    references : References
        Of one gear, at the operating points of the knowledge.
    start : Model, optional
        Where the spreads are counted from; by default the nominal gear without imperfections.
    parameters : mapping, optional
        What may differ from the start; by default all parameters of a series, and the factors of the structure with
        the likeliest spread.
    turns : int
        One is enough if the start is nearly the gear.

    Raises
    ------
    ValueError
        If the references lack an operating point.
    """
    forget()
    plan = knowledge.plan
    if start is None:
        start, scatter = knowledge.start, knowledge.at_start
    else:
        scatter = knowledge.scatter_of(start)
    searched = parameters is None
    parameters = knowledge.parameters(SPREADS[-1]) if parameters is None else parameters
    rows = _rows(references, plan.grid.points)
    mean, count = references.mean[rows], references.count[rows]
    layout = RevolutionFeatures(N=knowledge.nominal.transmission.N)
    at: Model = start
    position: Mapping[str, float] = {}
    lack = 0.0
    for turn in range(turns):
        scatter = knowledge.scatter_of(at) if turn else scatter
        errors = scatter.errors(count)
        # The mean of scattered observations lies off that without scatter, as a turned trigger shortens large lines.
        still = predict([at], knowledge.situations, layout, plan.sectors)[0]
        measured = mean - (scatter.mean - still)
        lines = _of_lines(still)
        found = calibrate(
            start, parameters, measured, errors.with_columns(lack * lines), knowledge.situations,
            np.arange(len(mean)), layout, position, plan.sectors,
        )  # fmt: skip
        at, position = found.model, found.position
        J, left = found.J.reshape(mean.size, -1), (measured - found.predicted).ravel()
        from_start = left + J @ np.array(list(position.values()))
        lack = _likeliest({each: np.hstack([J, each * lines]) for each in LACKS}, errors, from_start)
        if searched and not turn:
            factors = np.array([name.startswith("response") for name in parameters])
            columns = {each: J * np.where(factors, each / SPREADS[-1], 1.0) for each in SPREADS}
            spread = _likeliest(columns, errors.with_columns(lack * lines), from_start)
            parameters = knowledge.parameters(spread)
            position = {name: position[name] for name in parameters if not name.startswith("response")}
    directions = np.hstack([J, lack * lines]) if lack else J
    white = errors.whiten(directions)
    covariance = np.linalg.inv(white.T @ white + np.eye(directions.shape[1]))
    known = covariance @ (white.T @ errors.whiten(from_start))
    return FittedGear(
        at,
        offset=(directions[:, len(parameters) :] @ known[len(parameters) :]).reshape(mean.shape),
        unsure=(directions @ np.linalg.cholesky(covariance)).reshape(*mean.shape, -1),
        lack=lack,
        misfit=float(np.mean(errors.whiten(left) ** 2)),
    )


def _likeliest(
    columns: Mapping[float, Float[np.ndarray, "row column"]],
    errors: Covariance,
    from_start: Float[np.ndarray, " row"],
) -> float:
    """The choice with the largest evidence, by the linearised model: with its columns references are likeliest."""
    return max(columns, key=lambda each: errors.with_columns(columns[each]).log_likelihood(from_start))


def _of_lines(observation: Float[np.ndarray, "point feature"]) -> Float[np.ndarray, "row line"]:
    """Change of observations by the whole of each line, in either part of it; efficiency and temperature have none."""
    lines = observation[:, : FEATURES - 2].copy()
    means = len(SENSORS) * (ORDERS + 1)
    real = lines[:, :means].reshape(-1, len(SENSORS), ORDERS + 1)
    imaginary = lines[:, means:].reshape(-1, len(SENSORS), ORDERS)
    size = np.abs(real)
    size[:, :, 1:] = np.hypot(real[:, :, 1:], imaginary)
    none = np.zeros((len(lines), 2))
    each = np.hstack([size.reshape(len(lines), -1), size[:, :, 1:].reshape(len(lines), -1), none])
    return np.diag(each.ravel())[:, each.ravel() > 0]


def _rows(references: References, points: Sequence[OperatingPoint]) -> list[int]:
    """Which row of the references belongs to each operating point."""
    missing = [point for point in points if point not in references.points]
    if missing:
        raise ValueError(
            f"no reference at {missing[0].n_in_rpm:g} rpm and {missing[0].T_out:g} N m: record the healthy gear there, "
            "or leave the operating point out"
        )
    return [references.points.index(point) for point in points]
