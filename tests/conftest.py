"""Shapes and types of the annotations are checked at run time, in tests only."""

import os

os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")

from jaxtyping import install_import_hook

install_import_hook(["swgsim", "learn"], "typechecker.typecheck")
