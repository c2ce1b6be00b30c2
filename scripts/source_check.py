# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""The command line that the checks of the source tree share."""

import pathlib
import sys


def run(usage, check_tree, find_faults):
    """The exit code of a check that is called as `usage` says.

    check_tree(root) gives all violations of a checkout, one line each;
    find_faults() gives what is wrong with the check itself.
    """
    name = pathlib.Path(sys.argv[0]).name
    if sys.argv[1:] == ["--self-test"]:
        lines = [f"self-test: {fault}" for fault in find_faults()]
    elif len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        print(usage.strip(), file=sys.stderr)
        return 2
    else:
        default = pathlib.Path(__file__).resolve().parent.parent
        root = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else default
        if not (root / "CMakeLists.txt").is_file():
            print(f"{name}: {root} is not a checkout of the project", file=sys.stderr)
            return 2
        lines = check_tree(root)
    for line in lines:
        print(line)
    return 1 if lines else 0
