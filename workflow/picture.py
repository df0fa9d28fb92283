# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of tables, drawn without a display and never left half written. Used by workflow/ and gap/responses."""
from table import BadInput


def pyplot():
    try:
        import matplotlib
    except ImportError:
        raise ImportError("the picture needs matplotlib; install python3-matplotlib or leave --picture out")
    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def check(path):
    """Said before any work: whether a picture can be named so."""
    if path.suffix not in (".svg", ".png"):
        raise BadInput(f"{path}: a picture is .svg or .png; name it so")


def save(figure, path):
    """Saves the figure under path, .svg or .png; the same table makes the same file."""
    check(path)
    partial = path.with_name(path.stem + ".partial" + path.suffix)
    try:
        figure.savefig(partial, dpi=150, metadata={"Date": None} if path.suffix == ".svg" else None)
        partial.rename(path)
    except OSError as e:
        partial.unlink(missing_ok=True)
        raise BadInput(f"{path}: cannot be written: {e.strerror}; state a file in a folder that is there")
