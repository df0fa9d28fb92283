# SPDX-License-Identifier: GPL-2.0-or-later
"""Files read and written with one clear line for every fault; nothing is left half written."""
import contextlib
import json
import os
import pathlib
import tomllib

from tools.errors import BadInput


def read_text(path, mend):
    """The text of a file. `mend` tells what to give instead where it cannot be read."""
    try:
        return pathlib.Path(path).read_text(encoding="utf-8")
    except OSError as e:
        raise BadInput(f"{path}: {e.strerror}; {mend}")
    except UnicodeDecodeError:
        raise BadInput(f"{path}: is no text; {mend}")


def read_json(path, mend):
    text = read_text(path, mend)
    try:
        return json.loads(text)
    except json.JSONDecodeError as e:
        raise BadInput(f"{path}:{e.lineno}: no JSON: {e.msg}; {mend}")


def read_toml(path, mend):
    text = read_text(path, mend)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as e:
        raise BadInput(f"{path}: no TOML: {str(e).splitlines()[0]}; {mend}")


@contextlib.contextmanager
def whole(path):
    """`with whole(path) as partial:` write to partial; it becomes path when all has gone well, else it goes."""
    path = pathlib.Path(path)
    partial = path.with_name(f"{path.stem}.{os.getpid()}.partial{path.suffix}")  # the suffix tells a picture's kind
    try:
        if path.is_dir():
            raise IsADirectoryError(21, "is a folder")
        yield partial
        partial.rename(path)
    except OSError as e:
        raise BadInput(f"{path}: cannot be written: {e.strerror}; state a file in a folder that is there")
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def write_text(path, text):
    with whole(path) as partial:
        partial.write_text(text, encoding="utf-8")


def write_json(path, value, indent=2):
    write_text(path, json.dumps(value, indent=indent) + "\n")
