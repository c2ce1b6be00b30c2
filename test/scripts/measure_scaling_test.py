#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/measure_scaling.py and scripts/make_campus.py, without a drive."""

import argparse
import os
import sys
import tempfile
import unittest
from xml.etree import ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..',
                                '..', 'scripts'))
import make_campus  # noqa: E402
import measure_scaling  # noqa: E402

RUNS = [(100, {'match': 1., 'write': 0.1}, 50.), (400, {'match': 4., 'write': 0.2}, 90.)]


class MeasureScalingTest(unittest.TestCase):

    def test_slope_is_the_exponent(self):
        for exponent in (0., 1., 1.7):
            points = [(x, 3. * x ** exponent) for x in (10., 20., 70., 500.)]
            self.assertAlmostEqual(measure_scaling.slope(points), exponent)
        self.assertIsNone(measure_scaling.slope([(10., 1.)]))
        self.assertIsNone(measure_scaling.slope([(10., 1.), (20., 0.)]))

    def test_leaves_out_stages_that_take_no_time(self):
        self.assertEqual(measure_scaling.lines_of(RUNS),
                         {'match': [(100, 1.), (400, 4.)]})

    def test_ticks_enclose_the_values(self):
        self.assertEqual(measure_scaling.ticks_around([3., 40.]), [2., 5., 10., 20., 50.])
        self.assertEqual(measure_scaling.ticks_around([100., 200.]), [100., 200.])
        self.assertEqual(measure_scaling.ticks_around([7.]), [5., 10.])

    def test_takes_maps_as_they_are(self):
        options = argparse.Namespace(maps='a.pbstream,b.pbstream', directory='maps')
        self.assertEqual(list(measure_scaling.maps_of(options, 'work')),
                         [os.path.join('maps', name)
                          for name in ('a.pbstream', 'b.pbstream')])

    def test_draws_each_stage_with_its_slope(self):
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, 'plot.svg')
            measure_scaling.draw(measure_scaling.lines_of(RUNS), path)
            root = ElementTree.parse(path).getroot()
        texts = [element.text for element in root.iter() if element.text]
        self.assertIn('match: 1.00', texts)
        self.assertIn('submaps', texts)


class MakeCampusTest(unittest.TestCase):

    def test_ways_outdoors_are_walled_in_and_always_the_same(self):
        plan, again = make_campus.outdoors(7), make_campus.outdoors(7)
        self.assertEqual(plan.rows, again.rows)
        self.assertNotEqual(plan.rows, make_campus.outdoors(8).rows)
        self.assertEqual(set(plan.rows[0]), {0})
        self.assertEqual({row[0] for row in plan.rows}, {0})
        free = sum(row.count(255) for row in plan.rows)
        self.assertGreater(free, 0.6 * plan.size ** 2)

    def test_every_eighth_drive_is_outdoors(self):
        with tempfile.TemporaryDirectory() as directory:
            maps = [number for number in range(16)
                    if '--map' in make_campus.drive_of(number, directory, 10.)]
            self.assertEqual(maps, [7, 15])
            self.assertTrue(os.path.exists(os.path.join(directory, 'outdoors_07.pgm')))


if __name__ == '__main__':
    unittest.main()
