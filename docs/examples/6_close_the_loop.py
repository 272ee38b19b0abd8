"""
Close the loop on a folder of recordings
========================================

A virtual test bench records a gear twice: healthy, and with a wave generator that sits 10 µm off centre. Nothing in the
second folder says so. The loop learns the gear from the first folder and explains the residual of the second.
``docs/architecture.md`` names the function of every step from the folder to the sentence.
"""

from pathlib import Path

import swgsim as swg

few = ["sessions.repeats=2", "loads_nm=[7,70]", "mesh=default"]  # twice at four points, on the mesh of the model
swg.record("bench/healthy", seed=1, choices=[*few, "sessions.name=commissioning"])
swg.record("bench/today", swg.effects.EccentricWaveGenerator(r=10e-6, theta=1.0), seed=2, choices=few)

# %%
# Recordings are checked while they are read; folders of your own have the same form.
recordings = swg.read_recordings("bench/today")
print(recordings.table().head(3).to_string(index=False))

# %%
# Commissioning fits the healthy gear, and a file keeps it. The answer names the effect, its size and its 95 % interval.
swg.commission(swg.read_recordings("bench/healthy"), swg.Gear()).save("bench/gear1.unit.h5")
answer = swg.identify(recordings, swg.Unit.load("bench/gear1.unit.h5"))
print(answer.sentence)
print(answer.table().to_string(index=False))

# %%
figure = answer.plot_residual()
answer.save("answer")  # page.html to forward, report.json, effects.yaml
print(sorted(path.name for path in Path("answer").iterdir()))
