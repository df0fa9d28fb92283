# SPDX-License-Identifier: GPL-2.0-or-later
"""The places of a source where a sign, factor or comparison can be flipped, found by clang, and the source with all flips in it."""
import bisect
import dataclasses

from clang.cindex import Config, CursorKind, Index, TypeKind

Config.set_library_file("/usr/lib/llvm-14/lib/libclang.so.1")

BINARY = {
    "+": "add",
    "-": "subtract",
    "*": "multiply",
    "/": "divide",
    "<": "less",
    ">": "greater",
    "<=": "less_equal",
    ">=": "greater_equal",
    "==": "equal",
    "!=": "unequal",
    "+=": "add_to",
    "-=": "take_from",
    "*=": "multiply_by",
    "/=": "divide_by",
}
FLIPPED = dict(zip(BINARY, ["-", "+", "/", "*", ">", "<", ">=", "<=", "!=", "==", "-=", "+=", "/=", "*="]))
ARITHMETIC = range(TypeKind.BOOL.value, TypeKind.LONGDOUBLE.value + 1)
NO_WORK = (CursorKind.STATIC_ASSERT, CursorKind.CASE_STMT, CursorKind.TYPE_ALIAS_DECL, CursorKind.TYPEDEF_DECL)
NO_WORK += (CursorKind.TYPE_ALIAS_TEMPLATE_DECL,)
OWN = ("VecOf", "Vec", "Eigen", "Matrix")  # what has arithmetic of its own


@dataclasses.dataclass
class Flip:
    number: int
    line: int
    text: str  # of the expression
    change: str  # "+ to -"
    nth: int  # of equal text and change, from 1


