"""Virtual test bench of a strain wave gear that shares no code and no structural model with the package.

What differs from the package's physics:
- Structure: shell with membrane and bending energy in Ritz functions (Legendre polynomials along the axis times
  harmonics 0 to 10 around), on the springs of a diaphragm. No truss.
- Wave generator: a bed of radial springs that can only press; its contact is iterated for each angle and load.
- Teeth: 200 forces, Gaussian around each lobe, wider with load. Teeth that stand further out carry more.
- Gauges: strains of the outer surface, integrated over grids at +-45 degrees, with transverse sensitivity.
- Signals: tables over angle and torque; cracks, uneven walls and loose clamps break the symmetry of the shell itself.
- Drive: angles of the output, not of a tooth pair. Flank friction grows with the torque of the spring; the bearing
  brakes the input by a constant and by a part with speed^(2/3). Control at 5 Hz, cogging, slow drift of the speed.
- Four of the cases are effects that the package doesn't know: chip, cardan joint, loose clamp, whirl.
Run `python -m ritz_bench OUT --seed S --case K`. Units are SI, except rpm and mV/V.
"""
