"""
A robot joint from its log
==========================

Robots log angle, speed and motor current of each joint. A column map, the *source*, says which column is what. The
logs of this example are computed here: a joint with load, friction that grows with the load, and noise.
"""

from pathlib import Path

import numpy as np
import pandas as pd

import swgsim as swg

# %%
# Three logs of a joint with a gear ratio of 100. The current [A] carries the load and the friction.
logs = Path("logs")
logs.mkdir(exist_ok=True)
time = np.arange(0, 40, 0.01)
for number in (1, 2, 3):
    rng = np.random.default_rng(number)
    q = sum(a * np.sin(2 * np.pi * f * time + rng.uniform(0, 6)) for a, f in ((0.9, 0.05), (0.5, 0.11), (0.2, 0.23)))
    omega = np.gradient(q, time)
    load = 60 * np.sin(q + 0.3) + 5 * np.gradient(omega, time)
    friction = (4.0 + 0.15 * np.abs(load)) * np.tanh(omega / 0.01) + 6 * omega
    current = (load + friction) / 12 + rng.normal(0, 0.03, len(time))
    log = pd.DataFrame({"t": time, "q": q, "w": omega, "load": load, "i": current})
    log.round(6).to_csv(logs / f"run{number}.csv", index=False)

# %%
# The source; docs/joint_recordings.md lists all that it can say.
Path("my_robot.yaml").write_text(r"""
robot: my robot
path: '(?P<session>(?P<run>[^/]+))\.csv'
files: ['*.csv']
time: {column: t, unit: s}
joints:
  elbow:
    gear_ratio: 100
    signals:
      q: {column: q, unit: rad}
      omega: {column: w, unit: rad/s}
      current: {column: i, unit: A}
      T_rigid: {column: load, unit: N m}
""")

# %%
# The same verbs as for gauges. The third log is held out: it judges what the others teach.
recordings = swg.recordings_of("my_robot.yaml", logs)
answer = swg.identify(recordings, holdout="run3")
print(answer.sentence)
figure = next(iter(answer.figures.values()))
