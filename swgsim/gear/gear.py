"""A gear and its operating point: immutable, SI units, the paper's symbols."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from pathlib import Path
from typing import Any

from swgsim.common.build import build, replaced
from swgsim.common.checks import require, require_integer, require_positive
from swgsim.common.configured import conf_folder
from swgsim.flexspline.gauges import GaugeSet
from swgsim.flexspline.silk_hat import SilkHat
from swgsim.flexspline.structure_factors import EXACT_STRUCTURE, StructureFactors
from swgsim.gear.gear_file import gear_values

# Strokes of wave generators of this size [m].
W0_LIMITS = (1e-5, 1e-3)
# Interference of wave generator and sleeve, mean radius to mean radius [m].
INTERFERENCE_LIMITS = (-1e-4, 1e-4)


@dataclass(frozen=True)
class KinematicError:
    """One harmonic of the kinematic error, A sin(order phi_in + phase), amplitude at the output [rad]."""

    order: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        owner = "the kinematic error"
        require_integer(owner, "order", self.order, low=1, high=20)
        require(owner, "amplitude", self.amplitude, low=0, high=0.01)
        require(owner, "phase", self.phase)


@dataclass(frozen=True)
class Transmission:
    """Parameters of the dynamic input/output model, eqs. (1)-(6).

    The defaults fit the catalogue of a size 17, ratio 100 gear (physics.md section 1.3): stiffness K1-K3 up to 70 Nm,
    no-load running and starting torque, efficiency at rated torque. Two are set otherwise: ``b1`` to claim C6 of the
    paper (see conf/gear), and the load inertia ``J_out``, an estimate for a link-sized test bench load, whose
    resonance with the gear stays below the first order of the slower operating speed.

    Attributes
    ----------
    N : int
        Catalogue gear ratio. With the flex spline clamped the output turns N + 1 times slower than the input.
    alpha_tooth : float
        Gear-tooth angle [rad].
    k1, k2 : float
        Stiffness, eq. (2) [N m/rad], [N m/rad^3].
    b0, b1, b2, b3, theta_b, mu : float
        Friction, eq. (5) [N m], [N m s/rad], [N m s^3/rad^3], [N m], [rad], [-].
    J_in, J_out : float
        Inertia of rotor and wave generator, of output and load [kg m^2].
    rotor_share : float
        Share of J_in on the motor's side of the torque flange at the input, from 0 (the flange feels what the motor
        does) to 1 (what brakes the wave generator); depends on the test bench.
    load_share : float
        Share of J_out on the gear's side of the torque flange at the output, from 0 (the flange feels what the gear
        transmits, with its ripple) to 1 (what the brake does); depends on the test bench.
    kinematic_error : tuple of KinematicError
    error_lever : float
        Share of the kinematic error's slope that is part of the input's lever: 1 by virtual work, 0 where the error is
        one of position alone, as in some published equations (physics.md section 1.1).
    control_frequency, control_damping : float
        Speed control of the input: natural frequency [Hz] and damping ratio of the loop on J_in; estimates.
    """

    N: int = 100
    alpha_tooth: float = pi / 6
    k1: float = 4733.0
    k2: float = 8.70e6
    b0: float = 1.403
    b1: float = 0.52
    b2: float = 0.0
    b3: float = 0.07
    theta_b: float = 0.6
    mu: float = 0.0562
    J_in: float = 1.2e-4
    J_out: float = 1.0
    rotor_share: float = 0.0
    load_share: float = 0.0
    kinematic_error: tuple[KinematicError, ...] = (
        KinematicError(1, 0.4e-4, 0.3),
        KinematicError(2, 0.7e-4, 1.1),
        KinematicError(4, 0.3e-4, 2.0),
    )
    error_lever: float = 1.0
    control_frequency: float = 10.0
    control_damping: float = 1.0

    def __post_init__(self) -> None:
        owner = "the transmission"
        require_integer(owner, "N", self.N, low=30, high=320)
        positive = ("k1", "J_in", "J_out", "control_frequency", "control_damping")
        require_positive(owner, **{name: getattr(self, name) for name in positive})
        for name in ("k2", "b0", "b1", "b3", "mu"):
            require(owner, name, getattr(self, name), low=0)
        require(owner, "b2", self.b2)
        require(owner, "theta_b", self.theta_b)
        for name in ("rotor_share", "load_share", "error_lever"):
            require(owner, name, getattr(self, name), low=0, high=1)
        require(owner, "alpha_tooth", self.alpha_tooth, low=0.05, high=1.5)


@dataclass(frozen=True)
class WaveGenerator:
    """Elliptical wave generator.

    Attributes
    ----------
    w0 : float
        Radial deflection of the sleeve at the major axis [m]; nominal value is the module.
    presses_only : bool
        Whether the sleeve may lift off (:mod:`swgsim.chain.contact`). In the paper's chain it follows the wave
        generator all around.
    interference : float
        By how much the mean radius of the wave generator is larger than the bore of the sleeve [m]; negative with
        clearance. It matters only where the sleeve may lift off.
    """

    w0: float = 0.2159e-3
    presses_only: bool = False
    interference: float = 0.0

    def __post_init__(self) -> None:
        require("the wave generator", "w0", self.w0, *W0_LIMITS)
        require("the wave generator", "interference", self.interference, *INTERFERENCE_LIMITS)
        if self.interference and not self.presses_only:
            raise ValueError(
                f"interference of the wave generator is {self.interference:g} m, which matters only where the sleeve "
                "may lift off: set presses_only to true, or interference to 0"
            )


@dataclass(frozen=True)
class Gear:
    """A gauge-sensorized strain wave gear.

    Attributes
    ----------
    number : int
        Number of the gear, from 1.
    factors : StructureFactors
        By which its structure differs from the truss of the chain.

    Examples
    --------
    >>> Gear()  # doctest: +NORMALIZE_WHITESPACE
    Gear 1: ratio 100, teeth 200, radius 21.2 mm, w0 215.9 µm, k1 4733 N m/rad, b1 0.52 N m s/rad,
        J_out 1 kg m², structure as the truss
    """

    number: int = 1
    transmission: Transmission = field(default_factory=Transmission)
    flex_spline: SilkHat = field(default_factory=SilkHat)
    wave_generator: WaveGenerator = field(default_factory=WaveGenerator)
    gauges: GaugeSet = field(default_factory=GaugeSet)
    factors: StructureFactors = EXACT_STRUCTURE

    def __post_init__(self) -> None:
        require_integer("the gear", "number", self.number, low=1, high=2**31 - 1)
        teeth, N = self.flex_spline.teeth, self.transmission.N
        if teeth != 2 * N:
            raise ValueError(
                f"{teeth} teeth do not fit the ratio N = {N}: with two lobes a flex spline has 2 N = {2 * N}"
            )

    def __repr__(self) -> str:
        return f"Gear {self.number}: {', '.join(f'{name} {text}' for name, text in self._facts().items())}"

    def _repr_html_(self) -> str:
        """HTML of a notebook: a table of what the gear is."""
        rows = "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in self._facts().items())
        return f"<table><caption>Gear {self.number}</caption>{rows}</table>"

    def _facts(self) -> dict[str, str]:
        """The main parameters with their symbols, in engineering units."""
        t = self.transmission
        return {
            "ratio": f"{t.N}",
            "teeth": f"{self.flex_spline.teeth}",
            "radius": f"{1e3 * self.flex_spline.radius:.4g} mm",
            "w0": f"{1e6 * self.wave_generator.w0:.4g} µm",
            "k1": f"{t.k1:.4g} N m/rad",
            "b1": f"{t.b1:.3g} N m s/rad",
            "J_out": f"{t.J_out:.3g} kg m²",
            "structure": "as the truss" if self.factors == EXACT_STRUCTURE else "with factors on the truss",
        }

    @classmethod
    def load(cls, path: str | Path) -> "Gear":
        """Read a gear from a YAML file, or one of conf/gear by its name; numbers are in SI units.

        >>> Gear.load("gear2").number
        2

        Raises
        ------
        ValueError
            If the file is missing, holds no mapping, or a parameter is unknown or beyond its limits.
        """
        try:
            known = conf_folder() / "gear" / f"{path}.yaml"
            return gear_from(gear_values(known if known.is_file() else Path(path)))
        except ValueError as error:
            raise ValueError(f"gear file {path}: {error}") from error

    def with_transmission(self, **changes: Any) -> "Gear":
        """The gear with other values of parameters of :class:`Transmission`.

        >>> Gear().with_transmission(b1=0.4).transmission.b1
        0.4
        """
        return replaced(self, transmission=replaced(self.transmission, **changes))


def gear_from(config: Mapping[str, Any]) -> Gear:
    """A gear from a mapping; a part or parameter that is missing keeps the value of the paper's first gear.

    Raises
    ------
    ValueError
        If a parameter is unknown or beyond its limits.
    """
    transmission = dict(config.get("transmission", {}))
    if "kinematic_error" in transmission:
        transmission["kinematic_error"] = [build(KinematicError, term) for term in transmission["kinematic_error"]]
    parts = {
        "transmission": build(Transmission, transmission),
        "flex_spline": build(SilkHat, config.get("flex_spline", {})),
        "wave_generator": build(WaveGenerator, config.get("wave_generator", {})),
        "gauges": build(GaugeSet, config.get("gauges", {})),
        "factors": build(StructureFactors, config.get("factors", {})),
    }
    return build(Gear, {key: value for key, value in config.items() if key not in parts}, **parts)


# Catalogue limits of SHG-17-100: maximum input speed [rpm] and momentary peak torque [N m].
CATALOGUE_LIMITS = {"n_in_rpm": 7300.0, "T_out": 143.0}


@dataclass(frozen=True)
class OperatingPoint:
    """Imposed speed and load.

    Attributes
    ----------
    n_in_rpm : float
        Desired speed of the wave generator relative to the clamped flex spline, n_in,d [rpm].
    T_out : float
        Desired load torque at the output, T_out,d [N m].
    """

    n_in_rpm: float
    T_out: float

    def __post_init__(self) -> None:
        require("the operating point", "n_in_rpm", self.n_in_rpm, low=10, high=CATALOGUE_LIMITS["n_in_rpm"])
        require("the operating point", "T_out", self.T_out, low=0, high=CATALOGUE_LIMITS["T_out"])

    @property
    def omega_in(self) -> float:
        """Desired angular speed of the wave generator [rad/s]."""
        return self.n_in_rpm * 2 * pi / 60
