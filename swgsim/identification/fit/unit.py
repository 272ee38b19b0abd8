"""What is known of a unit before its recordings are asked, and how far it may still lie elsewhere."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.effects.base import overrides
from swgsim.gear.gear import Gear
from swgsim.identification.covariance.influence_map_error import (
    Sizes,
    form_columns,
    largest_lines,
    lines_anywhere,
    sizes_of,
)
from swgsim.identification.covariance.scatter import Scatter
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Model, Situation, predict
from swgsim.identification.fit.healthy_variability import FRICTION, of_friction, of_gauges, of_learned
from swgsim.identification.fit.map_fit import linearised
from swgsim.identification.fit.priors import ANY_FRICTION, SERIES, Declared, of_unit
from swgsim.recordings.recording import Recording

# Declared accuracy of the structural model before the gear itself has been recorded: the mesh alone makes up to 2 %.
STRUCTURE = 0.01
# An effect's signature is known so many times less well than the maps of the healthy gear, whose lines were learned.
LESS = 2.0
# Variance of a ripple that is none of this gear, in that of noise: so much that it tells nothing.
UNHEARD = 1e8


@dataclass(frozen=True, eq=False)
class Unit:
    """What is known of a unit before the recordings in question.

    Attributes
    ----------
    model : Model
        At its nominal or commissioned parameters, then with the lines that are its own.
    reach : array (direction, direction) or None
        After commissioning, how far the directions (declared parameters, what a healthy bench does a little of,
        deviations of lines) may still lie from where they were found, as columns of one standard deviation; None for
        a unit never seen.
    shift : array (direction,) or None
        Where commissioning found them beside the model, in spreads; while it goes on, less what the model has of their
        lines already.
    structure : float
        How well the model knows the signatures of what acts on the structure, as a share of a gauge's largest line: as
        declared, or as far as commissioning found the lines of s1 to s4 to lie off.
    seen_healthy : bool
        Whether recordings of the healthy gear tell more of it, and so more is open, than can be of a gear never seen.
    scatter : Scatter or None
        Errors of single recordings found by commissioning.
    nominal : Gear or None
        After commissioning, the gear by whose spread the declared parameters are counted.
    largest : mapping or None
        From commissioning on, the largest line of each gauge by the model alone, by which deviations of the maps are
        counted.
    learned : array (feature,) or None
        After commissioning, how far the lines lie from the model's that this has quite different (standard deviation, 0
        for all others): so far that recordings of the healthy gear have to tell.
    inflation : array (feature,) or None
        After commissioning, factor by which the variance of each line is larger than that of noise, by what the model
        misses of the healthy gear; for as many repeats as commissioning had.
    healthy : tuple of Recording
        By which it was commissioned.
    """

    model: Model
    reach: Float[np.ndarray, "direction direction"] | None = None
    shift: Float[np.ndarray, " direction"] | None = None
    structure: float = STRUCTURE
    seen_healthy: bool = False
    scatter: Scatter | None = None
    nominal: Gear | None = None
    largest: Mapping[str, float] | None = None
    learned: Float[np.ndarray, " feature"] | None = None
    inflation: Float[np.ndarray, " feature"] | None = None
    healthy: tuple[Recording, ...] = ()

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
        """Whether commissioning found the structure less accurate than a truss of the gear is."""
        return self.structure > STRUCTURE

    @property
    def declared(self) -> dict[str, Declared]:
        """Parameters of the gear that are not known exactly, with their spread before commissioning."""
        return of_unit(self.nominal or self.model.gear, ANY_FRICTION if self.seen_healthy else SERIES)

    def inflated(self, variance: Float[np.ndarray, "recording feature"]) -> Float[np.ndarray, "recording feature"]:
        """Variance of independent errors, from that of noise."""
        return variance if self.inflation is None else variance * self.inflation

    def left_open(
        self,
        model: Model,
        situations: Sequence[Situation],
        layout: Layout,
        parameters: Mapping[str, Declared] | None = None,
    ) -> "LeftOpen":
        """Prediction of a model of this unit, and all directions in which it may still lie elsewhere.

        Parameters
        ----------
        model : Model
        situations : sequence of Situation
        layout : Layout
        parameters : mapping, optional
            Those that are fitted.
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
        torque = predict([_driving(model)], situations, Layout(("T_out",)))[0]
        directions.append(form_columns(self.form(predicted, layout), situations, layout, torque))
        open_ = np.concatenate(directions, axis=-1)
        shift = np.zeros(predicted.shape) if self.shift is None else open_ @ self.shift
        return LeftOpen(predicted, shift, open_ if self.reach is None else open_ @ self.reach, of_parameters)

    def form(self, predicted: Float[np.ndarray, "situation feature"], layout: Layout) -> Sizes:
        """How far lines may deviate by the maps, and by what of them is learned: the last of the directions."""
        largest = self.largest or largest_lines(predicted, layout)
        of_maps = STRUCTURE * np.array([largest.get(channel, 0.0) for channel in layout.channel])
        return sizes_of(of_maps, self.powers, np.zeros(len(layout)) if self.learned is None else self.learned)

    def open_of(
        self, signature: Float[np.ndarray, "situation feature"], layout: Layout
    ) -> Float[np.ndarray, "situation feature column"]:
        """What an inaccurate structural model leaves open of an effect: its lines lie further off than the maps'.

        A share of each part is no tolerance for parts that are small because others cancel in them; another structure
        has them quite different. Where the structure is as accurate as declared, this is far below the tolerance of
        form.
        """
        if not self.of_another_structure:
            return np.zeros((*signature.shape, 0))
        return LESS * self.structure * lines_anywhere(signature, layout)


def _driving(model: Model) -> Model:
    """The model whose torques are those that the structure feels, and not what a flange makes of them."""
    return replace(model, own_lines=None, effects=tuple(e for e in model.effects if not overrides(e, "acquisition")))


class LeftOpen(NamedTuple):
    """Prediction of a model, the shift from it that commissioning found, what the unit leaves open (one standard
    deviation each), and the change by one spread of each fitted parameter.
    """

    predicted: Float[np.ndarray, "situation feature"]
    shift: Float[np.ndarray, "situation feature"]
    columns: Float[np.ndarray, "situation feature direction"]
    J: Float[np.ndarray, "situation feature parameter"]
