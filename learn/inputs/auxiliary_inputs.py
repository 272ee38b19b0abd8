"""Auxiliary inputs next to the signal: efficiency and operating point."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.residuals import HealthyLines

LOG = "log eta_rel"  # name of the input: logarithm of the efficiency relative to the healthy reference


@dataclass(frozen=True)
class AuxiliaryInputs:
    """Choice of the auxiliary inputs.

    Attributes
    ----------
    efficiency : bool
        Change of the efficiency from the healthy reference, in three forms: its logarithm, the fourth root of eq. (9)
        with a sign, and the change of viscous loss that would explain it. Without a reference: the logarithm of the
        efficiency.
    operating_point : bool
        Speed, load and temperature; with a reference, the temperature is relative to that of the reference.
    reference : bool
        Whether healthy acquisitions of the gear are known (level Z1) or not (level Z0).
    """

    efficiency: bool = True
    operating_point: bool = True
    reference: bool = True

    def columns(self, healthy: HealthyLines) -> dict[str, Float[np.ndarray, " sample"]]:
        """Named columns, each an array (sample,)."""
        table = healthy.table
        speed, load = table["n_in_rpm"].to_numpy(), table["T_out_nm"].to_numpy()
        eta = table["efficiency"].to_numpy()
        columns: dict[str, np.ndarray] = {}
        if self.efficiency and self.reference:
            columns |= changes_of_efficiency(eta, healthy.eta_healthy, speed, load)
        elif self.efficiency:
            columns["log eta"] = np.log(eta)
        if self.operating_point:
            columns |= operating_point(table, self.reference * healthy.temperature_healthy)
        return columns


def changes_of_efficiency(
    eta: Float[np.ndarray, " sample"],
    eta_healthy: Float[np.ndarray, " sample"],
    speed: Float[np.ndarray, " sample"],
    load: Float[np.ndarray, " sample"],
) -> dict[str, Float[np.ndarray, " sample"]]:
    """Three forms of the change of the efficiency [-] from the healthy one, at a speed [rpm] and load [N m]."""
    change = np.log(eta / eta_healthy)
    # As T_in N = T_out / eta, the change of the loss torque at the output over the speed is a change of b1.
    viscous = (1 / eta - 1 / eta_healthy) * load / (speed * np.pi / 30)  # N m s
    return {LOG: change, "root of log eta_rel": np.sign(change) * np.abs(change) ** 0.25, "viscous loss": viscous}


def operating_point(table: pd.DataFrame, temperature: Float[np.ndarray, " sample"]) -> dict[str, np.ndarray]:
    """Speed [rpm], load [N m] and temperature minus a given one [K]; 0 where no temperature was recorded."""
    difference = np.nan_to_num(table["temperature_c"].to_numpy() - temperature)
    return {"speed": table["n_in_rpm"].to_numpy(), "load": table["T_out_nm"].to_numpy(), "temperature": difference}
