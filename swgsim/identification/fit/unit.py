"""A unit: its model, and the posterior covariance of its parameters and of its lines."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import BY_STRUCTURE, Effect, overrides
from swgsim.gear.gear import Gear
from swgsim.identification.covariance.influence_map_error import (
    Sizes,
    form_columns,
    largest_lines,
    sizes_of,
)
from swgsim.identification.covariance.model_discrepancy import Discrepancy
from swgsim.identification.covariance.narrow_band import NarrowBand
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import Layout, layout_of
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.fit.healthy_variability import FRICTION, of_another_day, of_friction, of_gauges, of_learned
from swgsim.identification.fit.map_fit import linearised
from swgsim.identification.fit.priors import ANY_FRICTION, Declared, of_unit
from swgsim.identification.fit.unit_file import read_unit, write_unit
from swgsim.recordings.recording import Recording

# Declared structural error of a gear without commissioning; the mesh of the truss makes up to 2 %.
STRUCTURE = 0.01
# Spread of the structure's factors up to which the mesh of the truss may be the reason.
OF_MESH = 0.03
# Factor on the noise variance of ripple that the model of this gear does not describe. Such ripple then has no weight,
# and the report names its channels as `unheard`.
UNHEARD = 1e8


@dataclass(frozen=True, eq=False)
class Unit:
    """A unit before the recordings to examine.

    Attributes
    ----------
    model : Model
        With nominal parameters, or with commissioned parameters and the unit's own lines.
    reach : array (direction, direction) or None
        Square root of the posterior covariance after commissioning, one column per standard deviation. The directions
        are declared parameters, healthy variability, model discrepancy and deviations of lines. None without
        commissioning.
    shift : array (direction,) or None
        Posterior mean of the directions relative to the model, in prior standard deviations. During commissioning,
        lines that are already in the model are subtracted.
    structure : float
        Spread of the factors by which the structure differs from the truss, as a standard deviation of the logarithm
        (:class:`~swgsim.flexspline.structure_factors.StructureFactors`): the declared value, or the most probable one
        as found by commissioning.
    of_gauges : float
        Spread of gains, positions and directions of the gauges relative to that of a series; likewise.
    seen_healthy : bool
        Whether healthy recordings determine the unit; more nuisance parameters are then free.
    scatter : Scatter or None
        Errors of single recordings found by commissioning.
    nominal : Gear or None
        After commissioning, the nominal gear, whose prior standard deviations scale the declared parameters.
    largest : mapping or None
        From commissioning on, the model's largest line of each gauge, which scales deviations of the influence maps.
    learned : array (feature,) or None
        After commissioning, prior standard deviation of the lines that lie far from the model and were learned; 0 for
        all others.
    inflation : array (feature,) or None
        Factor on the noise variance of each line: 1, or UNHEARD for ripple that is not used.
    discrepancy : Discrepancy or None
        After commissioning, how lines differ from the model at single operating points.
    bands : tuple of NarrowBand
        Noise in narrow bands found by commissioning.
    healthy : tuple of Recording
        Recordings of the commissioning, with their angle counted from the zero of the model.
    zero : float
        Angle by which the recorded angle is ahead of the model's [rad].
    interharmonics : tuple of Effect
        Declared effects that make interharmonic lines; the model of the order lines has no part of them.
    lines : tuple of Effect
        Interharmonic lines of the healthy gear that commissioning found, with law, pattern and amplitude. How they
        scatter is estimated from :attr:`healthy`.
    """

    model: Model
    reach: Float[np.ndarray, "direction direction"] | None = None
    shift: Float[np.ndarray, " direction"] | None = None
    structure: float = STRUCTURE
    of_gauges: float = 1.0
    seen_healthy: bool = False
    scatter: Scatter | None = None
    nominal: Gear | None = None
    largest: Mapping[str, float] | None = None
    learned: Float[np.ndarray, " feature"] | None = None
    inflation: Float[np.ndarray, " feature"] | None = None
    discrepancy: Discrepancy | None = None
    bands: tuple[NarrowBand, ...] = ()
    healthy: tuple[Recording, ...] = ()
    zero: float = 0.0
    interharmonics: tuple[Effect, ...] = ()
    lines: tuple[Effect, ...] = ()

    def __repr__(self) -> str:
        name = f"gear {self.model.gear.number}"
        declared = ", ".join(each.title() for each in (*self.model.effects, *self.interharmonics))
        state = (
            f"commissioned on {len(self.healthy)} recordings of {self.healthy[0].gear!r}, "
            f"structure of a spread of {100 * self.structure:.2g} %"
            if self.commissioned and self.healthy
            else "commissioned"
            if self.commissioned
            else "not commissioned: the prior is the spread of a series"
        )
        lines = f"; interharmonic lines: {', '.join(each.title() for each in self.lines)}" if self.lines else ""
        return f"Unit of {name}, {state}; declared effects: {declared or 'none'}{lines}"

    def save(self, path: str | Path) -> None:
        """Keep the unit in a file, such as ``gear7.unit.h5``; the file is complete or absent.

        Raises
        ------
        OSError
            If the disk is full or the folder cannot be written.
        ValueError
            If a declared effect cannot be imported again.
        """
        write_unit(Path(path), self)

    @classmethod
    def load(cls, path: str | Path) -> "Unit":
        """Read a unit from a file of :meth:`save`; answers from it are those of the unit itself, bit for bit.

        Raises
        ------
        ValueError
            If the file is missing, damaged, or of another version of the format; the message has the file, the field,
            what was found and what was expected.
        """
        unit = read_unit(Path(path), cls)
        unit._require_directions(path)
        return unit

    def _require_directions(self, path: str | Path) -> None:
        """Raise a ValueError unless the numbers of a file belong to the directions of this version."""
        if not (self.commissioned and self.healthy):
            raise ValueError(f"{path}: found a unit that was not commissioned; commission it (swg commission)")
        first = self.healthy[0]
        try:
            self.left_open(self.model, [Situation(first.point, first.conditions)], layout_of(self.healthy))
        except (ValueError, IndexError, KeyError) as error:
            raise ValueError(
                f"{path}: its directions are not those of this version ({error}); commission the unit again"
            ) from error

    @property
    def commissioned(self) -> bool:
        """Whether the unit was recorded in its healthy state before."""
        return self.reach is not None

    @property
    def powers(self) -> int:
        """Powers of the load by which the maps may deviate."""
        return 3 if self.seen_healthy else 2

    @property
    def of_another_structure(self) -> bool:
        """Whether commissioning found the structure further off than the mesh of the truss makes it."""
        return self.structure > OF_MESH

    def opens(self, effect: Effect | type[Effect]) -> bool:
        """Whether the lines of an effect differ one by one from the library's, as the structure is another one."""
        return self.of_another_structure and effect.place in BY_STRUCTURE

    @cached_property
    def declared(self) -> dict[str, Declared]:
        """Parameters of the gear that are not known exactly, with their spread before commissioning."""
        gear = self.nominal or self.model.gear
        if not self.seen_healthy:
            return of_unit(gear)
        return of_unit(gear, ANY_FRICTION, self.structure, self.of_gauges)

    def inflated(self, variance: Float[np.ndarray, "*recording feature"]) -> Float[np.ndarray, "*recording feature"]:
        """Variance of independent errors, from that of noise; of ones, the factors themselves."""
        return variance if self.inflation is None else variance * self.inflation

    def left_open(
        self,
        model: Model,
        situations: Sequence[Situation],
        layout: Layout,
        parameters: Mapping[str, Declared] | None = None,
    ) -> "LeftOpen":
        """Prediction of a model of this unit, and its nuisance directions.

        Parameters
        ----------
        model : Model
        situations : sequence of Situation
        layout : Layout
        parameters : mapping, optional
            Fitted parameters.
        """
        declared = self.declared
        # During commissioning these are fitted; only friction is needed here, which follows the temperature.
        needed = () if not self.seen_healthy else declared if self.nominal else FRICTION
        own = {name: declared[name] for name in needed}
        predicted, J = linearised(model, own | dict(parameters or {}), situations, layout)
        of_own, of_parameters = J[..., : len(own)], J[..., len(own) :]
        directions = [of_own if self.nominal else of_own[..., :0]]
        if self.seen_healthy:
            directions += [of_gauges(predicted, situations, layout), of_friction(model, own, of_own, situations)]
        if self.learned is not None:
            directions.append(of_learned(self.learned, situations, layout))
        if self.discrepancy:
            directions.append(self.discrepancy.columns(situations, predicted, layout))
        torque = predict([_driving(model)], situations, Layout(("T_out",)))[0]
        directions.append(form_columns(self.form(predicted, layout), situations, layout, torque))
        open_ = np.concatenate(directions, axis=-1)
        shift = np.zeros(predicted.shape) if self.shift is None else open_ @ self.shift
        columns = open_ if self.reach is None else open_ @ self.reach
        undetermined = np.zeros((*predicted.shape, 0))
        if self.nominal:
            columns = np.concatenate([columns, of_another_day(model, own, of_own)], axis=-1)
            if self.discrepancy:
                undetermined = self.discrepancy.undetermined(situations, predicted, layout)
        return LeftOpen(predicted, shift, columns, undetermined, of_parameters)

    def form(self, predicted: Float[np.ndarray, "situation feature"], layout: Layout) -> Sizes:
        """Prior standard deviations of lines, by influence maps and by learning: the last of the directions."""
        largest = self.largest or largest_lines(predicted, layout)
        of_maps = STRUCTURE * np.array([largest.get(channel, 0.0) for channel in layout.channel])
        return sizes_of(of_maps, self.powers, np.zeros(len(layout)) if self.learned is None else self.learned)


def _driving(model: Model) -> Model:
    """The model with the torques on the structure, without errors of torque flanges."""
    return replace(model, own_lines=None, effects=tuple(e for e in model.effects if not overrides(e, "acquisition")))


class LeftOpen(NamedTuple):
    """Prediction of a model, its shift by commissioning, the nuisance directions of the unit (one standard deviation
    each), those of the model discrepancy that no healthy recording determined, and the change by one prior standard
    deviation of each fitted parameter.
    """

    predicted: Float[np.ndarray, "situation feature"]
    shift: Float[np.ndarray, "situation feature"]
    columns: Float[np.ndarray, "situation feature direction"]
    undetermined: Float[np.ndarray, "situation feature discrepancy"]
    J: Float[np.ndarray, "situation feature parameter"]
