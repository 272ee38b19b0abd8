"""Factors on the response of the gauges to waves around the circumference: what another structure can change.

A flex spline repeats around its circumference, whoever models it. So a load of n waves strains it in n waves. Another
structure only changes how large they are and how far they are turned, equally at all gauges of one kind:

    s_i = g_i * sum over n of [G_u(n) u_n + G_t(n) F_n] exp(i n theta_i)

Here u_n is the displacement that the wave generator imposes, F_n the tooth forces, and g_i the gain of gauge i at
theta_i. The factors are relative to the truss of this project. Its finite mesh makes them 1 to 2 %; on the truss of
another author they differed by a factor of two, with a smooth course over n.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

# Wave numbers with factors, from 0: those of the orders 0 to 12 that a loop compares.
WAVES = 13
# Those that the arms of s0 do not cancel; see LAYOUT of the gauges.
SEEN_BY_S0 = (0, 4, 8, 12)


@dataclass(frozen=True)
class StructureFactors:
    """Natural logarithms of the amplitudes for n = 0 .. WAVES - 1, then as many phases [rad] except for the compliance.

    An empty tuple stands for factors of 1. The bridge s0 has its own arms, so it has factors of its own.

    Attributes
    ----------
    wave_generator, teeth : tuple of float
        On what s1 to s4 show of the imposed displacement, and of the tooth forces.
    wave_generator_s0, teeth_s0 : tuple of float
        The same of s0.
    compliance : tuple of float
        On how far radial and tooth forces displace the sleeve; it matters where the wave generator only presses.
    """

    wave_generator: tuple[float, ...] = ()
    teeth: tuple[float, ...] = ()
    wave_generator_s0: tuple[float, ...] = ()
    teeth_s0: tuple[float, ...] = ()
    compliance: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        for name, values in vars(self).items():
            count = WAVES if name == "compliance" else 2 * WAVES
            if len(values) not in (0, count) or not np.all(np.isfinite(values)):
                raise ValueError(
                    f"factors of the structure: {name} has {values}, must have none or {count} finite values"
                )

    def applied(self, response: Complex[np.ndarray, "order 5 load"]) -> Complex[np.ndarray, "order 5 load"]:
        """A gauge response whose first two loads, wave generator and teeth, are multiplied by the factors."""
        changed = response.copy()
        for load, (of_s0, of_others) in enumerate(
            ((self.wave_generator_s0, self.wave_generator), (self.teeth_s0, self.teeth))
        ):
            if of_s0:
                changed[:WAVES, 0, load] *= _complex(of_s0)
            if of_others:
                changed[:WAVES, 1:, load] *= _complex(of_others)[:, None]
        return changed

    def softened(self, compliance: Complex[np.ndarray, "order load"]) -> Complex[np.ndarray, "order load"]:
        """The compliance of the sleeve multiplied by the factors on it."""
        changed = compliance.copy()
        if self.compliance:
            changed[:WAVES] *= np.exp(self.compliance)[:, None]
        return changed


def _complex(logs: tuple[float, ...]) -> Complex[np.ndarray, " wave"]:
    """Factors from the logarithms of their amplitudes and their phases."""
    return np.exp(np.array(logs[:WAVES]) + 1j * np.array(logs[WAVES:]))


# The structure that the truss describes exactly.
EXACT_STRUCTURE = StructureFactors()


def smooth_modes(reach: float, least: float) -> Float[np.ndarray, "mode wave"]:
    """Independent parts of a random course over n that is smooth, one standard deviation each.

    They are the eigenvectors of the covariance exp(-d^2 / (2 reach^2)) of two wave numbers at a distance d, each times
    the root of its eigenvalue. Modes below a share ``least`` of the largest are omitted.
    """
    n = np.arange(WAVES)
    values, vectors = np.linalg.eigh(np.exp(-((n[:, None] - n) ** 2) / (2 * reach**2)))
    deviations = np.sqrt(np.maximum(values, 0.0))
    kept = deviations > least * deviations.max()
    return (deviations[kept] * vectors[:, kept]).T[::-1]
