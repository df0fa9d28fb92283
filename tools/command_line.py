# SPDX-License-Identifier: GPL-2.0-or-later
"""Options and errors of all programs: --help is the docstring, bad input is one line and exit status 2, failed work 1."""
import argparse
import os
import subprocess
import sys

from tools.errors import BadInput, RunFailed


def run(name, description, add_options, work):
    """A program with one job: add_options(parser), then work(options), which may return an exit status."""
    parser = _parser(name, description)
    add_options(parser)
    return _finish(name, lambda: work(parser.parse_args()))


def run_subcommands(name, description, modules):
    """A program with subcommands, {name: module}; a module's docstring is the subcommand's help."""
    parser = _parser(name, description)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command, module in modules.items():
        one = commands.add_parser(
            command, help=module.__doc__.split("\n")[0], description=module.__doc__, formatter_class=_FORMAT
        )
        module.add_options(one)
        one.set_defaults(work=module.work)
    told = next((f"{name} {word}" for word in sys.argv[1:2] if word in modules), name)

    def work():
        options = parser.parse_args()
        return options.work(options)

    return _finish(told, work)


_FORMAT = argparse.RawDescriptionHelpFormatter


def _parser(name, description):
    return argparse.ArgumentParser(prog=name, description=description, formatter_class=_FORMAT)


def _finish(name, work):
    try:
        status = work() or 0
        sys.stdout.flush()
        return status
    except BadInput as e:
        print(f"{name}: {e}", file=sys.stderr)
        return 2
    except RunFailed as e:
        print(f"{name}: {e}", file=sys.stderr)
        return 1
    except subprocess.CalledProcessError as e:  # it has said what is wrong itself
        return e.returncode
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # a reader that has seen enough (| head) is no fault
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
