#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that no function in cartographer_sdf/ is too long to be read at once.

usage: check_function_length.py [SOURCE_DIRECTORY]
       check_function_length.py --self-test

A function may have 40 lines, signature and closing brace included. One of up to
60 needs a comment that begins with "// Long: " and says why, right above it or
as the first comment inside it. Prints one line for each violation and exits
with 1 if there is any. Understands C++ as clang-format leaves it.
"""

import re
import sys

import source_check

USUAL_LENGTH = 40
MAX_LENGTH = 60
REASON = re.compile(r"\s*// Long: \S")
COMMENT = re.compile(r"\s*//")

# What may hold braces that are none: comments, literals, and directives.
OPAQUE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)"'
    r'|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\''
    r"|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
PARENTHESES = re.compile(r"\([^()]*\)")
ACCESS = re.compile(r"\b(?:public|private|protected)\s*:(?!:)")
SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum|extern)\b")
INITIALIZED_MEMBER = re.compile(r"@.*[^:]:[^:].*[\w>]\s*$", re.DOTALL)


def blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def brace_kind(head):
    """What a brace outside of functions opens, by the text before it."""
    head = re.sub(r"\boperator\s*(?:\(\)|[^\s\w(]+)", "operator", head)
    while PARENTHESES.search(head):
        head = PARENTHESES.sub("@", head)
    if "@" not in head or re.search(r"=\s*$", head):
        return "scope" if SCOPE.search(head) and "=" not in head else "value"
    # Foo(int a) : a_{a} {}
    return "value" if INITIALIZED_MEMBER.search(head) else "function"


def functions(text):
    """Yields (first line, last line) of each function's definition."""
    code = OPAQUE.sub(blank, text)
    kinds = []
    begin = 0  # Of the declaration at hand.
    for brace in re.finditer(r"[{};]", code):
        is_outside = all(kind == "scope" for kind in kinds)
        kind = "end"
        if brace.group() == "{":
            head = ACCESS.sub(blank, code[begin:brace.start()])
            kind = brace_kind(head) if is_outside else "block"
            if kind == "function":
                first = begin + len(head) - len(head.lstrip())
            kinds.append(kind)
        elif brace.group() == "}":
            if not kinds:
                raise ValueError("a brace is closed that was never opened")
            kind = kinds.pop()
            if kind == "function":
                yield (text.count("\n", 0, first) + 1,
                       text.count("\n", 0, brace.start()) + 1)
        elif not is_outside:
            continue
        # A value's braces are part of the declaration around them.
        if kind != "value" and all(kind == "scope" for kind in kinds):
            begin = brace.end()
    if kinds:
        raise ValueError("a brace is never closed")


def says_why(lines, first, last):
    """Whether a comment above the function, or its first one, gives a reason."""
    above = first - 2
    while above >= 0 and COMMENT.match(lines[above]):
        if REASON.match(lines[above]):
            return True
        above -= 1
    inside = (line for line in lines[first - 1:last] if COMMENT.match(line))
    return REASON.match(next(inside, "")) is not None


def check_text(text):
    """Yields (line number, violation) of one file."""
    lines = text.splitlines()
    try:
        for first, last in functions(text):
            length = last - first + 1
            if length > MAX_LENGTH:
                yield first, f"a function of {length} lines; {MAX_LENGTH} are the most"
            elif length > USUAL_LENGTH and not says_why(lines, first, last):
                yield first, (f"a function of {length} lines, more than {USUAL_LENGTH}, "
                              'without a comment "// Long: <reason>"')
    except ValueError as error:
        yield 1, str(error)


def check_tree(root):
    """All violations of a tree, one line each."""
    return [f"{path.relative_to(root).as_posix()}:{number}: {violation}"
            for path in sorted((root / "cartographer_sdf").rglob("*"))
            if path.suffix in (".h", ".cc")
            for number, violation in check_text(path.read_text(encoding="utf-8"))]


