"""
A healthy gear and a crack
==========================

The chain simulates five strain-gauge bridges on the flex spline. A root tooth crack lowers the stiffness of one
tooth pitch of the rim. The signals change while a lobe of the wave generator passes the crack.
"""

import numpy as np

import swgsim as swg

gear = swg.Gear()  # the first gear of the paper: size 17, ratio 100
point = swg.OperatingPoint(n_in_rpm=2000, T_out=39)

# %%
# One run is one gear at one operating point, with any number of effects.
healthy = swg.simulate(gear, point)
crack = swg.effects.RootToothCrack(stiffness_ratio=0.03, theta=1.0)
cracked = swg.simulate(gear, point, crack)

# %%
# The result has the channels of a test bench, and draws itself; the healthy gear is grey.
figure = cracked.plot(compare=healthy)

# %%
# How much of the ripple of each gauge is due to the crack?
difference = cracked.signals - healthy.signals
share = 100 * np.ptp(difference, axis=1) / np.ptp(healthy.signals, axis=1)
print("change of s1 to s4, percent of their ripple:", share[1:].round(1))
