# SPDX-License-Identifier: GPL-2.0-or-later
"""Flips every sign, factor and comparison of a source, one at a time, and tells which flips its tests do not see.

All flips are compiled into one build of the tests, each behind a number that the environment variable MUTANT turns on
(switch.h): + and -, * and /, < and >, <= and >=, == and != change places, += with -= and *= with /=, a sign in front is left out,
std::min and std::max change places, and a number that multiplies or divides is taken larger. A flip is caught if a test fails,
crashes or takes over ten times as long. What is no arithmetic (pointers, texts), and what a constant expression is made of, is left
alone. Survivors that tools/mutate/equivalent.csv explains count as equivalent, not as caught."""
from tools.mutate.program import main  # noqa: F401
