"""A virtual test bench that shares no code with the model under test: another flex spline, another integrator.

Its flex spline is a thin shell of revolution, not a space truss; teeth carry by depth of engagement; the wave
generator is an elastic ring. Only the equations of motion are the paper's, (1) to (6), as those of any such gear are.
A loop that works on recordings of this bench has not merely inverted its own simulation.
"""
