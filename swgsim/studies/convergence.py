"""Convergence of the gauge signals with the mesh of the flex spline: python -m swgsim.studies.convergence"""

from collections.abc import Iterable

import pandas as pd

from swgsim.chain.influence import influence_map
from swgsim.effects import RootToothCrack
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.gear.gear import Gear

COUNTS = (40, 60, 80, 100, 120, 160, 200, 240, 320, 400)


def study(gear: Gear, counts: Iterable[int]) -> pd.DataFrame:
    """Four quantities that make up gauge s1, for several numbers of sectors.

    Returns
    -------
    DataFrame
        Index: sectors. Columns: nodes; torque, the mean signal per output torque [uV/V per N m]; deflection, the order
        2 by the wave generator [uV/V]; engagement, the order 2 by the tooth forces per output torque [uV/V per N m];
        crack, the change of order 2 by a root crack (remaining stiffness 0.03, at 0.3 rad) [uV/V].
    """
    rows = {}
    for count in counts:
        flex = solve_flex_spline(gear.flex_spline, gear.transmission.alpha_tooth, count)
        sound = influence_map(flex, gear.wave_generator, gear.gauges).coefficients
        cracked = influence_map(flex, gear.wave_generator, gear.gauges, (RootToothCrack(0.03, 0.3),)).coefficients
        rows[count] = {
            "nodes": count * len(flex.sector.nodes),
            "torque": 1e3 * sound[1, 1, 0].real,
            "deflection": 1e3 * abs(sound[0, 1, 2]),
            "engagement": 1e3 * abs(sound[1, 1, 2]),
            "crack": 1e3 * abs(cracked[0, 1, 2] - sound[0, 1, 2]),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("sectors")


if __name__ == "__main__":
    table = study(Gear(), COUNTS)
    print(table.round(3).to_string())
    print("\nrelative to the finest:")
    print((table / table.iloc[-1] - 1).drop(columns="nodes").map("{:+.2%}".format).to_string())
