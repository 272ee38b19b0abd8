"""
Options by Optuna
=================

Optuna proposes the options of a classifier, and each trial is a job of ``swg train`` and a run in MLflow. The trials
see development gears only, each of which is left out in turn: gears that will be judged have no say. A second search
proposes the same options, and finds its runs finished.

Hydra's plugin for Optuna would need one file less, but it cannot be installed beside the Optuna that this project uses:
release 1.2.0 of hydra-optuna-sweeper asks for optuna below 3, the one in preparation for optuna below 5.
"""

import optuna
from hydra import compose, initialize_config_dir
from matplotlib.figure import Figure
from omegaconf import OmegaConf

import swgsim as swg
from learn.jobs import train_job
from swgsim.common.configured import conf_folder

swg.generate("gears_small", "bench", data="data", choices=["grid.name=development", "grid.seed=2"])
JOB = ["grid=gears_small", "grid.name=development", "condition=bench", "protocol=leave_one_gear_out"]
JOB += ["features=harmonics", "classifier=logistic_regression", "study=optuna"]


def right_on_development_gears(trial: optuna.Trial) -> float:
    """Share of recordings that are recognised [%]."""
    strength = trial.suggest_float("strength", 1e-2, 1e3, log=True)
    with initialize_config_dir(str(conf_folder()), version_base="1.3"):
        config = compose("train", [*JOB, f"classifier.strength={strength}"])
    return train_job.run(OmegaConf.to_container(config, resolve=True))["test_score"]


# %%
optuna.logging.set_verbosity(optuna.logging.WARNING)
study = optuna.create_study(direction="maximize", sampler=optuna.samplers.TPESampler(seed=0))
study.optimize(right_on_development_gears, n_trials=8)
print(f"strength {study.best_params['strength']:.3g}: {study.best_value:.1f} % on development gears")

# %%
# The same in MLflow: ``swg ui``, and there the study ``optuna`` with a run for each trial.
figure = Figure(figsize=(6.0, 3.2), layout="constrained")
axes = figure.add_subplot()
axes.semilogx([each.params["strength"] for each in study.trials], study.trials_dataframe()["value"], "o")
axes.set(xlabel="strength", ylabel="right on development gears [%]")
