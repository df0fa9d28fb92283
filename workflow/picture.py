# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of tables, drawn without a display and never left half written. Used by workflow/ and gap/responses."""


def pyplot():
    try:
        import matplotlib
    except ImportError:
        raise ImportError("the picture needs matplotlib; install python3-matplotlib or leave --picture out")
    matplotlib.use("Agg")
    import matplotlib.pyplot
    return matplotlib.pyplot


def save(figure, path):
    """Saves the figure under path, .svg or .png; the same table makes the same file."""
    partial = path.with_name(path.stem + ".partial" + path.suffix)
    figure.savefig(partial, dpi=150, metadata={"Date": None} if path.suffix == ".svg" else None)
    partial.rename(path)
