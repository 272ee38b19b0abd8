"""The public interface: data, classifiers and scores by the names of ``conf/``, without Hydra and MLflow.

Its names are those of ``import learn``, which imports them when they are used.
"""
