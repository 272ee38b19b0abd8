"""frame_bench: a virtual test bench of a strain wave gear, written independently of the package.

`python -m frame_bench OUT --seed S --case K` writes a healthy session, a second session in the state of case K, and the
truth. Cases 0 to 5 are healthy, 6 to 15 have a known effect, 16 to 19 something real that the library lacks.
What differs from the physics of the package:
- The flex spline is a frame: ten rings of 72 nodes from the clamped edge of the collar to the mouth of the sleeve, with
  bars, diagonals, bending and twist, solved wave by wave. Cracks and loose bolts are corrections of low rank.
- The cam presses on two rings through springs and opens the sleeve as a cone. Gauges see shear and twist of the collar.
- Teeth share the load by a raised cosine; deeper engagement by any form error gives a tooth more of it.
- The motion is integrated in time. The load inertia is 0.1 kg m^2, so the torsional resonance, near 60 Hz, meets order
  2 at 2000 rpm and order 1 at 4000 rpm. Friction acts at the output only; kinematic error is counted there.
- All bridges hum at 50 Hz, which is order 1 at 3000 rpm; a shell mode near 410 Hz rings in s1 to s4.
- Not modelled: lift-off of the cam, backlash, single teeth (a sector is 2.8 teeth), friction that follows temperature.
"""
