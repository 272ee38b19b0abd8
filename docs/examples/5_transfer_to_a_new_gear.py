"""
Transfer to a new gear
======================

A classifier learns on some gears and is used on another one. A few labelled faults of the new gear, the shots, adapt
it. Here the forest keeps the structure of its trees, and moves their thresholds to fit the shots.
"""

import learn
import swgsim as swg

# Gears drawn from a population, recorded on a bench with its errors.
path = swg.generate("gears_small", "bench", data="data")
data = learn.load(path, features="harmonics")

# %%
# Each gear is left out in turn. Its error is compared with that of the forest without adaptation.
result = learn.transfer(data, "extra_trees", "structure_transfer", shots=(1, 2), folds=2)
print(result.table())
figure = result.plot()
