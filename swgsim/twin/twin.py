"""The twin of a gear, fitted to its references by the code that commissions gears for the loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from swgsim.chain.steady_state_cache import forget
from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.model import Model, predict
from swgsim.identification.fit.map_fit import calibrate
from swgsim.identification.fit.priors import Declared
from swgsim.oracle.model import Expectation, bench_of, expectations
from swgsim.oracle.oracle import EFFICIENCY, joint_model, session_columns
from swgsim.oracle.point import PointModel
from swgsim.twin.knowledge import Knowledge
from swgsim.twin.parameters import parameters_of
from swgsim.twin.references import References
from swgsim.twin.seen import Seen

# Fits, each with the scatter of the gear that the one before found: with that of another gear, the common errors of
# the largest lines, which are hundreds of times the noise, point into a slightly wrong direction.
TURNS = 2


@dataclass(frozen=True, eq=False)
class Twin:
    """A gear as its references show it.

    Attributes
    ----------
    knowledge : Knowledge
    model : Model
        Gear and imperfections at the likeliest values.
    unsure : array (point, feature, direction)
        How far the healthy observations may still lie off, one standard deviation of each independent direction.
    misfit : float
        Mean square of what the fit leaves of the references, in standard deviations: 1 for a gear of the model, far
        above 1 for one that the model does not describe.
    """

    knowledge: Knowledge
    model: Model
    unsure: Float[np.ndarray, "point feature direction"]
    misfit: float

    @classmethod
    def fitted(
        cls,
        knowledge: Knowledge,
        references: References,
        start: Model | None = None,
        parameters: Mapping[str, Declared] | None = None,
    ) -> "Twin":
        """The likeliest gear of the series, given its references.

        Parameters
        ----------
        knowledge : Knowledge
        references : References
            Of one gear, at the operating points of the knowledge.
        start : Model, optional
            Where the spreads are counted from; by default the nominal gear without imperfections.
        parameters : mapping, optional
            What may differ from the start; by default all parameters of a series. With the true gear as start and b1
            alone this makes the best that references can give: the floor of a method that has nothing else.

        Raises
        ------
        ValueError
            If the references lack an operating point.
        """
        forget()
        plan = knowledge.plan
        if start is None:
            start, scattered = knowledge.start, knowledge.at_start
        else:
            scattered = knowledge.scattered(start)
        parameters = parameters_of(knowledge.nominal, bench_of(plan)) if parameters is None else parameters
        rows = _rows(references, plan.grid.points)
        mean, count = references.mean[rows], references.count[rows]
        seen = Seen(N=knowledge.nominal.transmission.N)
        at: Model = start
        position: Mapping[str, float] = {}
        for turn in range(TURNS):
            scattered = knowledge.scattered(at) if turn else scattered
            errors = scattered.errors(count)
            # The mean of scattered observations lies off that without scatter, as a turned trigger shortens large lines.
            still = predict([at], knowledge.situations, seen, plan.sectors)[0]
            measured = mean - (scattered.mean - still)
            found = calibrate(
                start, parameters, measured, errors, knowledge.situations, np.arange(len(mean)), seen, position,
                plan.sectors,
            )  # fmt: skip
            at, position = found.model, found.position
        white = errors.whiten(found.J.reshape(-1, len(parameters)))
        root = np.linalg.cholesky(np.linalg.inv(white.T @ white + np.eye(len(parameters))))
        left = errors.whiten((measured - found.predicted).ravel())
        return cls(knowledge, at, found.J @ root, float(np.mean(left**2)))

    @cached_property
    def expected(self) -> list[Expectation]:
        """Healthy observations and changes by every fault, at every operating point."""
        plan = self.knowledge.plan_of(self.model.effects)
        return expectations(plan, self.knowledge.whole(self.model), self.knowledge.resolution)

    def densities(self, points: Sequence[OperatingPoint]) -> PointModel:
        """Distributions of the observations of every class: of one recording, or of one at each of several points.

        What is not known of the gear and of the session of the flanges is the same at all points.
        """
        plan, gear = self.knowledge.plan, self.model.gear
        chosen = [plan.grid.points.index(point) for point in points]
        expected = [self.expected[i] for i in chosen]
        session = [
            session_columns(plan, gear, each.point, float(each.healthy[:, EFFICIENCY].mean())) for each in expected
        ]
        shared = np.hstack([np.concatenate(session), np.concatenate([self.unsure[i] for i in chosen])])
        return joint_model(plan, gear, expected, shared)


def _rows(references: References, points: Sequence[OperatingPoint]) -> list[int]:
    """Which row of the references belongs to each operating point."""
    missing = [point for point in points if point not in references.points]
    if missing:
        raise ValueError(
            f"no reference at {missing[0].n_in_rpm:g} rpm and {missing[0].T_out:g} N m: record the healthy gear there, "
            "or leave the operating point out"
        )
    return [references.points.index(point) for point in points]
