"""Templates of pages; each page is one file that contains style and pictures."""

import base64

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined


def environment(package: str) -> Environment:
    """Jinja templates of a package, which may include ``style.css.jinja`` of this one; text is escaped.

    The filter ``data_uri`` puts the PNG of a picture into the page.
    """
    made = Environment(
        loader=ChoiceLoader([PackageLoader(package, ""), PackageLoader("swgsim.common", "")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["data_uri"] = lambda raw: "data:image/png;base64," + base64.b64encode(raw).decode()
    return made
