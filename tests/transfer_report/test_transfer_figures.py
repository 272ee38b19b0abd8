"""Every picture of transfer holds the values it is given, also where some are missing."""

import numpy as np
import pandas as pd
import pytest

from learn.transfer_report import curve_figures, line_ends, map_figures, size_figures
from learn.transfer_report import figures as transfer_figures
from swgsim.common.style import CLASS_COLOURS
from swgsim.storage.labelled_signals import CLASSES

SHOTS = (1, 2, 5, 10, 14)
NETWORKS = ("linear probe", "fine tuning", "L2-SP", "replay", "prototypes", "from scratch")
FORESTS = ("leaf relabelling", "added trees", "from scratch")
LEVELS = {"paper's forest": 31.0, "oracle": 1.5}


def curves():
    methods = [f"MLP: {name}" for name in NETWORKS] + [f"extra trees: {name}" for name in FORESTS]
    rows = [
        (method, k, error := (60 if "scratch" in method else 10 + place) / k, 0.8 * error, 1.2 * error)
        for place, method in enumerate(methods) for k in SHOTS
    ]  # fmt: skip
    rows += [("CNN on residual: batch statistics", 0, 12.0, 10.0, 15.0), ("MLP: CORAL", 0, 12.1, np.nan, np.nan)]
    return pd.DataFrame(rows, columns=["method", "shots", "error", "low", "high"])


def scenarios():
    rows = [
        ("2 source gears", "MLP: replay", 2, 30.0, 20.0),
        ("2 source gears", "MLP: from scratch", 2, 30.0, 40.0),
        ("gears far outside", "MLP: replay", 2, 40.0, 45.0),
        ("gears far outside", "MLP: replay", 10, np.nan, 12.0),
        ("gears far outside", "extra trees: from scratch", 10, np.nan, 15.0),
    ]
    return pd.DataFrame(rows, columns=["scenario", "method", "shots", "unadapted", "error"])


def inputs():
    rows = [("raw", "MLP", True, 35.0), ("raw", "MLP", False, 45.0), ("residual", "MLP", True, 9.0),
            ("residual", "CNN", True, 8.0), ("residual", "CNN", False, 8.0)]  # fmt: skip
    return pd.DataFrame(rows, columns=["input", "method", "efficiency", "error"])


def sizes():
    rows = [
        ("random forest", f"depth {depth}", trees, 90.0 + depth, 70.0 - depth)
        for depth in (3, 5)
        for trees in (10, 100)
    ]
    rows += [("MLP", "hidden layers 1", 5, 80.0, np.nan), ("MLP", "hidden layers 1", 20, 85.0, 60.0)]
    return pd.DataFrame(rows, columns=["classifier", "setting", "size", "same", "unseen"])


def residuals():
    rows = [("disturbance of eq. (10)", order, 1e-3 if order % 2 else 0.0) for order in range(14)]
    rows += [(label, order, 1e-5 if order % 2 else 1e-4) for label in CLASSES for order in range(13)]
    return pd.DataFrame(rows, columns=["source", "order", "amplitude"])


def line(axes, name):
    return next(line for line in axes.lines if line.get_label() == name)


def names(axes):
    return [text.get_text() for text in axes.texts]


def test_all_pictures_are_drawn():
    pictures = [
        transfer_figures.picture(transfer_figures.SHOTS, curve_figures.error(curves(), LEVELS)),
        transfer_figures.forgotten_against_shots(curves().rename(columns={"error": "forgotten"})),
        transfer_figures.inputs_map(inputs()),
        transfer_figures.where_transfer_pays(scenarios()),
        transfer_figures.picture(transfer_figures.SIZE, size_figures.against_size(sizes())),
        transfer_figures.picture(transfer_figures.SPECTRUM, map_figures.spectrum(residuals())),
    ]
    assert all(p.png[:8] == b"\x89PNG\r\n\x1a\n" and len(p.png) > 10_000 for p in pictures)
    assert all(p.title and "ook" in p.caption for p in pictures)


