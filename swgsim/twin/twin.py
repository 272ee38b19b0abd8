"""The twin of a gear: Bayes' rule of the oracle on the gear that the references show."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from swgsim.gear.gear import OperatingPoint
from swgsim.oracle.model import Expectation, expectations
from swgsim.oracle.oracle import EFFICIENCY, joint_model, session_columns
from swgsim.oracle.point import PointModel
from swgsim.twin.fitted_gear import FittedGear
from swgsim.twin.knowledge import Knowledge


@dataclass(frozen=True, eq=False)
class Twin:
    """A fitted gear and what it lets expect.

    Attributes
    ----------
    knowledge : Knowledge
    fitted : FittedGear
    expected : list of Expectation
        Healthy observations and changes by every fault, at every operating point of the knowledge.
    """

    knowledge: Knowledge
    fitted: FittedGear
    expected: list[Expectation]

    @classmethod
    def of(cls, knowledge: Knowledge, fitted: FittedGear) -> "Twin":
        """The twin of a gear that was fitted to references (:func:`swgsim.twin.fitted_gear.fit_gear`)."""
        plan, gear = knowledge.plan_of(fitted.model.effects), knowledge.whole(fitted.model)
        return cls(knowledge, fitted, expectations(plan, gear, knowledge.resolution))

    def densities(self, points: Sequence[OperatingPoint], days: int = 1) -> PointModel:
        """Distributions of the observations of every class: of one recording, or of one at each of several points.

        What is not known of the gear and of the session of the flanges is the same at all points. Of several days the
        observations are the means, which say all: a fault changes every day alike. The errors of the recordings and of
        the sessions of the flanges are those of means; what is not known of the gear stays.
        """
        plan, gear = self.knowledge.plan, self.fitted.model.gear
        chosen = [plan.grid.points.index(point) for point in points]
        expected = [self.expected[i] for i in chosen]
        session = [
            session_columns(plan, gear, each.point, float(each.healthy[:, EFFICIENCY].mean())) for each in expected
        ]
        shared = np.hstack([
            np.concatenate(session) / np.sqrt(days), np.concatenate([self.fitted.unsure[i] for i in chosen])
        ])  # fmt: skip
        model = joint_model(plan, gear, expected, shared, days)
        return replace(model, mean=model.mean + np.concatenate([self.fitted.offset[i] for i in chosen]))
