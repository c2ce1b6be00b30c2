#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how the time and memory of close_loops grow with the map.

usage: measure_scaling.py PROGRAM JOIN DIRECTORY --drives 1,2,5,10 [--threads N]
                          [--wall] [--plot FILE.svg] [--work DIRECTORY]
                          [--configuration_directory DIRECTORY]
       measure_scaling.py PROGRAM JOIN DIRECTORY --maps A.pbstream,B.pbstream ...

PROGRAM is cartographer_sdf, JOIN test/benchmark/join_maps, DIRECTORY what
scripts/make_campus.py has made. For each number of drives, joins so many of them
to one map, or takes the maps of --maps in DIRECTORY as they are, closes its
loops, and prints the CPU seconds of each stage (those of
the clock on the wall with --wall). At the end, the slope of each stage: the exponent of the
number of submaps that fits its seconds best. --plot draws them.
"""

import argparse
import json
import math
import os
import subprocess
import sys

# Stages that never take longer than this are noise [s].
MIN_SECONDS = 0.3
COLOURS = ['#1b6ca8', '#c2452d', '#3c8c40', '#8a4fa3', '#b07d00', '#5b5b5b',
           '#008b8b', '#d06090']
WIDTH, HEIGHT, MARGIN, LEGEND = 760, 480, 60, 190


def maps_of(options, work):
    """The paths of the maps to measure, each made when it is its turn."""
    if options.maps:
        return (os.path.join(options.directory, name)
                for name in options.maps.split(','))
    return (joined_map(options.join, options.directory, int(count), work)
            for count in options.drives.split(','))


def joined_map(join, directory, count, work):
    path = os.path.join(work, f'campus_{count}.pbstream')
    if not os.path.exists(path):
        drives = [os.path.join(directory, f'drive_{k:02}.pbstream')
                  for k in range(count)]
        subprocess.run([join, path, *drives], check=True, stdout=subprocess.DEVNULL)
    return path


def cpu_clock(work):
    """Makes a library by which a program takes its CPU time for the time of day:
    seconds of a stage do not depend on what else the machine does."""
    source, library = (os.path.join(work, name) for name in ('clock.c', 'clock.so'))
    with open(source, 'w', encoding='utf-8') as file:
        file.write('#include <sys/syscall.h>\n#include <time.h>\n#include <unistd.h>\n'
                   'int clock_gettime(clockid_t id, struct timespec* t) {\n'
                   '  if (id == CLOCK_MONOTONIC) id = CLOCK_PROCESS_CPUTIME_ID;\n'
                   '  return (int)syscall(SYS_clock_gettime, id, t);\n}\n')
    subprocess.run(['cc', '-O1', '-shared', '-fPIC', '-o', library, source], check=True)
    return library


def close_loops(program, path, arguments, clock, work):
    """Returns the number of submaps, seconds by stage, and the megabytes."""
    result = os.path.join(work, 'result.json')
    subprocess.run([program, 'close_loops', path, '-o',
                    os.path.join(work, 'closed.pbstream'), '--result', result,
                    *arguments], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, **({'LD_PRELOAD': clock} if clock else {})})
    with open(result, encoding='utf-8') as file:
        document = json.load(file)
    return (document['counts']['submaps'], document['seconds']['stages'],
            document['peak_memory_bytes'] / 1e6)


def slope(points):
    """The exponent of x that fits y best; points are (x, y)."""
    logs = [(math.log(x), math.log(y)) for x, y in points if y > 0.]
    if len(logs) < 2:
        return None
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread


def lines_of(runs):
    """Points of each stage that matters, and of the memory, by name."""
    names = {name for _, seconds, _ in runs for name in seconds}
    lines = {name: [(submaps, seconds.get(name, 0.)) for submaps, seconds, _ in runs]
             for name in sorted(names)}
    return {name: points for name, points in lines.items()
            if max(y for _, y in points) >= MIN_SECONDS}


def ticks_around(values):
    """Of the numbers 1, 2, 5, 10, 20, ... those from below to above the values."""
    powers = range(math.floor(math.log10(min(values))) - 1,
                   math.ceil(math.log10(max(values))) + 1)
    ticks = [digit * 10. ** power for power in powers for digit in (1, 2, 5)]
    first = max(k for k, tick in enumerate(ticks) if tick <= min(values))
    last = min(k for k, tick in enumerate(ticks) if tick >= max(values))
    return ticks[first:last + 1]


def draw(lines, path):
    """Both axes are logarithmic."""
    points = [point for line in lines.values() for point in line if point[1] > 0.]
    ticks = [ticks_around([p[axis] for p in points]) for axis in (0, 1)]
    lows = [ticks[axis][0] for axis in (0, 1)]
    highs = [ticks[axis][-1] for axis in (0, 1)]
    inner = (WIDTH - 2 * MARGIN - LEGEND, HEIGHT - 2 * MARGIN)

    def at(x, y):
        u = math.log(x / lows[0]) / math.log(highs[0] / lows[0])
        v = math.log(y / lows[1]) / math.log(highs[1] / lows[1])
        return MARGIN + u * inner[0], HEIGHT - MARGIN - v * inner[1]

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
           f'font-family="sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for axis in (0, 1):
        for tick in ticks[axis]:
            begin = at(tick, lows[1]) if axis == 0 else at(lows[0], tick)
            end = at(tick, highs[1]) if axis == 0 else at(highs[0], tick)
            svg.append(f'<path d="M{begin[0]:.1f} {begin[1]:.1f}L{end[0]:.1f} '
                       f'{end[1]:.1f}" stroke="#ddd"/>')
            x, y, anchor = ((begin[0], begin[1] + 18, 'middle') if axis == 0 else
                            (begin[0] - 8, begin[1] + 4, 'end'))
            svg.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">'
                       f'{tick:g}</text>')
    svg.append(f'<text x="{MARGIN + inner[0] / 2:.0f}" y="{HEIGHT - 15}" '
               'text-anchor="middle">submaps</text>')
    svg.append(f'<text x="{MARGIN}" y="{MARGIN - 20}" text-anchor="middle">'
               'seconds</text>')
    svg.append(f'<text x="{WIDTH - LEGEND - MARGIN + 20}" y="{MARGIN - 20}">'
               'stage: exponent</text>')
    for k, (name, line) in enumerate(lines.items()):
        colour = COLOURS[k % len(COLOURS)]
        places = [at(x, y) for x, y in line if y > 0.]
        trace = 'L'.join(f'{x:.1f} {y:.1f}' for x, y in places)
        svg.append(f'<path d="M{trace}" fill="none" stroke="{colour}" '
                   'stroke-width="2"/>')
        svg += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>'
                for x, y in places]
        text = f'{name}: {slope(line):.2f}' if slope(line) is not None else name
        svg.append(f'<text x="{WIDTH - LEGEND - MARGIN + 20}" '
                   f'y="{MARGIN + 20 * k + 10}" fill="{colour}">{text}</text>')
    svg.append('</svg>\n')
    with open(path, 'w', encoding='utf-8') as file:
        file.write('\n'.join(svg))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program')
    parser.add_argument('join')
    parser.add_argument('directory')
    parser.add_argument('--drives', default='1,2,5,10,20')
    parser.add_argument('--maps')
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--configuration_directory')
    parser.add_argument('--wall', action='store_true')
    parser.add_argument('--plot')
    parser.add_argument('--work')
    options = parser.parse_args()
    work = options.work or options.directory
    os.makedirs(work, exist_ok=True)
    arguments = ['--threads', str(options.threads)]
    if options.configuration_directory:
        arguments += ['--configuration_directory', options.configuration_directory]
    clock = None if options.wall else cpu_clock(work)
    runs = []
    for path in maps_of(options, work):
        runs.append(close_loops(options.program, path, arguments, clock, work))
        submaps, seconds, megabytes = runs[-1]
        stages = ', '.join(f'{name} {value:.2f}' for name, value in seconds.items())
        print(f'{submaps} submaps: {sum(seconds.values()):.1f} s, {megabytes:.0f} MB; '
              f'{stages}', flush=True)
    lines = lines_of(runs)
    lines['all stages'] = [(submaps, sum(seconds.values()))
                           for submaps, seconds, _ in runs]
    print('\n| stage | ' + ' | '.join(str(submaps) for submaps, _, _ in runs) +
          ' | slope |')
    print('| --- ' * (len(runs) + 2) + '|')
    for name, points in lines.items():
        fit = slope(points)
        print(f'| {name} | ' + ' | '.join(f'{y:.2f}' for _, y in points) +
              f' | {"" if fit is None else f"{fit:.2f}"} |')
    print('| memory [MB] | ' + ' | '.join(f'{megabytes:.0f}' for _, _, megabytes in runs) +
          f' | {slope([(n, m) for n, _, m in runs]) or 0.:.2f} |')
    if options.plot:
        draw(lines, options.plot)


if __name__ == '__main__':
    sys.exit(main())
