#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/check_instructions.py, without valgrind."""

import contextlib
import io
import os
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..',
                                '..', 'scripts'))
import check_instructions  # noqa: E402

EXPECTED = {'description': 1000, 'pair': 2000, 'query': 3000}
BUILD = 'GNU 12 x86_64 Release'


class CheckInstructionsTest(unittest.TestCase):

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        path = os.path.join(directory.name, 'counts.json')
        patch = mock.patch.object(check_instructions, 'COUNTS', path)
        patch.start()
        self.addCleanup(patch.stop)
        check_instructions.renew(BUILD, EXPECTED)

    def run_main(self, counts, *arguments, build=BUILD, has_valgrind=True):
        output = io.StringIO()
        with mock.patch.object(check_instructions, 'count', lambda *_: counts), \
                mock.patch.object(check_instructions.shutil, 'which',
                                  lambda _: '/valgrind' if has_valgrind else None), \
                mock.patch.object(sys, 'argv', ['check', 'program', build, *arguments]), \
                contextlib.redirect_stdout(output):
            return check_instructions.main(), output.getvalue()

    def test_passes_where_nothing_has_changed(self):
        code, output = self.run_main(EXPECTED)
        self.assertEqual(code, 0)
        self.assertEqual(output.count('as expected'), 3)

    def test_fails_only_beyond_a_tenth_more(self):
        self.assertEqual(self.run_main({**EXPECTED, 'pair': 2190})[0], 0)
        code, output = self.run_main({**EXPECTED, 'pair': 2210})
        self.assertEqual(code, 1)
        self.assertIn('pair', output)
        self.assertIn('+10.5 %: TOO MANY', output)

    def test_fewer_are_fine(self):
        code, output = self.run_main({**EXPECTED, 'query': 2000})
        self.assertEqual(code, 0)
        self.assertIn('--renew', output)

    def test_fails_if_a_task_did_not_run(self):
        code, output = self.run_main({'pair': 2000, 'query': 3000})
        self.assertEqual(code, 1)
        self.assertIn('description did not run', output)

    def test_says_where_it_was_compiled_without_valgrind(self):
        def fail(*_):
            raise check_instructions.subprocess.CalledProcessError(77, 'valgrind')
        output = io.StringIO()
        with mock.patch.object(check_instructions, 'count', fail), \
                mock.patch.object(check_instructions.shutil, 'which', lambda _: 'v'), \
                mock.patch.object(sys, 'argv', ['check', 'program', BUILD]), \
                contextlib.redirect_stdout(output):
            self.assertEqual(check_instructions.main(), 77)
        self.assertIn('compiled without valgrind', output.getvalue())

    def test_skips_with_a_reason(self):
        code, output = self.run_main(EXPECTED, build='Clang 14 x86_64 Release')
        self.assertEqual(code, 77)
        self.assertIn('Clang 14 x86_64 Release', output)
        code, output = self.run_main(EXPECTED, has_valgrind=False)
        self.assertEqual(code, 77)
        self.assertIn('valgrind is not installed', output)

    def test_renews_one_build_and_keeps_the_others(self):
        fewer = {**EXPECTED, 'pair': 1500}
        self.assertEqual(self.run_main(fewer, '--renew', build='Clang 14')[0], 0)
        self.assertEqual(check_instructions.read_counts(),
                         {BUILD: EXPECTED, 'Clang 14': fewer})

    def test_reads_what_callgrind_writes(self):
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, 'profile.1')
            with open(path, 'w', encoding='utf-8') as file:
                file.write('desc: Trigger: Client Request: pair\n'
                           'events: Ir\nsummary: 1234\n')
            self.assertEqual(check_instructions.total_of(path), ('pair', 1234))
            with open(path, 'w', encoding='utf-8') as file:
                file.write('desc: Trigger: Program termination\nsummary: 9\n')
            self.assertIsNone(check_instructions.total_of(path))


if __name__ == '__main__':
    unittest.main()
