"""Parts of the report whose studies need not have been run: what they say, or how to make them."""

from collections.abc import Mapping

import pandas as pd

from learn.transfer_report import adapted, input_studies, map_study, sections, studies
from learn.transfer_report.evidence import Evidence
from learn.transfer_report.transfer_page import Section


def no_reference(
    evidence: Evidence, of_inputs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]
) -> dict[str, str]:  # fmt: skip
    """Of :func:`learn.transfer_report.input_studies.no_reference`; empty without the study."""
    bare = evidence.of_study("no_reference").rename(index="no reference {}".format)
    if bare.empty:
        return {}
    return input_studies.no_reference(bare, of_inputs, {**predictions, **evidence.tables(bare, "predictions")})


def operating_point(evidence: Evidence) -> pd.DataFrame | None:
    """Of :func:`learn.transfer_report.input_studies.without_operating_point`; None without the study."""
    found = evidence.of_study("inputs_operating_point")
    if found.empty:
        return None
    return input_studies.without_operating_point(found, evidence.tables(found, "predictions"))


def where_it_pays(evidence: Evidence) -> Section:
    """The map."""
    found = evidence.of_study("transfer_map")
    adapts = found[found["adaptation"] != "none"] if len(found) else found
    if adapts.empty:
        return sections.left_out("map", "Where transfer pays", evidence.command("transfer_map"))
    plain = found.drop(index=adapts.index)
    best = map_study.best_unadapted(plain, evidence.tables(plain, "predictions"))
    table = map_study.transfer_map(adapts, evidence.tables(adapts, "specimens"), best)
    return adapted.where_it_pays(table, " or ".join(sorted(adapts["draws"].unique())))


def harder(evidence: Evidence) -> Section:
    """Harder splits."""
    found = evidence.of_study("harder_splits")
    if found.empty:
        return sections.left_out("harder", "Harder splits", evidence.command("harder_splits"))
    return sections.harder(studies.harder_splits(found))


def size(evidence: Evidence) -> Section:
    """Size and robustness of what was run."""
    names = ("forest_robustness", "network_robustness")
    found = [part for name in names if len(part := evidence.of_study(name))]
    if not found:
        return sections.left_out("size", "Size and robustness", " and ".join(map(evidence.command, names)))
    return sections.size(pd.concat([studies.robustness(part) for part in found], ignore_index=True))
