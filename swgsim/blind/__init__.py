"""The blind test of the loop: a sealed set from the virtual bench, the loop's answers, the truth, and the score.

The command ``swg blind`` is ``blind_study``; the subpackage exports nothing.
"""
