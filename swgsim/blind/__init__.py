"""The blind test of the loop: a sealed set from the virtual bench, the loop's answers, the truth, and the score.

Imports ``identification``, ``jobs`` and rooms below these.
"""
