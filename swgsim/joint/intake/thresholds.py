"""Limits of plausible numbers of a joint, each with its reason. A worn or badly modelled joint must stay within them:
they detect mistakes of the recording and of the source."""

# Medians and the direction of rotation of fewer samples are not reliable.
FEWEST_SAMPLES = 100
# Distance from which angle and velocity are compared [rad]: in a real joint they then agree to 3 %.
LEAST_MOVED = 0.02

# Windows of a run in which the direction of rotation is determined.
WINDOWS = 100
# A run is in one direction if it ends at least this share of its whole range away from its start.
ONE_WAY = 0.5

# Distance by the angle over distance by the velocity, relative to 1. Rates from the motion of real runs scatter by 3 %,
# and more if rows are missing; a wrong unit changes the ratio by more than 30 %.
SCALE_WARNS = 0.1
SCALE_REFUSES = 0.3
# Relative distance within which a ratio is attributed to a wrong unit: 57.3 (degrees) and 60 differ by 5 %.
UNIT_TOLERANCE = 0.04
# The same for 2 and 1/2, which no other mistake comes near.
NAMED_HALF = 0.15
# Runs of a session whose median rate is trusted.
FEWEST_FOR_MEDIAN = 3
# Parts of a run in which velocity and angle must agree; limits of their rms difference relative to the change of the
# angle. Real velocities agree within 10 %; the velocity of another joint or another time differs by more than 70 %. The
# worst parts are left out, because missing rows spoil a few and have a finding of their own.
PARTS = 50
PARTS_USUAL = 0.9
APART_WARNS = 0.3
APART_REFUSES = 0.6
# No robot joint with a strain wave gear turns faster at its output [rad/s]; 2 to 6 are usual.
FASTEST_JOINT = 30.0
# Share of the samples in which a velocity keeps its value although the joint turns: 10 % for a measured velocity, half
# for one from a coarse encoder, nearly all for a set value.
SET_SHARE = 0.95

# Largest span of a wrapped angle in revolutions; an encoder jitters at its index.
WRAPPED = 1.001
# A step of the angle counts as a wrap if it differs from a revolution by less than this share.
WRAP_STEP = 0.1

# Missing rows: steps of the angle beyond the velocity, in usual steps around them. A sample that was read twice
# makes 1, a recorder that stopped makes many.
JUMP_STEPS = 3.5
# The same in units of this quantile of all such differences, so that noise of the angle is not a jump.
JUMP_SCATTER = 8.0
JUMP_QUANTILE = 0.95
# Samples on either side of a step that give the usual step.
JUMP_AROUND = 10
# Consecutive equal rows that are reported: noise does not repeat all signals by chance.
HELD_ROWS = 3
# Share of missing or repeated rows above which a run is refused: its rate would be wrong by as much.
ROWS_REFUSE = 0.25

# Steps of time relative to the median. Real controllers alternate 10 and 12 ms with rare steps of 16; a lost sample
# doubles a step.
GAP = 1.75
SHORT_STEP = 0.5

# Share of the distance over which a torque, current or angle keeps one value: 0.6 % for a real digitised torque.
FROZEN_WARNS = 0.05
FROZEN_REFUSES = 0.2
# Largest step from one sample to the next [rad], which bounds sums over hostile numbers.
FARTHEST = 1e9

# A clipped signal has its largest value this often, and so many times more often than the next values. Noise reaches
# its largest value once or twice.
CLIPPED_COUNT = 10
CLIPPED_PILE = 5.0
CLIPPED_LEVELS = 5
# Consecutive samples at that value.
CLIPPED_RUN = 4
# Share of clipped samples above which a run is refused.
CLIPPED_REFUSES = 1 / 3

# Start-up: blocks of the velocity. A run is steady if its second half scatters less than STEADY, relative. A block
# belongs to the start-up if it differs by START_OFF, relative, and by START_SCATTER times that scatter.
START_BLOCKS = 50
STEADY = 0.1
START_OFF = 0.15
START_SCATTER = 5.0
