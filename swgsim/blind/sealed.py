"""The truth of one case: all that its recordings come from, kept from the loop until it has answered."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from swgsim.blind.altered import Alteration, Altered, StrayOrder
from swgsim.blind.outside import Outside
from swgsim.blind.strata import DETECTABLE
from swgsim.effects import text
from swgsim.effects.base import Effect
from swgsim.gear.gear import OperatingPoint

# A case that was planned as detectable counts as detectable above this share of the planned strength: a size stops at
# its bounds, and is adjusted to a few per cent only.
STRENGTH_SHORTFALL = 0.9


@dataclass(frozen=True)
class Sealed:
    """One case.

    Attributes
    ----------
    number : int
    stratum : str
    design : str
    points : tuple of OperatingPoint
    repeats : int
    seed : int
        Of the unit and the recordings.
    sectors : int
        Of the bench's mesh.
    commissioned : bool
        Whether the unit was recorded in its healthy state.
    hard : bool
        Whether jitter, noise and temperature history are others than when it was commissioned.
    run_in : tuple of float
        Factors on b1 and k1 by running in.
    form : str
    effects : tuple of Effect
        Hidden effects in their library form.
    alteration : Alteration or None
    stray : StrayOrder or None
    taken_out : tuple of str
        Names that the library is given without.
    strengths : tuple of float
        Non-centrality of each hidden effect.
    likeness : float
        Of an effect outside the library: largest share of its projected signature that a known one reproduces.
    nearest : str
        That known one.
    invisible : tuple of str
        Effects that were passed over, as within their bounds these recordings do not show them.
    """

    number: int
    stratum: str
    design: str
    points: tuple[OperatingPoint, ...]
    repeats: int
    seed: int
    sectors: int
    commissioned: bool
    hard: bool
    run_in: tuple[float, float]
    form: str
    effects: tuple[Effect, ...] = ()
    alteration: Alteration | None = None
    stray: StrayOrder | None = None
    taken_out: tuple[str, ...] = ()
    strengths: tuple[float, ...] = ()
    likeness: float = 0.0
    nearest: str = ""
    invisible: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the hidden effects."""
        return tuple(effect.name() for effect in self.effects)

    @property
    def acting(self) -> tuple[Effect, ...]:
        """The hidden effects as they act."""
        altered = [Altered(e, self.alteration) if self.alteration else e for e in self.effects]
        return (*altered, *((self.stray,) if self.stray else ()))

    @property
    def detectable(self) -> bool:
        """Whether all that is hidden is strong enough to be found."""
        return bool(self.strengths) and min(self.strengths) >= STRENGTH_SHORTFALL * DETECTABLE

    @property
    def described(self) -> tuple[int, str, str] | None:
        """Order, pattern and law of an effect that was written to be described."""
        if len(self.effects) == 1 and isinstance(self.effects[0], Outside):
            atom = self.effects[0].described
            return atom.order, atom.pattern, atom.law
        return None


def as_json(case: Sealed) -> dict[str, Any]:
    """A case as plain values."""
    plain = {name: getattr(case, name) for name in Sealed.__dataclass_fields__}
    return plain | {
        "points": [[point.n_in_rpm, point.T_out] for point in case.points],
        "effects": text.entries(case.effects),
        "alteration": asdict(case.alteration) if case.alteration else None,
        "stray": text.entries([case.stray]) if case.stray else None,
    }


def from_json(plain: Mapping[str, Any]) -> Sealed:
    """The case of such values."""
    stray = text.from_entries(plain["stray"]) if plain["stray"] else (None,)
    tuples = {name: tuple(plain[name]) for name in ("run_in", "taken_out", "strengths", "invisible")}
    return Sealed(
        **{
            **plain,
            **tuples,
            "points": tuple(OperatingPoint(n, T) for n, T in plain["points"]),
            "effects": text.from_entries(plain["effects"]),
            "alteration": Alteration(**plain["alteration"]) if plain["alteration"] else None,
            "stray": stray[0],
        }
    )
