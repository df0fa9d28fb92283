# SPDX-License-Identifier: GPL-2.0-or-later
"""The programs of scripts/ (and of bench/ and yade/): one package, called through the thin files there.

A module that is a subcommand has a docstring (its help), `add_options(parser)` and `work(options)`.
"""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[1]  # of the repository