def test_networks_and_forests_have_a_panel_each_with_their_errors():
    networks, forests = curve_figures.error(curves(), LEVELS).axes
    assert {line.get_label() for line in forests.lines if ":" in line.get_label()} == {
        f"extra trees: {name}" for name in FORESTS
    }
    assert line(networks, "MLP: fine tuning").get_ydata() == pytest.approx([11 / k for k in SHOTS])
    assert line(forests, "extra trees: added trees").get_ydata() == pytest.approx([17 / k for k in SHOTS])
    for axes, name in ((networks, "MLP"), (forests, "extra trees")):
        assert line(axes, f"{name}: from scratch").get_color() == curve_figures.GREY


def test_all_labels_are_level_z4_and_methods_without_labels_stand_at_0():
    networks, forests = curve_figures.error(curves(), LEVELS).axes
    ticks = dict(zip((tick.get_text() for tick in networks.get_xticklabels()), networks.get_xticks(), strict=True))
    assert list(ticks) == ["0", "1", "2", "5", "10", "14\nall (Z4)"]
    assert [tick.get_text() for tick in forests.get_xticklabels()] == ["1", "2", "5", "10", "14\nall (Z4)"]
    assert line(networks, "MLP: CORAL").get_xdata() == pytest.approx(ticks["0"], abs=0.25)


def test_methods_stand_side_by_side():
    networks = curve_figures.error(curves(), {}).axes[0]
    first = [line.get_xdata()[0] for line in networks.lines if line.get_label().startswith("MLP: ")]
    assert len(np.unique(first)) == len(NETWORKS) + 1
    assert np.ptp(first[:-1]) < 0.5


def test_intervals_reach_from_low_to_high():
    table = curves()
    forests = curve_figures.error(table, {}).axes[1]
    drawn = np.concatenate([np.array(c.get_segments())[:, :, 1] for c in forests.collections])
    of_forests = table[table["method"].str.startswith("extra")]
    assert drawn == pytest.approx(of_forests[["low", "high"]].to_numpy())


def test_levels_are_lines_with_names_in_both_panels_unless_unknown():
    for axes in curve_figures.error(curves(), LEVELS | {"not run": np.nan}).axes:
        levels = [line.get_ydata()[0] for line in axes.lines if line.get_label().startswith("_")]
        assert levels == [31.0, 1.5]
        assert {"paper's forest", "oracle"} < set(names(axes))
        assert "not run" not in names(axes)


def test_no_level_and_no_forest_leave_one_panel_with_short_names():
    table = curves()
    (axes,) = curve_figures.error(table[table["method"].str.startswith("MLP")], {}).axes
    assert axes.get_title(loc="left") == "MLP"
    assert set(names(axes)) == {*NETWORKS, "CORAL"}


def test_a_missing_value_shortens_its_curve_only():
    table = curves()
    table.loc[(table["method"] == "MLP: replay") & (table["shots"] == 14), "error"] = np.nan
    networks = curve_figures.error(table, LEVELS).axes[0]
    assert len(line(networks, "MLP: replay").get_xdata()) == 4
    assert len(line(networks, "MLP: L2-SP").get_xdata()) == 5


def test_forgetting_has_its_limit_and_the_caption_counts():
    table = pd.DataFrame(
        [("MLP: replay", 1, 0.5), ("MLP: replay", 5, 1.0), ("MLP: fine tuning", 1, 1.0), ("MLP: fine tuning", 5, 9.0),
         ("MLP: from scratch", 1, np.nan)],
        columns=["method", "shots", "forgotten"],
    )  # fmt: skip
    (axes,) = curve_figures.forgotten(table).axes
    assert [line.get_ydata()[0] for line in axes.lines if line.get_label().startswith("_")] == [2.0]
    assert line(axes, "MLP: fine tuning").get_ydata() == pytest.approx([1, 9])
    assert "1 of 2 methods" in transfer_figures.forgotten_against_shots(table).caption


def test_names_keep_their_order_and_distance_within_the_panel():
    heights = np.array([0.99, 0.2, 0.98, 0.21, 0.99, 0.0])
    moved = line_ends.spread(heights, 0.1)
    assert np.diff(np.sort(moved)).min() > 0.0999
    assert moved.min() >= 0
    assert moved.max() <= 1
    assert moved[[5, 1, 3, 2, 0, 4]] == pytest.approx(np.sort(moved))


def test_too_many_names_share_the_panel():
    assert np.ptp(line_ends.spread(np.full(40, 0.5), 0.1)) <= 1


