"""What a reader of the paper wants to know: which of its conclusions and claims hold over the drawn choices."""

from collections.abc import Mapping

from learn.paper_choices.analysis import Held, interval

WORDS = {
    "C1": "damping hardly shows in the signals",
    "C2": "stiffness shows in s0 alone",
    "C3": "eccentricity distorts s1 and s3",
    "C4": "a root crack changes all amplitudes",
    "C5": "a tip crack shows shortly in s1 and s3",
    "C6": "less damping, higher efficiency",
    "C7": "run-in",
    "C8": "opposite gauges are alike",
    "C9": "three faults separate in the DFT of differences",
    "C10": "the fourth root separates small changes",
    "C11": "RF and KNN are best on the same gears",
    "C12": "MLP is good on Selection 3 alone",
    "C13": "NB is good on Selection 1 alone, SVM is last",
    "C14": "Selection 2 does not improve the scores",
    "C15": "the scores of Table VIII, disturbed",
    "C16": "the scores of Table IX, another gear",
    "C17": "the scores of Table X, another gear and disturbed",
    "C18": "RF is most robust, yet not good enough",
}

# Conclusions of the paper in words: the claim, and those of its parts (learn.paper.claims) that state them.
CONCLUSIONS: Mapping[str, tuple[str, ...]] = {
    "RF is best on Selections 1 and 2": ("C11", "best S1", "best S2"),
    "MLP is below 84 % on Selections 1 and 2": ("C12", "MLP S1", "MLP S2"),
    "the DFT of single gauges does not improve MLP, SVM, RF and KNN": (
        "C14", *(f"{name} S2 to the best of S1, S3" for name in ("MLP", "SVM", "RF", "KNN")),
    ),
    "RF has the highest mean on a new gear, clean and disturbed": (
        "C18", "highest mean of Table IX", "highest mean of Table X",
    ),
    "disturbed, RF on Selection 3 stays below 95 % on a new gear": ("C18", "RF Table X S3 at worst"),
    "RF on Selection 1 is above 92 % on a new gear": ("C16", "RF S1 at worst"),
    "disturbed, MLP on Selection 3 is above 96 %": ("C15", "MLP S3"),
    "disturbed, RF on Selection 3 is above 96 %": ("C15", "RF S3"),
}  # fmt: skip
CONCLUDED = {
    "most": "Hold on most sets of choices",
    "half": "Not decided by these draws (the 95 % interval of the share holds one half)",
    "few": "Do not hold on most sets",
}

# Claims that test nothing here.
BY_CONSTRUCTION = {
    "C6": "by construction: b1 was set to it",
    "C7": "by construction: run-in was set to it",
    "C10": "by construction: its limits allow every gap from 0.01 to 23 % of the axis",
}
# Claims that depend on the width of a crack, which is not among the choices (docs/paper_choices.md).
BY_WIDTH = ("C4", "C5", "C9")
WIDTH = "depends on how many teeth a crack takes"
# How a claim holds, in the order of a reader.
GROUPS = {
    "always": "Hold on every set of choices",
    "mostly": "Hold on most, and no choice alone was found to decide",
    "depends": "Depend on a choice that the paper does not state",
    WIDTH: "Depend on how many teeth a crack takes, which the paper does not state and the draws do not vary (C4 and "
    "C9 come out with ten teeth, C5 with up to nine)",
    "seldom": "Hold on few, and no choice alone was found to decide",
    "never": "Held on none",
    "by": "Hold by construction and test nothing",
}


def conclusions(parts: Mapping[str, Mapping[str, float]], draws: int) -> dict[str, list[str]]:
    """The conclusions of the paper by how often they hold over the draws: most, half or few.

    A conclusion of several parts holds as its least part does. It holds on most if the 95 % interval of the share is
    above one half, on few if it is below.
    """
    groups: dict[str, list[str]] = {name: [] for name in CONCLUDED}
    for text, (key, *names) in CONCLUSIONS.items():
        shares = [parts[key][name] for name in names]
        low, high = interval(min(shares), draws)
        group = "most" if low > 0.5 else "few" if high < 0.5 else "half"
        shown = list(dict.fromkeys(f"{100 * share:.0f}" for share in sorted(shares)))
        groups[group].append(f"{text} ({' and '.join(shown) if len(shown) < 3 else f'{shown[0]} to {shown[-1]}'} %)")
    return {CONCLUDED[group]: texts for group, texts in groups.items() if texts}


def word(key: str, held: Held) -> str:
    """How a claim holds."""
    return WIDTH if key in BY_WIDTH else BY_CONSTRUCTION.get(key, held.words)


def reading(held: Mapping[str, Held]) -> dict[str, str]:
    """The claims of the paper, group by group."""
    groups: dict[str, list[str]] = {name: [] for name in GROUPS}
    for key, each in held.items():
        words = word(key, each)
        group = words if words in groups else words.split()[0]
        choices = f": {', '.join(each.depends_on).replace('_', ' ')}" if group == "depends" else ""
        groups[group].append(f"{WORDS[key]} ({key}{choices})")
    return {GROUPS[group]: "; ".join(texts) for group, texts in groups.items() if texts}
