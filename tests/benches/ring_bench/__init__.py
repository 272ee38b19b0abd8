"""A virtual test bench of a strain wave gear, written apart from the package that it tests.

What differs from the physics of the package:
- The flex spline is a ring of 360 curved-beam elements on springs (the sleeve), not a space truss.
- Cam and teeth press through unilateral springs, so the zone of engagement grows with the load.
- The collar shows shear flow, spread on its way through the sleeve, and the twist that the wave forces on it.
- The kinematic error belongs to the circular spline. It repeats 0.99, 1.98 and 3.96 times per turn of the input, and
  its phase differs in each recording.
- Friction (Coulomb, a power of the speed, a share of the load) acts on the input, and the elastic twist is damped.
- The load (0.5 kg m^2) has two parts and a stiff coupling. The speed control works at 3 Hz.
- The set points are 2400, 3200 and 4000 rpm, away from the torsional resonance near 32 Hz.
- Each day has its own temperature, gains and zeros. Temperature and elapsed time stand in the manifest.
"""
