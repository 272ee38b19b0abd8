"""What was measured, made ready for the loop: features, situations, noise, and the model calibrated to it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.loop import scatter
from swgsim.loop.calibration import Calibrated, calibrate
from swgsim.loop.declared import Declared, at, of_effects, of_unit
from swgsim.loop.features import ORDERS, Layout, features, layout_of
from swgsim.loop.gaussian import Covariance
from swgsim.loop.model import Model, Situation, predict
from swgsim.loop.noise import white_variance
from swgsim.loop.scatter import Scatter
from swgsim.recording import Recording

# Errors of a whole session, as standard deviations: zeros of the torque flanges [N m], the index of the angle [rad].
OF_SESSION = {"zero of T_in": 0.003, "zero of T_out": 0.2, "index": 0.02}


@dataclass(frozen=True, eq=False)
class Measured:
    """Recordings as the loop sees them.

    Attributes
    ----------
    recordings : tuple of Recording
    layout : Layout
    values : array (recording, feature)
    variance : array (recording, feature)
        Of the white noise.
    """

    recordings: tuple[Recording, ...]
    layout: Layout
    values: Float[np.ndarray, "recording feature"]
    variance: Float[np.ndarray, "recording feature"]

    @classmethod
    def of(cls, recordings: Sequence[Recording]) -> "Measured":
        """From recordings, with the channels that all of them have."""
        layout = layout_of(recordings)
        values = np.array([features(recording, layout) for recording in recordings])
        return cls(tuple(recordings), layout, values, white_variance(recordings, layout))

    @cached_property
    def situations(self) -> tuple[Situation, ...]:
        """Distinct operating points and conditions."""
        return tuple(dict.fromkeys(Situation(r.point, r.conditions) for r in self.recordings))

    @cached_property
    def of_recording(self) -> np.ndarray:
        """Situation of each recording."""
        return np.array([self.situations.index(Situation(r.point, r.conditions)) for r in self.recordings])

    @property
    def points(self) -> list[object]:
        """Session, operating point of each recording: recordings with the same ones are repeats."""
        return [(r.session, r.point) for r in self.recordings]

    def of_session(self, predicted: Float[np.ndarray, "recording feature"]) -> Float[np.ndarray, "row column"]:
        """Errors that all recordings of a session share, one standard deviation each."""
        columns = []
        for session in dict.fromkeys(r.session for r in self.recordings):
            here = np.array([r.session == session for r in self.recordings])[:, None]
            for name, sd in OF_SESSION.items():
                if name == "index":
                    turned = self.layout.vector(1j * np.arange(ORDERS + 1) * self.layout.lines(predicted))
                elif name.removeprefix("zero of ") in self.layout.channels:
                    channel = name.removeprefix("zero of ")
                    turned = ((self.layout.channel == channel) & (self.layout.order == 0))[None, :] * np.ones(
                        (len(here), 1)
                    )
                else:
                    continue
                columns.append((sd * here * turned).ravel())
        return np.stack(columns, axis=1)


@dataclass(frozen=True, eq=False)
class Fitted:
    """A model calibrated to what was measured, with all that a question about the residual needs.

    Attributes
    ----------
    measured : Measured
    parameters : mapping
        Declared parameters with their spread.
    calibrated : Calibrated
    scatter : Scatter
    errors : Covariance
        Noise, errors of single recordings and of sessions; rows (recording, feature).
    """

    measured: Measured
    parameters: dict[str, Declared]
    calibrated: Calibrated
    scatter: Scatter
    errors: Covariance

    @property
    def residual(self) -> Float[np.ndarray, " row"]:
        """Measured less predicted."""
        m = self.measured
        return (m.values - self.calibrated.predicted[m.of_recording]).ravel()

    @property
    def J(self) -> Float[np.ndarray, "row parameter"]:
        """Change by one spread of each declared parameter."""
        return self.calibrated.J[self.measured.of_recording].reshape(len(self.errors.variance), -1)

    @cached_property
    def posterior(self) -> Float[np.ndarray, "parameter parameter"]:
        """Covariance of the declared parameters after the fit, in units of their spread."""
        columns = self.errors.whiten(self.J)
        return np.linalg.inv(columns.T @ columns + np.eye(columns.shape[1]))


def fit(
    measured: Measured,
    nominal: Model,
    *,
    position: Mapping[str, float] | None = None,
    known: Scatter | None = None,
) -> Fitted:
    """Calibrate what the model declares and estimate the errors of single recordings, in turns.

    Parameters
    ----------
    measured : Measured
    nominal : Model
        With the effects that are to be fitted along, at their first values.
    position : mapping, optional
        Where the declared parameters begin, in spreads.
    known : Scatter, optional
        Errors of single recordings from an earlier fit; then one turn is enough.
    """
    parameters = of_unit(nominal.gear) | of_effects(nominal)
    guess = known or Scatter({kind: scatter.STATED[kind] for kind in scatter.kinds(measured.layout)}, 0)
    model, start = at(nominal, parameters, position or {}), position
    for _ in range(1 if known else 2):
        moves = scatter.directions(model, measured.situations, measured.layout)[measured.of_recording]
        errors = _errors(measured, guess.columns(moves), model)
        calibrated = calibrate(
            nominal, parameters, measured.values, errors, measured.situations, measured.of_recording,
            measured.layout, start,
        )  # fmt: skip
        residual = measured.values - calibrated.predicted[measured.of_recording]
        guess = scatter.estimate(residual, measured.variance, moves, measured.points, measured.layout)
        model, start = calibrated.model, calibrated.position
    return Fitted(measured, parameters, calibrated, guess, _errors(measured, guess.columns(moves), model))


def _errors(measured: Measured, columns: np.ndarray, model: Model) -> Covariance:
    """Noise, errors of single recordings and of sessions."""
    predicted = predict([model], measured.situations, measured.layout)[0][measured.of_recording]
    alone = scatter.covariance(measured.variance, columns)
    return alone.with_columns(measured.of_session(predicted))
