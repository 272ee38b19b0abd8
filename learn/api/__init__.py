"""The front door: data, classifiers and scores by the names of ``conf/``, without Hydra and MLflow.

Imports ``evaluation``, ``jobs`` and rooms below these.
"""
