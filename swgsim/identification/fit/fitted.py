"""A model as fitted to recordings: its parameters, the errors of single recordings, and what stays unexplained."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import Effect
from swgsim.identification.covariance.low_rank_covariance import Covariance, significant_columns
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.measured import Measured
from swgsim.identification.data.model import Model
from swgsim.identification.fit.map_fit import Calibrated
from swgsim.identification.fit.priors import Declared
from swgsim.identification.fit.unit import Unit


class Allowed(NamedTuple):
    """Additional nuisance directions, one standard deviation each.

    Attributes
    ----------
    free : array (row, regularity)
        Regularities that were set free, and imperfect forms without which an effect is not seen. They stay open when
        effects are added to the model.
    forms : array (row, form)
        By what effects found earlier may differ from the library's form. A fit that may move these effects closes them.
    """

    free: Float[np.ndarray, "row regularity"]
    forms: Float[np.ndarray, "row form"]

    @classmethod
    def nothing(cls, rows: int) -> "Allowed":
        """So many rows without columns."""
        return cls(np.zeros((rows, 0)), np.zeros((rows, 0)))

    @property
    def columns(self) -> Float[np.ndarray, "row column"]:
        """All of them."""
        return np.hstack(self)


@dataclass(frozen=True, eq=False)
class Fitted:
    """A model that is fitted to measurements.

    The covariance of the residual is built in four steps. Each step adds directions that may deviate:

    =====================  ================================================  =========================================
    covariance             holds                                             describes
    =====================  ================================================  =========================================
    :attr:`errors`         noise, errors of single recordings, of sessions   recordings of a gear that is known exactly
    :attr:`of_unit`        the same and :attr:`open`                         the unit, effects having the library's form
    :attr:`of_nuisances`   the same and both parts of :attr:`allowed`        all but the fitted parameters
    :attr:`whole`          the same and :attr:`J`, the fitted parameters     :attr:`from_start`
    =====================  ================================================  =========================================

    Four methods return the same fit with another :attr:`allowed`. :meth:`allowing` adds to its part ``free``, and
    :meth:`allowing_forms` to its part ``forms``. :attr:`closed` empties ``forms``, and :attr:`strict` empties both.

    :attr:`residual` belongs to the fitted parameters. :attr:`from_start` belongs to the prior means of the parameters,
    by the linearised model; :attr:`whole` is its covariance.

    Attributes
    ----------
    measured : Measured
    unit : Unit
    parameters : mapping
        Fitted parameters with their prior standard deviations.
    calibrated : Calibrated
    scatter : Scatter
    errors : Covariance
        Noise, errors of single recordings and of sessions; rows (recording, feature).
    open : array (row, direction)
        Nuisance directions of the unit besides the fitted parameters (:meth:`Unit.left_open`), one standard deviation
        each.
    offset : array (row,)
        Offset of the recordings from the model as found by commissioning, for example by lags and zeros.
    allowed : Allowed
    """

    measured: Measured
    unit: Unit
    parameters: dict[str, Declared]
    calibrated: Calibrated
    scatter: Scatter
    errors: Covariance
    open: Float[np.ndarray, "row direction"]
    offset: Float[np.ndarray, " row"]
    allowed: Allowed

    @property
    def model(self) -> Model:
        """The model at its likeliest parameters."""
        return self.calibrated.model

    @property
    def added(self) -> tuple[Effect, ...]:
        """The effects that the model has beyond the unit's."""
        return tuple(self.model.effects[number] for number in self.numbers_added)

    @property
    def numbers_added(self) -> range:
        """Their numbers among the effects of the model."""
        return range(len(self.unit.model.effects), len(self.model.effects))

    @property
    def declared(self) -> dict[str, Declared]:
        """The fitted parameters that are the unit's own; none once it is commissioned."""
        return {name: parameter for name, parameter in self.parameters.items() if ": " not in name}

    @property
    def position_of_unit(self) -> dict[str, float]:
        """Deviation of the unit's parameters from their declared values, in spreads."""
        return {name: self.calibrated.position[name] for name in self.declared}

    @property
    def strict(self) -> "Fitted":
        """The same with both parts of :attr:`allowed` empty, for predictions.

        What effects and regularities found earlier leave open is not in it.
        """
        return self._with_allowed(Allowed.nothing(len(self.offset)))

    @property
    def closed(self) -> "Fitted":
        """The same with the part ``forms`` of :attr:`allowed` empty, for a fit that may move the effects."""
        return self._with_allowed(self.allowed._replace(forms=self.allowed.forms[:, :0]))

    @property
    def without_free(self) -> "Fitted":
        """The same with the part ``free`` of :attr:`allowed` empty."""
        return self._with_allowed(self.allowed._replace(free=self.allowed.free[:, :0]))

    def allowing(self, columns: Float[np.ndarray, "row column"]) -> "Fitted":
        """The same with more columns in the part ``free`` of :attr:`allowed`, one standard deviation each.

        They stay open when effects are added. Fewer columns with the same covariance may stand for them, where noise
        hides the difference.
        """
        return self._with_allowed(self.allowed._replace(free=self._with_more(self.allowed.free, columns)))

    def allowing_forms(self, columns: Float[np.ndarray, "row column"]) -> "Fitted":
        """The same with more columns in the part ``forms`` of :attr:`allowed`."""
        return self._with_allowed(self.allowed._replace(forms=self._with_more(self.allowed.forms, columns)))

    def _with_more(
        self, known: Float[np.ndarray, "row known"], columns: Float[np.ndarray, "row column"]
    ) -> Float[np.ndarray, "row all"]:
        return np.hstack([known, significant_columns(columns, self.errors.variance)])

    def _with_allowed(self, allowed: Allowed) -> "Fitted":
        if [columns.shape for columns in allowed] == [columns.shape for columns in self.allowed]:
            return self  # columns come, or go all at once
        found = replace(self, allowed=allowed)
        vars(found)["of_unit"] = self.of_unit  # unchanged, and most of the computing time
        return found

    def scattering(self, scatter: Scatter) -> "Fitted":
        """The same with other errors of single recordings."""
        kinds = len(scatter.sd)
        ratio = np.ones(self.errors.alone.C.shape[-1])
        ratio[:kinds] = np.array(list(scatter.sd.values())) / np.array(list(self.scatter.sd.values()))
        alone = replace(self.errors.alone, C=self.errors.alone.C * ratio)
        return replace(self, scatter=scatter, errors=replace(self.errors, base=alone))

    def with_zeros(self, times: float) -> "Fitted":
        """The same with the zeros of gauges so many times as far off as declared.

        The columns keep their order, by which predictions know them.
        """
        if times == self.measured.zeros:
            return self
        measured = replace(self.measured, zeros=times)
        errors = replace(self.errors, G=measured.session_columns(self.calibrated.predicted))
        return replace(self, measured=measured, errors=errors)

    @cached_property
    def residual(self) -> Float[np.ndarray, " row"]:
        """Measured less predicted at the likeliest parameters."""
        return self.measured.values.ravel() - self.offset - self.measured.rows(self.calibrated.predicted)

    @cached_property
    def J(self) -> Float[np.ndarray, "row parameter"]:
        """Change by one spread of each fitted parameter."""
        return self.measured.rows(self.calibrated.J).reshape(len(self.errors.variance), len(self.parameters))

    @cached_property
    def of_unit(self) -> Covariance:
        """Covariance of all errors and of the nuisance directions of the unit, :attr:`open`."""
        return self.errors.with_columns(self.open)

    @property
    def of_nuisances(self) -> Covariance:
        """Covariance of all errors and of all nuisance directions, :attr:`open` and :attr:`allowed`.

        The fitted parameters are not in it.
        """
        return self.of_unit.with_columns(self.allowed.columns)

    @cached_property
    def whole(self) -> Covariance:
        """Covariance of all that the model does not know exactly: :attr:`of_nuisances` and the fitted parameters."""
        return self.of_nuisances.with_columns(self.J)

    @property
    def from_start(self) -> Float[np.ndarray, " row"]:
        """Residual of the linearised model at the prior means of the parameters; :attr:`whole` is its covariance."""
        return self.residual + self.J @ np.array(list(self.calibrated.position.values()))

    @cached_property
    def by_others(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """The rows of every operating point (a mask), and the directions of :attr:`whole` as all other rows tell them;
        none if there is one point only.
        """
        blocks = self.measured.point_rows()
        return self._told(blocks) if len(blocks) > 1 else []

    @cached_property
    def by_other_recordings(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """The same of every recording that has repeats."""
        return self._told(self.measured.repeat_rows())

    def _told(self, blocks: Sequence[np.ndarray]) -> list[tuple[np.ndarray, np.ndarray]]:
        return list(zip(blocks, self.whole.left_out(self.from_start, blocks), strict=True))

    @cached_property
    def nuisance(self) -> Float[np.ndarray, " row"]:
        """Nuisance parameters of every operating point, estimated from all others: zeros and gains, the gear,
        effects found earlier. Zero with one operating point.
        """
        return self.nuisance_by(self.by_others)

    def nuisance_by(self, told: Sequence[tuple[np.ndarray, np.ndarray]]) -> Float[np.ndarray, " row"]:
        """The same for other blocks of rows, estimated from all rows outside each block; zero outside the blocks."""
        made, columns = np.zeros(len(self.residual)), self.of_nuisances.columns
        for block, directions in told:
            made[block] = columns[block] @ directions[: columns.shape[1]]
        return made

    @cached_property
    def missed(self) -> Float[np.ndarray, "recording feature"]:
        """Residual in declared standard deviations."""
        return self.whole.whiten_in_place(self.from_start).reshape(self.measured.values.shape)

    @property
    def misfit(self) -> dict[str, float]:
        """Mean square of every channel's residual in declared variances: 1 where the model is right."""
        layout = self.measured.layout
        square = (self.missed**2).mean(axis=0)
        return {channel: float(square[layout.channel == channel].mean()) for channel in layout.channels}

    @cached_property
    def deviation(self) -> dict[str, float]:
        """Standard deviation of each fitted parameter, in its unit."""
        # The form tolerance of an effect is no doubt about its own size.
        return self.deviation_under(self.of_unit)

    def deviation_under(self, errors: Covariance) -> dict[str, float]:
        """The same, with errors of the residual that are given."""
        columns = errors.whiten(self.J)
        covariance = np.linalg.inv(columns.T @ columns + np.eye(columns.shape[1]))
        spread = np.sqrt(np.diag(covariance)).tolist()
        return {name: s * p.sd for (name, p), s in zip(self.parameters.items(), spread, strict=True)}

    @cached_property
    def white(self) -> Float[np.ndarray, " row"]:
        """Residual of the linearised model, whitened by its covariance."""
        return self.whole.whiten(self.from_start)

    @cached_property
    def weighed(self) -> Float[np.ndarray, " row"]:
        """Residual of the linearised model, weighed by the inverse of its covariance."""
        return self.whole.weigh(self.from_start)

    def null(self, draws: int, rng: np.random.Generator) -> Iterator[Float[np.ndarray, "row draw"]]:
        """What pure noise makes of :attr:`weighed`, so many draws at a time, without end.

        The errors of single recordings are in each draw as large as their estimate leaves them; all others are as
        declared.
        """
        alone, G = self.whole.alone, self.whole.columns
        deviation = np.sqrt(self.whole.variance)[:, None]
        while True:
            factors = np.ones((len(self.measured), alone.C.shape[-1], draws))
            factors[:, : len(self.scatter.sd)] = self.scatter.drawn(rng, draws)
            noise = deviation * rng.standard_normal((len(G), draws))
            single = alone.made((factors * rng.standard_normal(factors.shape)).reshape(-1, draws))
            yield self.whole.weigh(noise + single + G @ rng.standard_normal((G.shape[1], draws)))

    @cached_property
    def log_likelihood(self) -> float:
        """Of all recordings together, everything that is not known exactly being open within its spread."""
        return -0.5 * (float(self.white @ self.white) + self.whole.log_determinant)
