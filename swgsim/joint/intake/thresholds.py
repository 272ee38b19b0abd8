"""Where a number of a joint stops to be plausible, each with its reason. What a worn or badly modelled joint does must
stay within these limits: they are for mistakes of recording and of the source."""

# Medians and the sense of rotation of fewer samples say nothing.
FEWEST_SAMPLES = 100
# Angle that a run must go before its angle and velocity are compared [rad]: those of a real joint then agree to 3 %.
LEAST_MOVED = 0.02

# Way by the angle over way by the velocity, relative to 1. Rates from the motion of real runs scatter by 3 %, more
# where rows are missing; a wrong unit is beyond 30 %.
SCALE_WARNS = 0.1
SCALE_REFUSES = 0.3
# How near a ratio must be to that of a wrong unit to be called by its name: 57.3 (degrees) and 60 differ by 5 %, and
# rates scatter as above.
NAMED = 0.04
# ... and to 2 or 1/2, to which no other mistake comes near.
NAMED_HALF = 0.15
# Runs of a session of which the median rate is trusted.
FEWEST_FOR_MEDIAN = 3
# Parts of a run in which velocity and angle must agree, and root mean square of their difference against that of the
# angle's change. Real velocities are within 10 %; that of another joint, or of another time, is beyond 70 %. The parts
# that differ most are left out, as missing rows spoil a few and are found by themselves.
PARTS = 50
PARTS_USUAL = 0.9
APART_WARNS = 0.3
APART_REFUSES = 0.6
# No robot joint with a strain wave gear turns as fast at its output [rad/s]; 2 to 6 are usual.
FASTEST_JOINT = 30.0
# Share of the samples in which a velocity keeps its value although the joint turns. Measured ones do in 10 %, those
# counted from a coarse encoder in half of them; a set value does in all but a few.
SET_SHARE = 0.95

# What a wrapped angle may span beyond one revolution, as the jitter of an encoder at its index does.
WRAPPED = 1.001
# How near the step of an angle must be to a revolution to be its wrap, relative.
WRAP_STEP = 0.1

# Missing rows: steps of the angle beyond what the velocity says, in usual steps around them. Samples that are read once
# too often and skipped afterwards make 1; a recorder that stopped for a while makes many.
JUMP_STEPS = 3.5
# ... and in what such differences usually are (this quantile of theirs), so that noise of the angle is no jump.
JUMP_SCATTER = 8.0
JUMP_QUANTILE = 0.95
# Samples on either side of a step that say how large steps are there.
JUMP_AROUND = 10
# Equal rows in a row that count: the noise of a torque or current does not repeat all signals by chance.
HELD_ROWS = 3
# Share of missing or repeated rows above which what is left has no time of its own: the rate is then off by as much.
ROWS_REFUSE = 0.25

# Steps of time against the median. Real controllers alternate 10 and 12 ms and reach 16 once in a while; a lost sample
# doubles a step.
GAP = 1.75
SHORT_STEP = 0.5

# Share of the way that a torque, current or angle keeps one value. A digitised torque of a real joint does for 0.6 %.
FROZEN_WARNS = 0.05
FROZEN_REFUSES = 0.2
# A step of the way that no joint takes from one sample to the next [rad]; hostile numbers go no further.
FARTHEST = 1e9

# A clipped signal piles up at its largest value: this often, and so many times more often than at the next values;
# the largest value of noise is reached once or twice.
CLIPPED_COUNT = 10
CLIPPED_PILE = 5.0
CLIPPED_LEVELS = 5
# ... and so many times in a row.
CLIPPED_RUN = 4
# Share of samples that are cut above which the rest does not say what it was.
CLIPPED_REFUSES = 1 / 3

# Start of a run: blocks of the velocity; it is steady if its second half scatters less than this, relative, and is in
# its start where a block is off by this much, and by so many times that scatter.
START_BLOCKS = 50
STEADY = 0.1
START_OFF = 0.15
START_SCATTER = 5.0
