"""Configuration meets code: one job trains and judges one choice; a sweep keeps every job as a run.

``settings`` makes the objects of a configuration; ``train_job`` is one job, ``identity`` what distinguishes it from
others. The subpackage exports nothing.
"""
