"""
A table of the paper
====================

The paper compares five classifiers on three selections of features (Table III). This example computes the column
"test" of its Table VII for three of them on the small grid, beside the published accuracies. ``make paper`` does it
for all tables on the whole grid.
"""

import pandas as pd

import learn
import swgsim as swg
from learn.paper import paper_table

path = swg.generate("small", "clean", data="data")
published = paper_table("table7").set_index(["features", "row", "classifier"])["paper"]

# %%
rows = []
for number in (1, 2, 3):
    selection = f"selection_{number}"
    data = learn.load(path, features=selection)
    for classifier in ("knn", "nb", "rf"):
        ours = learn.evaluate(data, classifier, protocol="random_folds").test_score
        rows.append((number, classifier, ours, published[selection, "test", classifier]))
table = pd.DataFrame(rows, columns=["selection", "classifier", "ours [%]", "paper [%]"]).set_index(
    ["selection", "classifier"]
)
print(table)

# %%
figure = table.plot.bar(figsize=(7, 3.5), ylim=(60, 101), ylabel="accuracy [%]", rot=30).figure
figure.set_layout_engine("constrained")
