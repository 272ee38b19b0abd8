"""Virtual bench of a strain wave gear, written from shell theory, without code of the package it tests.

What differs from the package's physics:

- The flex spline is a shell of revolution (sleeve and clamped collar), solved for each wave number; no truss.
- Gauges are points on the back of the collar, where twisting of the plate outweighs its shear in the plane.
- The bearing of the wave generator is a seat of springs, and the teeth push against it.
- 200 teeth close gaps of their own, so the share of each follows from depth, torque and pitch errors.
- Churning grease brakes the input with the power 2/3 of speed; no viscous friction at the flanks.
- The load has 0.3 kg m2 and the speed control 8 Hz; Runge-Kutta in time, no harmonic balance.
- Friction in the mesh is in proportion to the torque; the flex spline has material damping.
- Each recording has its own load, speed, friction and zero of the angle; each day its own zeros and gains.

``python -m shell_bench OUT --seed S --case K`` writes case K of 0 to 19: 6 healthy, 10 known, 4 unknown effects.
"""
