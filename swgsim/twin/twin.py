"""The twin of a gear: Bayes' rule of the oracle on the gear that the references show."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

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
    offset : array (point, feature)
        By how much observations of a healthy gear lie off the expected ones, as far as it is known.
    unsure : array (point, feature, direction)
        How far they may still lie off, alike in all recordings of the gear, one standard deviation each.
    session : array (point, feature, direction)
        The same by the biases of the torque flanges, which are others in each session.
    """

    knowledge: Knowledge
    fitted: FittedGear
    expected: list[Expectation]
    offset: Float[np.ndarray, "point feature"]
    unsure: Float[np.ndarray, "point feature direction"]
    session: Float[np.ndarray, "point feature bias"]

    @classmethod
    def of(cls, knowledge: Knowledge, fitted: FittedGear, expected: list[Expectation] | None = None) -> "Twin":
        """The twin of a gear that was fitted to references (:func:`swgsim.twin.fitted_gear.fit_gear`).

        What it lets expect is simulated unless it is given.
        """
        plan, gear = knowledge.plan_of(fitted.model.effects), knowledge.whole(fitted.model)
        expected = expectations(plan, gear, knowledge.resolution) if expected is None else expected
        biases = [
            session_columns(knowledge.plan, fitted.model.gear, each.point, float(each.healthy[:, EFFICIENCY].mean()))
            for each in expected
        ]
        return cls(knowledge, fitted, expected, fitted.offset, fitted.unsure, np.array(biases))

    def in_session(self, healthy: Float[np.ndarray, "specimen point feature"]) -> "Twin":
        """The twin for the session in which some healthy specimens of the gear were recorded.

        Their mean shows the biases of the flanges, and the gear once more: it is the posterior of both.
        """
        shared = np.concatenate(np.concatenate([self.session, self.unsure], axis=-1))
        gear = self.fitted.model.gear
        of_mean = joint_model(self.knowledge.plan, gear, self.expected, shared[:, :0], len(healthy))
        left = healthy.mean(axis=0).ravel() - of_mean.mean - self.offset.ravel()
        weighed = np.linalg.solve(of_mean.covariance, shared)
        covariance = np.linalg.inv(weighed.T @ shared + np.eye(shared.shape[1]))
        offset = self.offset + (shared @ covariance @ weighed.T @ left).reshape(self.offset.shape)
        unsure = (shared @ np.linalg.cholesky(covariance)).reshape(*offset.shape, -1)
        return replace(self, offset=offset, unsure=unsure, session=self.session[..., :0])

    def densities(self, points: Sequence[OperatingPoint], days: int = 1) -> PointModel:
        """Distributions of the observations of every class: of one recording, or of one at each of several points.

        What is not known of the gear and of the session of the flanges is the same at all points. Of several days the
        observations are the means, which say all: a fault changes every day alike. The errors of the recordings and of
        the sessions of the flanges are those of means; what is not known of the gear stays.
        """
        plan, gear = self.knowledge.plan, self.fitted.model.gear
        chosen = [plan.grid.points.index(point) for point in points]
        shared = np.concatenate([self.session[chosen] / np.sqrt(days), self.unsure[chosen]], axis=-1)
        model = joint_model(plan, gear, [self.expected[i] for i in chosen], np.concatenate(shared), days)
        return replace(model, mean=model.mean + self.offset[chosen].ravel())
