"""The documentation site: Sphinx, built offline and strictly (make site)."""

import shutil
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from swgsim.common.version import __version__

project = "Strain wave gear workbench"
author = "the maintainers"
version = release = __version__
# Examples write where they lie, so that copies run.
EXAMPLES = Path(__file__).parent / "_build" / "examples"
shutil.rmtree(EXAMPLES, ignore_errors=True)
EXAMPLES.mkdir(parents=True)
for path in (Path(__file__).parent / "examples").glob("*.*"):
    shutil.copy(path, EXAMPLES)

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
html_theme = "furo"
html_title = f"Strain wave gear workbench {release}"
html_show_sphinx = False
html_show_copyright = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
exclude_patterns = ["_build", "examples", "effects"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

# Names of dimensions in the shapes of arrays look like references; the figure scraper is a function.
suppress_warnings = ["ref.python", "config.cache"]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # types stand in the docstrings, with shapes
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True


def figures(block: Any, variables: dict[str, Any], settings: dict[str, Any]) -> str:
    """Save the variable ``figure`` of an example that has a new one."""
    from sphinx_gallery.scrapers import figure_rst

    figure = variables["example_globals"].get("figure")
    if not isinstance(figure, Figure) or getattr(figure, "shown", False):
        return ""
    figure.shown = True  # type: ignore[attr-defined]
    path = next(variables["image_path_iterator"])
    figure.savefig(path, dpi=110)
    return figure_rst([path], settings["src_dir"])


sphinx_gallery_conf = {
    "examples_dirs": str(EXAMPLES),
    "gallery_dirs": "gallery",
    "filename_pattern": r"/\d_",
    "image_scrapers": (figures,),
    "capture_repr": (),
    "download_all_examples": False,
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,  # a page with scripts of other servers
    "abort_on_example_error": True,
    "run_stale_examples": False,
    "min_reported_time": 1e9,
    "within_subsection_order": "FileNameSortKey",
    "default_thumb_file": str(Path(__file__).parent / "flexspline.png"),
}
