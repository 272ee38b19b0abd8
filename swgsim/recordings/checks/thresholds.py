"""Limits of plausible numbers, each with its reason.

The limits are far beyond the effects of a faulty gear or a poor test bench, so no effect counts as a defect.
"""

# Clock. A lost sample doubles a step; steps of a sound clock differ by far less, even if they are written rounded.
GAP = 1.5
SHORT_STEP = 0.5
# Share of a step, root mean square: a time with 6 decimals at 10 kHz jitters by 0.3 %; a few per cent change order
# lines.
JITTER_WARNS = 0.02
JITTER_REFUSES = 0.1

# Speed against the set point, relative. Speed control holds 0.5 %; a wrong unit or ratio is beyond 10 %.
SPEED_WARNS = 0.02
SPEED_REFUSES = 0.1
# Tolerance for naming a wrong unit, relative: 57.3 (degrees) and 60 differ by 5 %.
UNIT_TOLERANCE = 0.02
# Catalogue ratios of one stage, N and N + 1.
RATIOS = (30, 321)
# Rotation backwards [rad]: encoder jitter is below 1 degree; a drive that starts or swings turns back further.
TURNED_BACK = 0.05
# Deviation of an angle step that counts as a lost sample, as a share of the usual step: one sample is a whole step.
ANGLE_JUMP = 0.7
# The same in units of the scatter of the steps; smaller jumps look like jitter and encoder steps.
JUMP_SCATTER = 4.0
JUMP_QUANTILE = 0.95
# Steps of the running median that is the usual step.
JUMP_MEDIAN = 15

# Zero of the angle against that of the nominal gear [rad]: about five standard deviations. An index is set within
# 0.02 rad and gauges are bonded within 0.01 rad (standard deviations), together 0.021 rad for four gauges.
ANGLE_ZERO = 0.1

# Mean torque at the output against the set point, relative and absolute [N m]. Flanges and load machines deviate by a
# few per cent, pound-feet by 26 %.
TORQUE_WARNS = (0.05, 0.5)
TORQUE_REFUSES = (0.2, 2.0)
# Mean torque at the input. Upper limit: load through the smallest ratio at the poorest efficiency, plus running torque
# without load [N m]. Lower limit: load through the largest ratio without loss.
POOREST_EFFICIENCY = 0.2
RUNNING_TORQUE = 5.0

# Half the range of a gauge near the wave generator [mV/V]: 0.17 in a size 17 gear. A factor of about 30 either way
# allows other gears and gauges and still separates V/V (1e-3) and um/m (1e3).
GAUGE_SMALLEST = 6e-3
GAUGE_LARGEST = 6.0
# The range is that between these quantiles, so that single spikes do not count.
GAUGE_QUANTILES = (0.005, 0.995)
# Order-2 amplitude against the median of s1 to s4: cracks change it by up to 20 %.
GAUGE_GAIN = 2.0
# Smallest share of order 2 in half the range: 99 % in a sound gear, 90 % in the severest faults.
ORDER_2_SHARE = 0.3
# Phase of order 2 against the other gauges [degrees]: the severest faults change it by 10, a wrong sign by 180.
PHASE_WARNS = 30.0
PHASE_OPPOSITE = 135.0
# Rise of signals with load: smallest difference of loads [N m], smallest rise [mV/V] (zeros drift by a few 1e-3), and
# smallest share of the median rise of the gauges.
LOAD_SPREAD = 5.0
LOAD_RISE = 5e-3
LOAD_SHARE = 0.3
# Largest factor between the rises of s0 and the others; s0, a full bridge, rises twice as much as s1 to s4.
S0_SCALE = 30.0

# Equal values in a row at the largest or smallest value of a channel.
CLIPPED_RUN = 4
# Share of clipped samples of a gauge: below it, the identification can name the effect from the other samples.
CLIPPED_REFUSES = 1 / 3
# Sharpness of the edge of a plateau against the peak of a coarsely digitised signal (see channel.py).
CLIPPED_EDGE = 2.0
# Equal values in a row of a gauge, whose order-2 period is half a revolution [revolutions, samples].
STUCK_TURN = 0.125
STUCK_RUN = 10

# Revolutions of the wave generator with whole periods of orders 1/2, 1/3 and 1/4.
WHOLE_TURNS = 12