def test_inputs_stand_with_and_without_efficiency():
    mlp, cnn = map_figures.inputs(inputs()).axes
    assert line(mlp, "with efficiency").get_xdata() == pytest.approx([35, 9])
    assert line(mlp, "without efficiency").get_xdata() == pytest.approx([45, np.nan], nan_ok=True)
    assert names(mlp) == ["35.0", "45.0", "9.0"]
    assert names(cnn) == ["not run", "8.0", "8.0"]
    assert [tick.get_text() for tick in mlp.get_yticklabels()] == ["raw", "residual"]
    assert "residual with CNN (8.0 %)" in transfer_figures.inputs_map(inputs()).caption


def test_gains_and_losses_have_their_own_marks():
    (axes,) = map_figures.pays(scenarios()).axes
    assert line(axes, "adapted, better").get_xdata() == pytest.approx([20])
    assert line(axes, "adapted, worse").get_xdata() == pytest.approx([45])
    assert line(axes, "adapted, no difference").get_xdata() == pytest.approx([12])
    assert line(axes, "adapted, better").get_color() != line(axes, "adapted, worse").get_color()
    assert np.sort(line(axes, "from scratch").get_xdata()) == pytest.approx([15, 40, np.nan, np.nan], nan_ok=True)
    assert {"2 source gears", "gears far outside", "\N{MINUS SIGN}10.0", "\N{MINUS SIGN}20.0", "+5.0"} < set(
        names(axes)
    )


def test_from_scratch_stands_beside_the_same_classifier_and_shots():
    rows = map_figures.beside_from_scratch(scenarios()).set_index(["scenario", "text"])
    assert rows.loc[("2 source gears", "MLP: replay, K = 2"), "scratch"] == 40
    assert np.isnan(rows.loc[("gears far outside", "MLP: replay, K = 10"), "scratch"])
    alone = rows.loc[("gears far outside", "extra trees: from scratch, K = 10")]
    assert np.isnan(alone["error"])
    assert alone["scratch"] == 15
    assert len(rows) == 4


def test_harm_is_counted_in_the_caption():
    assert "(1 of 4 rows)" in transfer_figures.where_transfer_pays(scenarios()).caption


def test_gap_is_between_the_same_and_the_unseen_gear():
    upper_forest, upper_network, lower_forest, lower_network = size_figures.against_size(sizes()).axes
    assert [line.get_ydata()[0] for line in upper_forest.lines] == [93, 67, 95, 65]
    gaps = [line.get_ydata() for line in lower_forest.lines if line.get_marker() == "o"]
    assert np.array(gaps) == pytest.approx(np.array([[26, 26], [30, 30]]))
    assert names(lower_forest) == names(upper_forest) == ["depth 3", "depth 5"]
    assert lower_network.get_xscale() == "log"
    assert [tick.get_text() for tick in lower_network.get_xticklabels()] == ["5", "20"]
    assert upper_network.lines[1].get_ydata() == pytest.approx([np.nan, 60], nan_ok=True)


def test_spectrum_shows_classes_as_dots_over_the_disturbance():
    (axes,) = map_figures.spectrum(residuals()).axes
    assert axes.get_yscale() == "log"
    crack = line(axes, "root tooth crack")
    assert crack.get_color() == CLASS_COLOURS["root_tooth_crack"]
    assert crack.get_ydata() == pytest.approx([1e-5 if order % 2 else 1e-4 for order in range(13)])
    (bars,) = axes.containers
    tops = [bar.get_y() + bar.get_height() for bar in bars]
    assert tops == pytest.approx([1e-3] * 6)  # odd orders to 11: neither an amplitude of 0 nor order 13 is drawn


@pytest.mark.parametrize(
    ("draw", "column"),
    [
        (lambda table: curve_figures.error(table, {}), "error"),
        (map_figures.inputs, "error"),
        (map_figures.spectrum, "amplitude"),
    ],
)
def test_nothing_to_draw_is_said(draw, column):
    empty = pd.DataFrame({name: pd.Series(dtype=float) for name in ("order", column)})
    with pytest.raises(ValueError, match=f"0 of 0 rows have a value of '{column}'.*run the jobs"):
        draw(empty)