class Mutated:
    """`flips` of a file, and `text`: the source with all of them."""

    def __init__(self, path, arguments):
        self.path = path
        self.source = path.read_bytes()
        self.flips = []
        self._inserts = []  # (offset, order, text), of bytes; and the operator that goes
        self._gone = []
        self._lines = [0] + [i + 1 for i, c in enumerate(self.source) if c == 10]
        unit = Index.create().parse(str(path), args=arguments)
        faults = [d for d in unit.diagnostics if d.severity >= 3]
        if faults:
            raise RuntimeError(f"{path}: clang: {faults[0].spelling}")
        self._walk(unit.cursor, 0)
        self.text = self._apply()

    def _walk(self, cursor, depth):
        for child in cursor.get_children():
            place = child.location.file
            if depth == 0 and (place is None or place.name != str(self.path)):
                continue
            if child.kind in NO_WORK or self._is_constant(child):
                continue
            self._flip(child)
            self._walk(child, depth + 1)

    def _is_constant(self, cursor):
        if cursor.kind not in (CursorKind.VAR_DECL, CursorKind.FIELD_DECL):
            return False
        return any(t.spelling == "constexpr" for t in cursor.get_tokens())

    def _flip(self, cursor):
        children = list(cursor.get_children())
        kind = cursor.kind
        if kind in (CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            self._binary(cursor, *children)
        elif kind == CursorKind.CALL_EXPR and len(children) in (
            2,
            3,
        ):  # an operator of a class, or of a template's type
            inside = sorted((c for c in children if not self._is_operator_name(c)), key=self._start)
            if len(inside) == 2 and self._is_own(cursor, inside):
                self._binary(cursor, *inside)
        elif (
            kind == CursorKind.UNARY_OPERATOR and len(children) == 1 and self._start(cursor) < self._start(children[0])
        ):
            if self.source[self._start(cursor) : self._start(children[0])].strip() == b"-":
                self._negative(cursor, children[0])
        if kind == CursorKind.CALL_EXPR and cursor.spelling in ("min", "max"):
            self._min_or_max(cursor)

    def _is_own(self, cursor, inside):
        unknown = cursor.type.get_canonical().kind in (TypeKind.DEPENDENT, TypeKind.UNEXPOSED, TypeKind.INVALID)
        return unknown or any(name in cursor.type.spelling + inside[0].type.spelling for name in OWN)

    def _is_operator_name(self, cursor):
        return self.source[self._start(cursor) : self._end(cursor)].decode() in BINARY

    def _start(self, cursor):
        return cursor.extent.start.offset

    def _end(self, cursor):
        return cursor.extent.end.offset

    def _binary(self, cursor, left, right):
        begin, middle = self._end(left), self._start(right)
        between = self.source[begin:middle]
        operator = between.strip().decode(errors="replace")
        # brackets belong to an operand whose cursor leaves them out
        if operator not in BINARY or not self._arithmetic(left) or not self._arithmetic(right):
            return
        at = begin + between.index(operator.encode())
        number = self._add(cursor, f"{operator} to {FLIPPED[operator]}")
        self._inserts.append((self._start(cursor), 0, -self._end(cursor), f"mutant::{BINARY[operator]}({number}, "))
        self._gone.append((at, len(operator), ","))
        self._inserts.append((self._end(cursor), 1, -self._start(cursor), ")"))
        if operator in "*/":
            for side in (left, right):
                self._factor(side)

    def _arithmetic(self, cursor):
        kind = cursor.type.get_canonical().kind
        if kind.value in ARITHMETIC or kind in (
            TypeKind.DEPENDENT,
            TypeKind.UNEXPOSED,
            TypeKind.INVALID,
            TypeKind.ENUM,
        ):
            return True
        return any(name in cursor.type.spelling for name in OWN)

    def _negative(self, cursor, inside):
        if not self._arithmetic(inside):
            return
        number = self._add(cursor, "sign left out")
        start = self._start(cursor)
        self._gone.append((start, self._start(inside) - start, ""))
        self._inserts.append((start, 0, -self._end(cursor), f"mutant::negative({number}, "))
        self._inserts.append((self._end(cursor), 1, -start, ")"))

    def _factor(self, cursor):
        text = self.source[self._start(cursor) : self._end(cursor)].decode(errors="replace")
        if (
            not text
            or not (text[0].isdigit() or text[0] == ".")
            or not text.replace(".", "").replace("e", "").replace("-", "").isalnum()
        ):
            return
        number = self._add(cursor, "another factor")
        self._inserts.append((self._start(cursor), 0, -self._end(cursor), f"mutant::factor({number}, "))
        self._inserts.append((self._end(cursor), 1, -self._start(cursor), ")"))

    def _min_or_max(self, cursor):
        text = self.source[self._start(cursor) : self._end(cursor)].decode()
        call = f"std::{cursor.spelling}("
        if not text.startswith(call) or "{" in text[: len(call) + 1] or len(list(cursor.get_arguments())) != 2:
            return
        other = "max" if cursor.spelling == "min" else "min"
        number = self._add(cursor, f"{cursor.spelling} to {other}")
        # both are worked out; the comparison's flip is the choice between them
        self._gone.append((self._start(cursor), len(call), f"mutant::{cursor.spelling}imum({number}, "))

    def _add(self, cursor, change):
        start = self._start(cursor)
        line = bisect.bisect_right(self._lines, start)
        text = " ".join(self.source[start : self._end(cursor)].decode(errors="replace").split())
        nth = 1 + sum((f.text, f.change) == (text[:100], change) for f in self.flips)
        self.flips.append(Flip(len(self.flips) + 1, line, text[:100], change, nth))
        return len(self.flips)

    def _apply(self):
        edits = [(at, order, rank, 0, text) for at, order, rank, text in self._inserts]
        edits += [(at, 2, 0, length, text) for at, length, text in self._gone]
        # at one place: ends of inner expressions, ends of outer ones, starts of outer ones, starts of inner ones
        edits.sort(key=lambda e: (e[0], {1: 0, 0: 1, 2: 2}[e[1]], e[2]))
        out, last = [], 0
        for at, _, _, length, text in edits:
            if at < last:
                raise RuntimeError(f"{self.path}: flips overlap at byte {at}: {text}")
            out += [self.source[last:at], text.encode()]
            last = at + length
        return b'#include "tools/mutate/switch.h"\n' + b"".join(out) + self.source[last:]
