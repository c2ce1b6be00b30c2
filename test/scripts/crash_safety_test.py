#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Ends the program at random moments and takes the disk away from it.

usage: crash_safety_test.py PROGRAM [--kills N]

Whatever happens, each file has its old content or all of the new one, a rerun
works, and nothing else is left. Disks that are full or read-only need `unshare`
and the right to make a user namespace; without it, that part is left out.
"""

import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

TEMPORARY = "*.tmp-*"


class Failure(Exception):
    pass


def check(condition, what):
    if not condition:
        raise Failure(what)


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], text=True,
                          capture_output=True, timeout=300)


def check_refusal(result, what):
    check(result.returncode == 1, f"{what}: exit code {result.returncode}, "
                                  f"{result.stderr}")
    check(result.stderr.count("\n") == 1, f"{what}: not one line: "
                                          f"{result.stderr}")


def start_and_end(command, folder, seconds, number, on_sight):
    """Returns whether the process was still running, and a temporary file
    there."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    begin = time.monotonic()
    # Most of the time goes into work; what matters is when files are written.
    while on_sight and process.poll() is None:
        if any(folder.glob(TEMPORARY)):
            break
    else:
        while process.poll() is None and time.monotonic() < begin + seconds:
            time.sleep(0.001)
    if on_sight:
        time.sleep(random.uniform(0., 0.02))
    process.send_signal(number)
    ended_by = process.wait()
    if number == signal.SIGKILL:
        return ended_by == -number, any(folder.glob(TEMPORARY))
    # Such files are removed before the end.
    check(not any(folder.glob(TEMPORARY)), "a signal left temporary files")
    return ended_by == -number, False


class Job:
    """A run with the files that it changes: their contents before and after."""

    def __init__(self, program, folder, arguments, before):
        self.command = [program, *map(str, arguments)]
        self.folder = folder
        self.before = before
        self.restore()
        begin = time.monotonic()
        result = subprocess.run(self.command, capture_output=True, text=True)
        self.seconds = time.monotonic() - begin
        check(result.returncode == 0, result.stderr)
        self.after = {path: path.read_bytes() for path in self.files()}

    def files(self):
        return [path for path in self.folder.iterdir() if path.is_file()]

    def restore(self):
        for path in self.files():
            path.unlink()
        for path, content in self.before.items():
            path.write_bytes(content)

    def check_files(self):
        """Every file is an old one or a new one, as a whole."""
        for path, content in self.before.items():
            check(path.exists(), f"{path} is lost")
        for path in self.files():
            if path.match(TEMPORARY):
                continue
            check(path.read_bytes() in (self.before.get(path),
                                        self.after.get(path)),
                  f"{path} is torn")

    def check_rerun(self):
        subprocess.run(self.command, capture_output=True, check=True)
        check(not any(self.folder.glob(TEMPORARY)), "leftovers pile up")
        for path, content in self.after.items():
            check(path.read_bytes() == content, f"{path} differs")


def end_at_random(job, num_kills, number):
    num_killed = 0
    num_leftovers = 0
    for k in range(num_kills):
        if k % 10 == 0:
            job.restore()
        killed, leftovers = start_and_end(
            job.command, job.folder, random.uniform(0., 1.1 * job.seconds),
            number, on_sight=k % 2 == 0)
        num_killed += killed
        num_leftovers += leftovers
        job.check_files()
    job.restore()
    job.check_rerun()
    # A few may all come too late.
    check(num_killed > 0 or num_kills < 10, f"no run noticed signal {number}")
    print(f"  {num_killed} of {num_kills} ended by signal {number}, "
          f"{num_leftovers} left a temporary file; nothing torn or lost")
    return num_leftovers


