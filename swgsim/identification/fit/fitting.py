"""Fit of the parameters to recordings, in turns with the standard deviations of single recordings."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.identification.covariance import narrow_band, repeats, scatter
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.fitted import Allowed, Fitted
from swgsim.identification.fit.map_fit import Calibrated, calibrate, linearised
from swgsim.identification.fit.priors import Declared, at, of_effects
from swgsim.identification.fit.unit import Unit

# A parameter counts as biased by lack of fit if it lies this many prior standard deviations off, while the mean square
# of a channel exceeds its declared value by this factor.
IMPROBABLE, MISFIT = 5.0, 10.0
# Largest number of turns; and the Kullback-Leibler divergence between two estimates of the errors of single recordings
# at which the turns end [nat per recording]: an error of one third in one standard deviation (estimates).
MOST_TURNS, SAME_SCATTER = 4, 0.1
# Turns where nothing was repeated: what the model lacks passes for such errors then, and more turns go astray with it.
MOST_TURNS_UNREPEATED = 2


def fit(
    measured: Measured,
    unit: Unit,
    model: Model | None = None,
    *,
    position: Mapping[str, float] | None = None,
    allowed: Allowed | None = None,
    held: Collection[str] = (),
    turns: int = MOST_TURNS,
) -> Fitted:
    """Fit the parameters, and estimate the standard deviations of single recordings, in turns.

    Parameters
    ----------
    measured : Measured
    unit : Unit
    model : Model, optional
        The unit's with further effects, which are fitted along.
    position : mapping, optional
        Where parameters begin, in spreads.
    allowed : Allowed, optional
    held : collection of str
        Parameters of the unit that are not fitted but stay where they begin.
    turns : int
        So many at most; where nothing was repeated, fewer.
    """
    begin = dict(position or {})
    start = at(model or unit.model, unit.declared, {name: begin.pop(name) for name in held})
    parameters = {} if unit.commissioned else {name: p for name, p in unit.declared.items() if name not in held}
    parameters = parameters | of_effects(start, unit.of_another_structure)
    known = unit.scatter.carried if unit.scatter else Scatter.stated(measured.layout)
    fixed = _Fixed(measured, unit, start, parameters, known, allowed or Allowed.nothing(measured.values.size))
    estimated: Scatter | None = None
    for _ in range(turns if fixed.has_repeats else min(turns, MOST_TURNS_UNREPEATED)):
        found, assumed = _turn(fixed, begin, estimated)
        by = found.errors.alone.divergence(found.scattering(assumed).errors.alone)
        if by < SAME_SCATTER * found.calibrated.lack_of_fit and found.calibrated.settled:
            break
        begin, estimated = found.calibrated.position, found.scatter
    return found


class _Fixed(NamedTuple):
    """What is the same in all turns of a fit: ``start`` is its model where parameters are counted from, ``known`` the
    errors of single recordings as they were known before it.
    """

    measured: Measured
    unit: Unit
    start: Model
    parameters: dict[str, Declared]
    known: Scatter
    allowed: Allowed

    @property
    def has_repeats(self) -> bool:
        """Whether repeats, here or in the commissioning, determine the errors of single recordings."""
        return self.unit.scatter is not None or self.measured.spare > 0

    def completed(self, estimated: Scatter) -> Scatter:
        """An estimate with what recordings cannot show."""
        return estimated if self.measured.temperature_recorded else estimated.with_unrecorded_temperature


def _turn(fixed: _Fixed, begin: Mapping[str, float], assumed: Scatter | None) -> tuple[Fitted, Scatter]:
    """Fit the parameters with assumed errors of single recordings, then estimate these errors again.

    If none are given, repeats determine them before the fit, as differences between repeats depend little on the
    parameters. Derivatives are those of the model at the start values [prior standard deviations].

    Returns
    -------
    Fitted
    Scatter
        The assumed errors.
    """
    measured, unit, here = fixed.measured, fixed.unit, at(fixed.start, fixed.parameters, begin)
    narrow = narrow_band.columns(
        unit.bands, [each.point for each in measured.recordings], measured.layout, measured.variance
    )
    noise = RecordingCovariance(unit.inflated(measured.variance), narrow)
    moves = scatter.of_recordings(here, measured)
    unsure = unit.left_open(here, measured.situations, measured.layout)
    offset = measured.rows(unsure.shift)
    left = np.hstack([measured.rows(unsure.columns), measured.rows(unsure.undetermined)])
    more = np.hstack([left, *fixed.allowed])
    of_sessions = measured.session_columns(unsure.predicted)
    values = measured.values - offset.reshape(measured.values.shape)
    trends = scatter.trends(moves, [measured.situations[i] for i in measured.of_recording], measured.layout)

    def by_repeats(predicted: Float[np.ndarray, "situation feature"]) -> Scatter:
        residual = values - predicted[measured.of_recording]
        return fixed.completed(repeats.from_repeats(residual, noise, moves, trends, measured.repeats, fixed.known))

    if assumed is None:
        assumed = by_repeats(unsure.predicted) if fixed.has_repeats else fixed.known
    calibrated = calibrate(
        fixed.start, fixed.parameters, values,
        Covariance(noise.beside(assumed.columns(moves)), of_sessions).with_columns(more),
        measured.situations, measured.of_recording, measured.layout, begin,
    )  # fmt: skip
    if fixed.has_repeats:
        estimated = by_repeats(calibrated.predicted)
    else:
        residual = measured.values.ravel() - offset - measured.rows(calibrated.predicted)
        J = measured.rows(calibrated.J).reshape(residual.size, -1)
        common = Covariance(noise, np.hstack([of_sessions, more, J]))
        from_start = residual + J @ np.array(list(calibrated.position.values()))
        estimated = fixed.completed(repeats.from_all(from_start, common, moves, trends, fixed.known))
    errors = Covariance(noise.beside(estimated.columns(moves)), of_sessions)
    fitted = Fitted(
        measured, unit, fixed.parameters, calibrated, estimated,
        errors=errors, open=left, offset=offset, allowed=fixed.allowed,
    )  # fmt: skip
    return fitted, assumed


def at_plausible_parameters(now: Fitted) -> Fitted:
    """A fit as the start of a search: at the declared parameters if a bad fit moved them improbably far.

    With such parameters the signature of a nonlinear effect, such as clipping, would be wrong. The errors of single
    recordings stay as estimated.
    """
    improbable = max((abs(by) for by in now.position_of_unit.values()), default=0.0) > IMPROBABLE
    if not improbable or max(now.misfit.values()) < MISFIT:
        return now
    start = now.unit.model.plus(*now.added)
    declared = linearised(start, now.parameters, now.measured.situations, now.measured.layout)
    return replace(now, calibrated=Calibrated(start, dict.fromkeys(now.parameters, 0.0), *declared, settled=True))


def extended(now: Fitted, added: Sequence[Effect]) -> Fitted:
    """A fit with further effects, which are fitted along; those it has begin where they were found.

    What is left open of their form is so only once all have moved without: else it would hold them where they lay
    without the further ones, which then contradict themselves. Where lines differ one by one, they always are: without,
    the fit would follow the lines that the library has not.
    """
    model = now.unit.model.plus(*now.added, *added)
    # Parameters of effects are counted from where the effects are, so only the unit's keep their position.
    position = now.position_of_unit
    if added and now.allowed.forms.any() and not any(map(now.unit.opens, (*now.added, *added))):
        ahead = fit(now.measured, now.unit, model, position=position, allowed=now.closed.allowed, turns=1)
        position = ahead.calibrated.position
    return fit(now.measured, now.unit, model, position=position, allowed=now.allowed)
