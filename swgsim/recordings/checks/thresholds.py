"""Where a number stops to be plausible, each with its reason. A defect of these kinds is large, an effect is not:
the limits lie far from what a sick gear or a poor test bench does, so that no effect is taken for a defect."""

# Clock. A lost sample doubles a step; a sound clock's steps differ by far less, also where they are written rounded.
GAP = 1.5
SHORT_STEP = 0.5
# Share of a step, root mean square: a time written with 6 decimals at 10 kHz jitters by 0.3 %; order lines suffer from
# a few per cent.
JITTER_WARNS = 0.02
JITTER_REFUSES = 0.1

# Speed against the set point, relative. Speed control holds 0.5 %; a wrong unit or ratio is beyond 10 %.
SPEED_WARNS = 0.02
SPEED_REFUSES = 0.1
# How near the ratio must be to that of a wrong unit to be called by its name: 57.3 (degrees) and 60 differ by 5 %.
NAMED = 0.02
# Catalogue ratios of one stage, N and N + 1.
RATIOS = (30, 321)
# Turning back that counts [rad]: encoder jitter is under 1 degree; a drive that starts or swings turns back further.
TURNED_BACK = 0.05
# Share of the usual angle step that is missing or too much where samples are lost: one sample is a whole step.
ANGLE_JUMP = 0.7
# ... and in units of the scatter of the steps, below which a jump cannot be told from jitter and steps of the encoder.
JUMP_SCATTER = 4.0
JUMP_QUANTILE = 0.95
# Steps of the running median that the jumps are seen against.
JUMP_MEDIAN = 15

# Zero of the angle against that of the nominal gear [rad]. An index is set within 0.02 rad and gauges are bonded within
# 0.01 rad (standard deviations), which makes 0.021 for four gauges: about five times that.
ANGLE_ZERO = 0.1

# Mean torque at the output against the set point, relative and absolute [N m]. Flanges and load machines are off by a
# few per cent; pound-feet are 26 % off.
TORQUE_WARNS = (0.05, 0.5)
TORQUE_REFUSES = (0.2, 2.0)
# Mean torque at the input: at most the load through the smallest ratio at the poorest efficiency, and running torque
# without load [N m]; at least the load through the largest ratio without any loss.
POOREST_EFFICIENCY = 0.2
RUNNING_TORQUE = 5.0

# Half the range of a gauge near the wave generator [mV/V]: 0.17 in a size 17 gear; a factor of about 30 either way
# leaves room for other gears and gauges and still tells V/V (1e-3) and um/m (1e3).
GAUGE_SMALLEST = 6e-3
GAUGE_LARGEST = 6.0
# Half the range is that between these quantiles, so that single spikes do not count.
GAUGE_QUANTILES = (0.005, 0.995)
# Order-2 amplitude against the median of s1 to s4: cracks change it by up to 20 %.
GAUGE_GAIN = 2.0
# Share of half the range that order 2 has at least: 99 % in a sound gear, 90 % in the severest faults.
ORDER_2_SHARE = 0.3
# Phase of order 2 against the other gauges [degrees]: the severest faults move it by 10, a wrong sign by 180.
PHASE_WARNS = 30.0
PHASE_OPPOSITE = 135.0
# How signals rise with load: loads this far apart [N m], a rise this large [mV/V] (zeros drift by a few 1e-3), and
# this share of the median rise of the gauges.
LOAD_SPREAD = 5.0
LOAD_RISE = 5e-3
LOAD_SHARE = 0.3
# s0, a full bridge, rises with load twice as much as s1 to s4.
S0_SCALE = 30.0

# Equal values in a row at the largest or smallest value of a channel.
CLIPPED_RUN = 4
# Share of a gauge's samples that are cut: below, the rest still shows what it was, and a search for effects names it.
CLIPPED_REFUSES = 1 / 3
# How sharp the edge of such a plateau is against the peak of a coarsely digitised signal (see channel.py).
CLIPPED_EDGE = 2.0
# Equal values in a row of a gauge in whose signal a whole order-2 period is half a revolution [revolutions, samples].
STUCK_TURN = 0.125
STUCK_RUN = 10

# Revolutions of the wave generator in which orders 1/2, 1/3 and 1/4 are whole.
WHOLE_TURNS = 12