def test_kills(program, folder, num_kills):
    work = folder / "kills"
    work.mkdir()
    source = folder / "open.pbstream"
    old = folder.joinpath("old.pbstream").read_bytes()
    output = work / "out.pbstream"
    table = work / "closures.csv"
    copying = Job(program, work,
                  ["close_loops", "--input", source, "--output", output,
                   "--closures", table],
                  {output: old, table: b"old\n"})
    in_place = Job(program, work,
                   ["close_loops", "--input", output, "--in_place",
                    "--nobackup"],
                   {output: source.read_bytes()})
    for job in (copying, in_place):
        job.restore()
        end_at_random(job, num_kills, signal.SIGKILL)
        end_at_random(job, max(2, num_kills // 5), signal.SIGTERM)
        end_at_random(job, max(2, num_kills // 5), signal.SIGINT)
    job.restore()
    output.unlink()


def test_backup_after_kills(program, folder, num_kills):
    """In place with a backup: the old map is somewhere, whatever happens."""
    work = folder / "backup"
    work.mkdir()
    old = (folder / "open.pbstream").read_bytes()
    new = (folder / "closed.pbstream").read_bytes()
    path = work / "map.pbstream"
    backup = work / "map.pbstream.bak"
    for k in range(num_kills):
        for file in work.iterdir():
            file.unlink()
        path.write_bytes(old)
        start_and_end([program, "close_loops", "--input", path, "--in_place"],
                      work, random.uniform(0., 1.), signal.SIGKILL,
                      on_sight=True)
        check(path.read_bytes() in (old, new), "the map is torn")
        if path.read_bytes() == new:
            check(backup.read_bytes() == old, "the old map is lost")
        if backup.exists():
            check(backup.read_bytes() == old, "the backup is torn")
    print(f"  {num_kills} kills while a map was changed in place: none lost")


def test_pipes(program, folder):
    source = folder / "open.pbstream"
    result = subprocess.run(
        ["bash", "-c", f"'{program}' info --input <(cat '{source}')"],
        capture_output=True, text=True, timeout=60)
    check_refusal(result, "a pipe as input")
    check("not a regular file" in result.stderr, result.stderr)
    print("  a pipe as input is refused")


def test_full_disk(program, folder, disk):
    """`disk` is a mounted file system of 1 MB."""
    source = folder / "open.pbstream"
    target = disk / "out.pbstream"
    arguments = [["simulate", "--output", target, "--truth", disk / "t.csv",
                  "--length", 150],
                 ["match", "--input", source, "--output", disk / "m.csv",
                  "--places", disk / "p.places"]]
    for output in (target, disk / "m.csv"):
        output.write_bytes(b"")
    # A file of places would fit an empty one.
    (disk / "other").write_bytes(b"\0" * 600000)
    for command in arguments:
        before = {path.name: path.read_bytes() for path in disk.iterdir()}
        result = run(program, *command)
        after = {path.name: path.read_bytes() for path in disk.iterdir()}
        if command[0] == "simulate":
            check_refusal(result, "simulate on a full disk")
            check("No space left" in result.stderr, result.stderr)
            check(after == before, f"{set(after) ^ set(before)}")
        else:
            check(result.returncode == 0, result.stderr)
            check("No space left" in result.stderr, result.stderr)
            check(set(after) == set(before), f"{set(after) ^ set(before)}")
    # Known before any work.
    begin = time.monotonic()
    result = run(program, "close_loops", "--input", source, "--output", target)
    check_refusal(result, "too small a disk")
    check("MB left" in result.stderr, result.stderr)
    check(time.monotonic() - begin < 1., "it took long to say so")
    print("  full disk: said in one line, nothing torn or left")


def test_read_only_disk(program, folder, disk):
    for arguments in (
            ["close_loops", "--output", disk / "out.pbstream"],
            ["match", "--output", disk / "m.csv"],
            ["audit", "--report", disk / "report"],
            ["close_loops", "--in_place"]):
        source = disk / "in.pbstream"
        begin = time.monotonic()
        result = run(program, arguments[0], "--input", source, *arguments[1:])
        check_refusal(result, f"read-only, {arguments}")
        check("Read-only file system" in result.stderr, result.stderr)
        check(time.monotonic() - begin < 1., "it took long to say so")
    result = run(program, "info", "--input", source)
    check(result.returncode == 0, result.stderr)
    print("  read-only disk: said at once, and reading works")


def test_disks(program, folder):
    """Runs in a mount namespace of its own."""
    disk = folder / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk]
    subprocess.run(mount, check=True)
    test_full_disk(program, folder, disk)
    subprocess.run(["umount", disk], check=True)
    subprocess.run(["mount", "-t", "tmpfs", "tmpfs", disk], check=True)
    source = folder / "open.pbstream"
    (disk / "in.pbstream").write_bytes(source.read_bytes())
    subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
    test_read_only_disk(program, folder, disk)


def can_unshare():
    try:
        return subprocess.run(
            ["unshare", "--user", "--map-root-user", "--mount", "mount", "-t",
             "tmpfs", "tmpfs", "/mnt"], capture_output=True).returncode == 0
    except FileNotFoundError:
        return False


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--kills", type=int, default=5)
    parser.add_argument("--disks_in", type=pathlib.Path,
                        help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    program = arguments.program
    if arguments.disks_in:
        return test_disks(program, arguments.disks_in)
    random.seed(1)
    # Shells start what runs in the background with SIGINT ignored, which the
    # program would keep to.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, length in (("open", 90), ("old", 30)):
            result = run(program, "simulate", "--output",
                         folder / f"{file}.pbstream", "--truth",
                         folder / f"{file}.csv", "--length", length)
            check(result.returncode == 0, result.stderr)
        result = run(program, "close_loops", "--input",
                     folder / "open.pbstream", "--output",
                     folder / "closed.pbstream")
        check(result.returncode == 0, result.stderr)
        test_kills(program, folder, arguments.kills)
        test_backup_after_kills(program, folder, arguments.kills)
        test_pipes(program, folder)
        if not can_unshare():
            print("  full and read-only disks: left out, no user namespaces")
            return None
        subprocess.run(
            ["unshare", "--user", "--map-root-user", "--mount", sys.executable,
             __file__, program, "--disks_in", folder], check=True)
    return None


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"crash_safety_test.py: {failure}")
