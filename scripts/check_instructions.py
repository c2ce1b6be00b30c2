#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Fails if describing a submap, matching a pair or asking the index takes more
than a tenth more instructions than it did.

usage: check_instructions.py PROGRAM BUILD [--renew]

PROGRAM is test/benchmark/count_instructions; BUILD names what made it, such as
"GNU 12 x86_64 Release": counts are those of one version of one compiler. valgrind
counts, so that the load of the machine does not matter. The counts that are
expected are in test/benchmark/instruction_counts.json; --renew writes those of
this build there, to be looked at in the change that makes them necessary. Exit
code 77, with the reason, where nothing can be compared.
"""

import argparse
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

COUNTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'test',
                      'benchmark', 'instruction_counts.json')
TASKS = ('description', 'pair', 'query')
MAX_INCREASE = 0.1
SKIPPED = 77


def skip(reason):
    print(f'check_instructions.py: skipped, {reason}')
    return SKIPPED


def total_of(profile):
    """Returns the task of one profile, and its instructions."""
    with open(profile, encoding='utf-8', errors='replace') as file:
        text = file.read()
    task = re.search(r'^desc: Trigger: Client Request: (\w+)', text, re.M)
    total = re.search(r'^(?:summary|totals): (\d+)', text, re.M)
    return (task.group(1), int(total.group(1))) if task and total else None


def count(program, directory):
    """Returns the instructions of each task, by its name."""
    subprocess.run(['valgrind', '--tool=callgrind', '--instr-atstart=no',
                    f'--callgrind-out-file={directory}/profile', program],
                   check=True, capture_output=True, text=True)
    totals = [total_of(profile)
              for profile in glob.glob(os.path.join(directory, 'profile*'))]
    return dict(total for total in totals if total)


def compare(counts, expected):
    """Prints a line for each task; returns whether one has become slower."""
    is_slower = False
    for task in TASKS:
        change = counts[task] / expected[task] - 1.
        verdict = 'as expected'
        if change > MAX_INCREASE:
            verdict = 'TOO MANY'
            is_slower = True
        elif change < -MAX_INCREASE:
            verdict = 'fewer: --renew keeps it so'
        print(f'{task}: {counts[task] / 1e6:.2f} million instructions, '
              f'{100. * change:+.1f} %: {verdict}')
    return is_slower


def read_counts():
    with open(COUNTS, encoding='utf-8') as file:
        return json.load(file)


def renew(build, counts):
    known = read_counts() if os.path.exists(COUNTS) else {}
    known[build] = {task: counts[task] for task in TASKS}
    with open(COUNTS, 'w', encoding='utf-8') as file:
        json.dump(known, file, indent=2, sort_keys=True)
        file.write('\n')


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program')
    parser.add_argument('build')
    parser.add_argument('--renew', action='store_true')
    options = parser.parse_args()
    if shutil.which('valgrind') is None:
        return skip('as valgrind is not installed')
    expected = read_counts().get(options.build) if not options.renew else None
    if expected is None and not options.renew:
        return skip(f'as there are no counts of {options.build!r} in '
                    f'{os.path.relpath(COUNTS)}; --renew adds them')
    with tempfile.TemporaryDirectory() as directory:
        try:
            counts = count(options.program, directory)
        except subprocess.CalledProcessError as error:
            if error.returncode == SKIPPED:
                return skip('as it was compiled without valgrind')
            print(f'check_instructions.py: valgrind failed\n{error.stderr}')
            return 1
    missing = [task for task in TASKS if task not in counts]
    if missing:
        print(f'check_instructions.py: {", ".join(missing)} did not run')
        return 1
    if options.renew:
        renew(options.build, counts)
        return 0
    return 1 if compare(counts, expected) else 0


if __name__ == '__main__':
    sys.exit(main())
