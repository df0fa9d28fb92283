# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures, drawn without a display and never left half written."""
import pathlib

from tools import files
from tools.errors import BadInput


def add_option(parser):
    parser.add_argument(
        "--picture", type=checked_name, metavar="FILE", help=".svg or .png to draw (python3-matplotlib)"
    )


def checked_name(text):
    path = pathlib.Path(text)
    if path.suffix not in (".svg", ".png"):
        raise BadInput(f"{path}: a picture is .svg or .png; name it so")
    return path


def pyplot():
    try:
        import matplotlib
    except ImportError:
        raise BadInput("the picture needs matplotlib; install python3-matplotlib or leave --picture out")
    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def save(figure, path, dpi=150):
    """The same table makes the same file."""
    with files.whole(path) as partial:
        figure.savefig(partial, dpi=dpi, metadata={"Date": None} if path.suffix == ".svg" else None)
