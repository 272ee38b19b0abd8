"""Features of recordings: order lines of every channel over the angle of the wave generator.

A recording becomes one vector: channel by channel the mean, the cosine parts and the sine parts of the orders 1 to
ORDERS, fitted by least squares over all its samples. So neither the speed ripple nor a window that ends within a
revolution matters, and a phase belongs to the angle, not to the time. A steady drift over the recording is fitted along
and left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Complex, Float

from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

# Highest order that is compared; and highest order that is fitted, to prevent leakage.
ORDERS = 12
FITTED = 16
# Smallest number of samples per revolution that separates all these orders.
DENSE = 2 * FITTED + 1
# Revolutions from which on a drift is fitted along; over fewer, it looks like ripple of order 1.
TURNS_FOR_DRIFT = 2.0
# The angle itself is what all other channels are plotted against.
COMPARED = ("n_in", "T_in", "T_out", "s0", "s1", "s2", "s3", "s4")


@dataclass(frozen=True)
class Layout:
    """What each number of a feature vector is.

    Attributes
    ----------
    channels : tuple of str
    """

    channels: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.channels) * (2 * ORDERS + 1)

    @property
    def channel(self) -> np.ndarray:
        """Channel of each feature."""
        return np.repeat(np.array(self.channels), 2 * ORDERS + 1)

    @property
    def order(self) -> np.ndarray:
        """Order of each feature."""
        one = np.concatenate([[0], np.arange(1, ORDERS + 1), np.arange(1, ORDERS + 1)])
        return np.tile(one, len(self.channels))

    @property
    def of_gauges(self) -> Bool[np.ndarray, " feature"]:
        """Whether each feature is of a gauge."""
        return np.isin(self.channel, SENSORS)

    @property
    def of_drive(self) -> Bool[np.ndarray, " feature"]:
        """Whether each feature is of speed or torque."""
        return ~self.of_gauges

    def of(self, recordings: Sequence[Recording]) -> Float[np.ndarray, "recording feature"]:
        """The feature vectors of recordings of equal length; other layouts observe something else."""
        return features_alike(recordings, self)

    def lines(self, features: Float[np.ndarray, "*batch feature"]) -> Complex[np.ndarray, "*batch channel order"]:
        """Complex order lines of feature vectors; signal = Re(sum of lines[k] exp(i k phi))."""
        parts = features.reshape(*features.shape[:-1], len(self.channels), 2 * ORDERS + 1)
        lines = parts[..., : ORDERS + 1].astype(complex)
        lines[..., 1:] -= 1j * parts[..., ORDERS + 1 :]
        return lines

    def vector(self, lines: Complex[np.ndarray, "*batch channel order"]) -> Float[np.ndarray, "*batch feature"]:
        """Feature vectors of complex order lines."""
        parts = along_basis(lines)
        return parts.reshape(*parts.shape[:-2], -1)

    def turning(self, features: Float[np.ndarray, "*batch feature"]) -> Float[np.ndarray, "*batch feature"]:
        """Change of feature vectors by a radian by which the angle is taken too low."""
        return self.vector(1j * np.arange(ORDERS + 1) * self.lines(features))


def layout_of(recordings: Sequence[Recording]) -> Layout:
    """The channels that all recordings have."""
    return Layout(tuple(name for name in COMPARED if all(name in r.channels for r in recordings)))


def basis(phi: Float[np.ndarray, "*batch time"], orders: int) -> Float[np.ndarray, "*batch time column"]:
    """One, then cosines, then sines of the orders 1 to `orders`."""
    turns = np.multiply.accumulate(np.repeat(np.exp(1j * phi)[..., None], orders, axis=-1), axis=-1)
    return np.concatenate([np.ones((*phi.shape, 1)), turns.real, turns.imag], axis=-1)


def along_basis(lines: Complex[np.ndarray, "*batch order"]) -> Float[np.ndarray, "*batch column"]:
    """What complex order lines have along the columns of :func:`basis`; a mean is real."""
    return np.concatenate([lines.real, -lines.imag[..., 1:]], axis=-1)


def features(recording: Recording, layout: Layout) -> Float[np.ndarray, " feature"]:
    """The feature vector of a recording.

    Raises
    ------
    ValueError
        If a revolution has too few samples for the orders that are fitted.
    """
    return features_alike([recording], layout)[0]


def features_alike(recordings: Sequence[Recording], layout: Layout) -> Float[np.ndarray, "recording feature"]:
    """The feature vectors of recordings of equal length; raises like :func:`features`."""
    values = np.array([_values(each, layout) for each in recordings])
    # Many runs of a model have the same motion, which decides how values become coefficients.
    angles = {each.channels["phi_in"].tobytes(): each.channels["phi_in"] for each in recordings}
    row = {key: number for number, key in enumerate(angles)}
    columns = fitted_columns(np.array(list(angles.values())))
    across = columns.swapaxes(-1, -2)
    kept = np.concatenate([np.arange(ORDERS + 1), FITTED + 1 + np.arange(ORDERS)])
    fitting = np.linalg.solve(across @ columns, across)[:, kept]
    found = fitting[[row[each.channels["phi_in"].tobytes()] for each in recordings]] @ values
    return found.transpose(0, 2, 1).reshape(len(recordings), -1)


def fitted_columns(phi: Float[np.ndarray, "*batch time"]) -> Float[np.ndarray, "*batch time column"]:
    """The orders that are fitted and, over several revolutions, a straight line: a drift of the speed is no ripple."""
    orders, turned = basis(phi, FITTED), phi[..., -1:] - phi[..., :1]
    if np.abs(turned).min() < 2 * np.pi * TURNS_FOR_DRIFT:
        return orders
    return np.concatenate([orders, ((phi - phi.mean(axis=-1, keepdims=True)) / turned)[..., None]], axis=-1)


def remainder(recording: Recording, layout: Layout) -> Float[np.ndarray, "channel time"]:
    """Remainder of every channel after the integer orders up to FITTED; raises like :func:`features`."""
    columns = fitted_columns(recording.channels["phi_in"])
    values = _values(recording, layout)
    return (values - columns @ np.linalg.solve(columns.T @ columns, columns.T @ values)).T


def samples_per_turn(recording: Recording) -> float:
    """Samples per revolution of the wave generator."""
    angle = recording.channels["phi_in"]
    return 2 * np.pi * (len(angle) - 1) / abs(float(angle[-1] - angle[0]))


def _require_dense(recording: Recording) -> None:
    dense = samples_per_turn(recording)
    if dense < DENSE:
        enough = np.ceil(recording.rate * (DENSE + 1) / dense)
        raise ValueError(
            f"recording {recording.name}: {dense:.1f} samples per revolution of the wave generator, at least {DENSE} "
            f"are needed to see the orders up to {FITTED}: sample at {enough:.0f} Hz or more, or leave this speed out"
        )


def _values(recording: Recording, layout: Layout) -> Float[np.ndarray, "time channel"]:
    _require_dense(recording)
    return np.array([recording.channels[name] for name in layout.channels]).T
