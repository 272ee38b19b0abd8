"""The idea of an effect: what it may change, and that it changes nothing else."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import ClassVar, NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.quantity import Role, quantities
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint

# Values over psi, the angle of the wave generator, and theta, the position around the flex spline (both [rad]).
Psi = Float[np.ndarray, " psi"]
Theta = Float[np.ndarray, " theta"]
Field = Float[np.ndarray, "psi theta"]
# Samples of one channel over time, of s0 to s4, and of all channels by name.
Samples = Float[np.ndarray, " time"]
Signals = Float[np.ndarray, "5 time"]
Channels = Mapping[str, Samples]

PLACES = ("gear", "drive", "wave generator", "mesh", "structure", "gauge", "acquisition")


@dataclass(frozen=True)
class Crack:
    """The bars of the toothed band that cross from one sector to the next lost stiffness.

    Attributes
    ----------
    angle : float
        Circumferential position of the crack [rad].
    stiffness_ratio : float
        Remaining stiffness of one tooth pitch of the rim, above 0 up to 1.
    """

    angle: float
    stiffness_ratio: float


class Instant(NamedTuple):
    """The drive of some runs at one instant or at several, arrays (run,) or (time, run).

    Angles [rad], speeds [rad/s], torque [N m].
    """

    phi_in: np.ndarray
    omega_in: np.ndarray
    phi_out: np.ndarray
    omega_out: np.ndarray
    twist: np.ndarray  # Delta phi_k, eq. (3)
    twist_rate: np.ndarray
    T_stiff: np.ndarray  # eq. (2)
    sliding: np.ndarray  # speed along the flank, eq. (6)


class Extra(NamedTuple):
    """Torques [N m] that an effect adds to the equations of motion, each an array like those or a number.

    ``T_motor`` drives the input and is felt by its torque flange, ``T_loss`` brakes the input behind the flange,
    ``T_stiff`` and ``T_fric`` add to eqs. (2) and (5), ``T_load`` to the load.
    """

    T_motor: np.ndarray | float = 0.0
    T_loss: np.ndarray | float = 0.0
    T_stiff: np.ndarray | float = 0.0
    T_fric: np.ndarray | float = 0.0
    T_load: np.ndarray | float = 0.0


@dataclass(frozen=True, eq=False)
class Scene:
    """What goes on while signals are recorded.

    Attributes
    ----------
    time : array (time,)
        Since the trigger, evenly spaced [s].
    phi_in : array (time,)
        Angle of the wave generator relative to the flex spline, unwrapped [rad].
    T_out : array (time,)
        Torque transmitted to the output [N m].
    point : OperatingPoint
    conditions : Conditions
    """

    time: Samples
    phi_in: Samples
    T_out: Samples
    point: OperatingPoint
    conditions: Conditions


@dataclass(frozen=True)
class Effect:
    """A physical effect; a subclass overrides only the places of the chain that it touches.

    The methods of this base class change nothing. Fields over the circumference are sampled at the wave-generator
    angles ``psi`` (relative to the flex spline) and at equally spaced angles ``theta`` around it. The parameters of a
    subclass are declared by the functions of :mod:`swgsim.effects.quantity` and are checked against their bounds.

    Attributes
    ----------
    place : str
        Of :data:`PLACES`.
    sharp : bool
        Whether signals have corners with it, whose order lines only a dense sampling shows as they are.
    """

    place: ClassVar[str] = ""
    sharp: ClassVar[bool] = False

    def __post_init__(self) -> None:
        title = self.title()
        for name, quantity in quantities(type(self)).items():
            quantity.check(title, name, getattr(self, name))

    @classmethod
    def name(cls) -> str:
        """The registered name, such as ``cam_form`` of the class CamForm."""
        return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()

    @classmethod
    def title(cls) -> str:
        """The name in words."""
        return cls.name().replace("_", " ")

    @property
    def structural(self) -> bool:
        """Whether it acts on what deforms the flex spline, of which the maps of a truss make its signature."""
        return self.place in ("wave generator", "mesh", "structure")

    def at(self, point: OperatingPoint, conditions: Conditions) -> "Effect":
        """The effect as it is at an operating point and under the conditions of a recording."""
        return self

    def drawn(self, rng: np.random.Generator) -> "Effect":
        """The effect as it is in one recording, where something of it is another one every time."""
        random = [name for name, quantity in quantities(type(self)).items() if quantity.role is Role.RANDOM]
        return replace(self, **{name: float(rng.uniform(0, 2 * np.pi)) for name in random})

    def parts(self) -> tuple["Effect", ...]:
        """What of it may be of any size beside the others, such as a hum in the cable of each gauge."""
        return (self,)

    def gear(self, gear: Gear) -> Gear:
        """A gear with changed parameters."""
        return gear

    def drive(self, now: Instant) -> Extra:
        """Torques to add to the equations of motion; they repeat with each revolution of the wave generator."""
        return Extra()

    def wave_generator(self, displacement: Field, psi: Psi, theta: Theta) -> Field:
        """Radial displacement [m] that the wave generator imposes on the sleeve."""
        return displacement

    def engaged(self, depth: Field, psi: Psi, theta: Theta) -> Field:
        """Depth [m] to which teeth engage, by which they share the force: the imposed displacement if nothing else."""
        return depth

    def mesh(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """Share of the tangential force that is carried at each angle; the chain scales the shares to sum to one."""
        return share

    def carried(self, share: Field, psi: Psi, theta: Theta) -> Field:
        """Of these shares, what each angle passes on; no other angle takes over what is lost."""
        return share

    def cracks(self) -> tuple[Crack, ...]:
        """Places where the rim lost stiffness."""
        return ()

    def gauge(self, signals: Signals, scene: Scene) -> Signals:
        """The bridge signals [mV/V]."""
        return signals

    def acquisition(self, channels: Channels, scene: Scene) -> Channels:
        """Every recorded channel by its name (:data:`swgsim.recordings.recording.CHANNELS`), in its unit."""
        return channels


def overrides(effect: Effect, *methods: str) -> bool:
    """Whether an effect has its own version of one of these methods."""
    kind: type = type(effect)
    return _overrides(kind, methods)


@cache  # not the function above, as mypy takes no class of effects for hashable
def _overrides(kind: type, methods: tuple[str, ...]) -> bool:
    return any(getattr(kind, method) is not getattr(Effect, method) for method in methods)
