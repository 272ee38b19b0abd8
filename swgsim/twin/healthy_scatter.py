"""How healthy recordings of a gear scatter, which weighs its references."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from swgsim.dataset.plan import Plan
from swgsim.gear.gear import Gear
from swgsim.identification.covariance.low_rank_covariance import Covariance
from swgsim.identification.covariance.recording_covariance import RecordingCovariance
from swgsim.oracle.model import healthy_runs
from swgsim.oracle.oracle import EFFICIENCY, added_variance, session_columns


@dataclass(frozen=True, eq=False)
class HealthyScatter:
    """Healthy runs of a gear with the scatter of the bench.

    Attributes
    ----------
    plan : Plan
        Of the unit, without drawn imperfections.
    gear : Gear
    healthy : array (point, draw, feature)
        Observations without added errors.
    """

    plan: Plan
    gear: Gear
    healthy: Float[np.ndarray, "point draw feature"]

    @classmethod
    def of(cls, plan: Plan, gear: Gear, draws: int) -> "HealthyScatter":
        """So many simulated runs at every operating point of a plan."""
        return cls(plan, gear, healthy_runs(plan, gear, draws))

    def errors(self, count: Float[np.ndarray, " point"]) -> Covariance:
        """Covariance of means of so many recordings about :attr:`mean`, with the biases of the flanges of a session."""
        draws = self.healthy.shape[1]
        levels = self.mean[:, EFFICIENCY].tolist()
        points = self.plan.grid.points
        at_points = list(zip(points, levels, strict=True))
        added = np.array([added_variance(self.plan, self.gear, *each) for each in at_points])
        session = np.concatenate([session_columns(self.plan, self.gear, *each) for each in at_points])
        scatter = np.swapaxes(self.healthy - self.mean[:, None], 1, 2) / np.sqrt(draws - 1)
        # The draws are a sample too, by which their mean is off.
        share = np.sqrt(1 / count + 1 / draws)[:, None, None]
        return Covariance(RecordingCovariance(added / count[:, None], scatter * share), session)

    @property
    def mean(self) -> Float[np.ndarray, "point feature"]:
        """Mean of the draws."""
        return self.healthy.mean(axis=1)