# --- Self-test. ---------------------------------------------------------------


def body(length):
    """The inside of a function that has `length` lines with both its ends."""
    return "  Do();\n" * (length - 2)


# Text, and (first line, last line) of the functions in it.
PARSED = [
    ("int F() {\n  return 1;\n}\n", [(1, 3)]),
    ("namespace a {\nnamespace {\nvoid F() {}\n}  // namespace\n}  // namespace a\n", [(3, 3)]),
    ("template <typename T = int>\nabsl::StatusOr<T>\nF(int a = 1,\n  G b = {}) {\n}\n", [(1, 5)]),
    ("constexpr int k[] = {1,\n 2};\nstatic int F() { return k[0]; }\n", [(3, 3)]),
    ("const auto f = [](int a) {\n  return a;\n};\nvoid F() {\n}\n", [(1, 3), (4, 5)]),
    ("struct A {\n  int b{1};\n  std::vector<int> c = {1, 2};\n  int F() const {\n    return b;\n"
     "  }\n\n private:\n  // Text.\n  void G() noexcept {}\n};\n", [(4, 6), (10, 10)]),
    ("class A : public B<int> {\n  explicit A(int a)\n      : a_{a}, b_(std::move(c)), d_{} {\n  }\n"
     "};\n", [(2, 4)]),
    ("A::A(const int a) : a_(a) {\n}\nA::~A() { F(); }\n", [(1, 2), (3, 3)]),
    ("enum class E { kA, kB };\nextern \"C\" {\nvoid F() {\n}\n}\n", [(3, 4)]),
    ("bool operator==(const A& a, const A& b) {\n}\nbool A::operator()(int a) const {\n}\n"
     "A& operator=(A&&) = default;\nauto F() -> std::pair<int, int> {\n}\n",
     [(1, 2), (3, 4), (6, 7)]),
    ("struct S F(struct T t) {\n  if (a) {\n    struct { int i; } b = {1};\n  } else {\n  }\n"
     "  G([&](int c) {\n  });\n}\n", [(1, 8)]),
    ("// {\n/* {{ */\n#define M() { \\\n {\nvoid F() {\n  G(\"{\\\"{\", '{', '\\'', R\"x({ \" })x\");\n"
     "  int i = 1'000'000;\n}\n", [(5, 8)]),
    ("absl::Mutex m(1);\nint F() ABSL_GUARDED_BY(m) {\n}\n", [(2, 3)]),
]

# Text, and whether it is right.
JUDGED = [
    (f"void F() {{\n{body(40)}}}\n", True),
    (f"void F() {{\n{body(41)}}}\n", False),
    (f"// Does.\n// Long: a table.\nvoid F() {{\n{body(60)}}}\n", True),
    (f"// Long: a table\n// of two lines.\nvoid F() {{\n{body(60)}}}\n", True),
    (f"// Long: a table.\n\nvoid F() {{\n{body(60)}}}\n", False),
    (f"// Long:\nvoid F() {{\n{body(60)}}}\n", False),
    (f"void F() {{\n  // Long: a table.\n{body(59)}}}\n", True),
    (f"void F() {{\n  // Another.\n  // Long: a table.\n{body(58)}}}\n", False),
    (f"// Long: a table.\nvoid F() {{\n{body(61)}}}\n", False),
    (f"class A {{\n  void F() {{\n{body(41)}  }}\n}};\n", False),
    ("void F() {\n", False),
    ("}\n", False),
]


def find_faults():
    """What is wrong with this check itself."""
    faults = []
    for text, expected in PARSED:
        found = list(functions(text))
        if found != expected:
            faults.append(f"expected functions at {expected}, got {found}, in\n{text}")
    for text, is_right in JUDGED:
        found = list(check_text(text))
        if bool(found) == is_right:
            faults.append(f"got {found} for\n{text}")
    return faults


if __name__ == "__main__":
    sys.exit(source_check.run(__doc__, check_tree, find_faults))
