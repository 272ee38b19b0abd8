"""What is known of a unit before its recordings are asked, and how far it may still lie elsewhere."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.gear import Gear
from swgsim.loop.calibration import linearised
from swgsim.loop.declared import Declared, of_unit
from swgsim.loop.features import Layout
from swgsim.loop.form import form_columns, largest_lines
from swgsim.loop.model import Model, Situation
from swgsim.loop.scatter import Scatter

# Declared accuracy of the structural model before the gear itself has been recorded: the mesh alone makes up to 2 %.
STRUCTURE = 0.01


@dataclass(frozen=True, eq=False)
class Unit:
    """What is known of a unit before the recordings in question.

    Attributes
    ----------
    model : Model
        At its nominal or commissioned parameters.
    reach : array (direction, direction) or None
        After commissioning, how far the directions (declared parameters, then deviations of the maps) may still lie
        from where they were found, as columns of one standard deviation; None for a unit never seen.
    shift : array (direction,) or None
        Where commissioning found them, in spreads.
    structure : float
        Declared accuracy of the maps, as a share of a gauge's largest line.
    scatter : Scatter or None
        Errors of single recordings found by commissioning.
    nominal : Gear or None
        After commissioning, the gear by whose spread the declared parameters are counted.
    largest : mapping or None
        After commissioning, the largest line of each gauge, by which deviations of the maps are counted.
    """

    model: Model
    reach: Float[np.ndarray, "direction direction"] | None = None
    shift: Float[np.ndarray, " direction"] | None = None
    structure: float = STRUCTURE
    scatter: Scatter | None = None
    nominal: Gear | None = None
    largest: Mapping[str, float] | None = None

    @property
    def commissioned(self) -> bool:
        """Whether the unit was recorded in its healthy state before."""
        return self.reach is not None

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
        known = of_unit(self.nominal) if self.nominal else {}
        predicted, J = linearised(model, known | dict(parameters or {}), situations, layout)
        maps = form_columns(self.largest or largest_lines(predicted, layout), situations, layout)
        directions = np.concatenate([J[..., : len(known)], maps], axis=-1)
        reach = self.structure * np.eye(directions.shape[-1]) if self.reach is None else self.reach
        shift = np.zeros(predicted.shape) if self.shift is None else directions @ self.shift
        return LeftOpen(predicted, shift, directions @ reach, J[..., len(known) :])


class LeftOpen(NamedTuple):
    """Prediction of a model, the shift of its maps that commissioning found, what the unit leaves open (one standard
    deviation each), and the change by one spread of each fitted parameter.
    """

    predicted: Float[np.ndarray, "situation feature"]
    shift: Float[np.ndarray, "situation feature"]
    columns: Float[np.ndarray, "situation feature direction"]
    J: Float[np.ndarray, "situation feature parameter"]
