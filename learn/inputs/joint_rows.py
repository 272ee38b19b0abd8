"""Units instead of recordings: the features of all recordings of a specimen in one row."""

from dataclasses import replace

import numpy as np

from learn.inputs.inputs import OPERATING_POINT, SPECIMEN, Layout, LearningSet


def joint_rows(data: LearningSet) -> LearningSet:
    """One row for each specimen, with every feature at each of its recordings.

    Recordings are in the order of their operating points, and of days at the same point. The layout has the features as
    channels and the recordings as points. The table has the facts of the specimen, without those of a recording.

    Raises
    ------
    ValueError
        If specimens have recordings at different operating points, or inputs are signals over the angle.
    """
    if data.layout.columns and data.layout.periodic:
        raise ValueError(
            "rows=unit puts features side by side, and these inputs are signals over the angle: take "
            "features=harmonics or lines"
        )
    table = data.table
    number = table.groupby(list(SPECIMEN), sort=False, observed=True).ngroup().to_numpy()
    speed, load = (table[name].to_numpy() for name in OPERATING_POINT)
    order = np.lexsort((load, speed, number))
    count = np.bincount(number)
    points = np.column_stack([speed, load])[order]
    if len(np.unique(count)) > 1 or (points.reshape(len(count), -1) != points[: count[0]].ravel()).any():
        raise ValueError(
            f"specimens have {count.min()} to {count.max()} recordings, not all of them at the same operating points, "
            "and a row has every feature at each of them: take rows=recording, or record the same operating points"
        )
    features = np.asarray(data.features)[order]
    each = features.reshape(len(count), count[0], -1)  # (specimen, recording, feature)
    of_recording = dict.fromkeys((*OPERATING_POINT, "efficiency", "temperature_c"), np.nan)
    facts = table.iloc[order[:: count[0]]].reset_index(drop=True).assign(**of_recording)
    ordered = replace(data, features=features, table=table.iloc[order].reset_index(drop=True))
    return LearningSet(
        each.swapaxes(1, 2).reshape(len(count), -1),
        facts,
        tuple(f"{name} of recording {i + 1}" for name in data.names for i in range(count[0])),
        Layout(len(data.names), int(count[0]), periodic=False),
        ordered,
    )
