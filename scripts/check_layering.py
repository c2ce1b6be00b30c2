#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Checks what the compiler does not: who may include whom, and file headers.

usage: check_layering.py [SOURCE_DIRECTORY]
       check_layering.py --self-test

Prints one line for each violation and exits with 1 if there is any.
"""

import os
import pathlib
import re
import sys
import tempfile

import source_check

# The one-way arrows: what the files of a folder may include besides their own
# folder. An entry with a slash allows that header alone.
CORE = {
    "execution": [],
    "geometry": [],
    "grid": ["geometry"],
    "field": ["geometry", "grid"],
    "feature": ["geometry", "grid", "field"],
    "place": ["geometry", "grid", "field", "feature"],
    "matching": ["geometry", "grid", "field", "feature"],
    "verification": ["geometry", "grid", "field", "place"],
    "recognition": ["execution", "geometry", "grid", "field", "feature",
                    "place", "matching", "verification"],
}
OFFLINE = {
    "file": [],
    "map_image": ["geometry", "grid"],
    "recording": ["geometry", "grid", "file"],
    "pose_graph": ["geometry", "grid"],
    "pbstream": ["execution", "geometry", "grid", "file",
                 "pose_graph/pose_graph.h", "proto"],
    "place_store": [*CORE, "pose_graph", "pbstream", "proto"],
    "closing": [*CORE, "pose_graph", "pbstream"],
    "localization": [*CORE, "pose_graph", "pbstream", "place_store", "closing",
                     "proto"],
    "apps": [*CORE, "recording", "pose_graph", "pbstream", "place_store",
             "closing", "localization"],
    "report": [*CORE, "file", "pose_graph", "pbstream", "place_store",
               "closing", "localization", "apps"],
    "config": [*CORE, "pose_graph", "closing", "localization", "apps",
               "report/report_options.h"],
    "simulation": ["execution", "geometry", "grid",
                   "field/distance_transform.h", "file", "map_image",
                   "pose_graph/pose_graph.h", "pbstream", "proto"],
    "evaluation": [*CORE, "file", "pose_graph", "pbstream", "place_store",
                   "closing", "localization", "apps", "report", "config",
                   "simulation"],
}
TOP = {
    "live": [*CORE, "file", "recording", "pose_graph", "pbstream",
             "place_store", "closing", "localization", "config",
             "report/report_options.h", "proto"],
    "tools": [*CORE, *OFFLINE, "live"],
    # Packages of their own, on top of what is installed.
    "ros": ["geometry", "live"],
    "python": [*CORE, *OFFLINE],
}
ALLOWED = {**CORE, **OFFLINE, **TOP}

# What the core may include besides itself: these and the standard library.
CORE_LIBRARIES = ("Eigen/", "glog/")
# The only folders that see Cartographer's own headers.
HOST_FOLDERS = ("cartographer_sdf/live/", "cartographer_sdf/tools/grpc_server_main.cc",
                "test/live/", "test/fleet/", "ros/")
# Measures what Cartographer keeps to itself.
COMPARISON_WITH_HOST = "test/benchmark/measure_full_submap_search.cc"

SPDX = ("SPDX-FileCopyrightText: 2026 The cartographer_sdf authors",
        "SPDX-License-Identifier: Apache-2.0")
SPDX_SUFFIXES = (".h", ".cc", ".proto", ".py", ".sh", ".lua", ".cmake",
                 ".cmake.in", ".html", ".css", ".js")
SPDX_NAMES = ("CMakeLists.txt", ".ci/run")
CHECKED = ("CMakeLists.txt", ".ci", "cartographer_sdf", "cmake",
           "configuration_files", "proto", "python", "ros", "scripts", "test")

INCLUDE = re.compile(r"^\s*#\s*include\b\s*(.*)$")
SPELLED_INCLUDE = re.compile(r'^(?:"([^"]+)"|<([^>]+)>)')


def includes(text):
    """Yields (line number, path or None, is quoted) of every #include."""
    for number, line in enumerate(text.splitlines(), 1):
        directive = INCLUDE.match(line)
        if not directive:
            continue
        spelled = SPELLED_INCLUDE.match(directive.group(1))
        if spelled:
            yield number, spelled.group(1) or spelled.group(2), bool(spelled.group(1))
        else:
            yield number, None, False


def target_folder(header):
    """The folder that a header of ours is in, by our names for folders."""
    if header.endswith(".pb.h"):
        return "proto"
    return header.split("/")[1] if header.count("/") >= 2 else ""


def check_own_include(path, header):
    """A violation of the arrows by an include of one of our headers, or None."""
    parts = path.split("/")
    folder = parts[0] if parts[0] in ("ros", "python") else parts[1]
    target = target_folder(header)
    if parts[0] == "test":
        # Tests of the core link the core alone.
        if folder in CORE and target not in CORE:
            return f"a test of the core includes {header}"
        return None
    if target == folder or target in ALLOWED[folder]:
        return None
    if header.removeprefix("cartographer_sdf/") in ALLOWED[folder]:
        return None
    return f"{folder}/ must not include {header}"


def check_include(root, path, header, quoted):
    """A violation by one include, or None."""
    if header is None:
        return "an include that is not spelled out"
    if path == COMPARISON_WITH_HOST and header.startswith("cartographer/"):
        return None
    if "internal" in header.split("/"):
        return f"{header} is internal to another project"
    if "/../" in f"/{header}" or header.startswith("./"):
        return f'"{header}": name headers from the top of the tree'
    if header.startswith("cartographer_sdf/"):
        return check_own_include(path, header)
    if header.startswith("cartographer/"):
        if not path.startswith(HOST_FOLDERS):
            return f"only live/ may include Cartographer's {header}"
        return None
    if quoted and (root / path).with_name(header.split("/")[0]).exists():
        return f'"{header}": name headers from the top of the tree'
    if path.split("/")[:1] == ["cartographer_sdf"] and path.split("/")[1] in CORE:
        standard = "/" not in header and not header.endswith(".h")
        if not standard and not header.startswith(CORE_LIBRARIES):
            return f"the core must not depend on {header}"
    return None


def check_guard(path, text):
    """A violation by a wrong include guard, or None."""
    guard = re.sub(r"[/.]", "_", path).upper() + "_"
    directives = [line.split() for line in text.splitlines() if line.startswith("#")]
    good = (len(directives) >= 3
            and directives[0] == ["#ifndef", guard]
            and directives[1] == ["#define", guard]
            and directives[-1] == ["#endif", "//", guard])
    return None if good else f"include guard is not {guard}"


def check_spdx(text):
    """A violation by a missing licence header, or None."""
    lines = text.splitlines()[:3]
    if lines and lines[0].startswith(("#!", "<!DOCTYPE")):
        lines = lines[1:]
    found = [re.sub(r"^(?://|#|--|/\*|<!--)\s*(.*?)\s*(?:\*/|-->)?$", r"\1", line)
             for line in lines[:2]]
    return None if found == list(SPDX) else "no SPDX header at the top"


def check_cmake_folders(text):
    """Violations by folder lists of the build that differ from ours."""
    for name, table in (("CORE_FOLDERS", CORE), ("OFFLINE_FOLDERS", OFFLINE)):
        found = re.search(rf"set\({name}\s+([^)]*)\)", text)
        if not found or set(found.group(1).split()) != set(table):
            yield f"{name} differs from the table of check_layering.py"


def check_file(root, path):
    """Yields (line number, violation) of one file."""
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    parts = path.split("/")
    if path.endswith(SPDX_SUFFIXES) or path in SPDX_NAMES or parts[-1] in SPDX_NAMES:
        if violation := check_spdx(text):
            yield 1, violation
    if path == "CMakeLists.txt":
        for violation in check_cmake_folders(text):
            yield 1, violation
    if not path.endswith((".h", ".cc")):
        return
    if parts[0] == "cartographer_sdf" and (len(parts) != 3 or parts[1] not in ALLOWED):
        yield 1, "is in none of the folders that check_layering.py knows"
        return
    if path.endswith(".h") and (violation := check_guard(path, text)):
        yield 1, violation
    for number, header, quoted in includes(text):
        if violation := check_include(root, path, header, quoted):
            yield number, violation


def checked_files(root):
    """All files to check, sorted, relative to the root."""
    for name in CHECKED:
        if (root / name).is_file():
            yield name
        for directory, folders, files in os.walk(root / name):
            folders.sort()
            for file in sorted(files):
                yield (pathlib.Path(directory) / file).relative_to(root).as_posix()


def check_tree(root):
    """All violations of a tree, one line each."""
    return [f"{path}:{number}: {violation}"
            for path in checked_files(root)
            for number, violation in check_file(root, path)]


# --- Self-test. ---------------------------------------------------------------

CPP_SPDX = "".join(f"// {line}\n" for line in SPDX)
HASH_SPDX = "".join(f"# {line}\n" for line in SPDX)
GOOD_CMAKE = (f"{HASH_SPDX}set(CORE_FOLDERS {' '.join(CORE)})\n"
              f"set(OFFLINE_FOLDERS {' '.join(OFFLINE)})\n")


def source(*headers):
    return CPP_SPDX + "".join(
        f"#include {h}\n" if h[0] in '<"' else f'#include "{h}"\n' for h in headers)


def header(guard):
    return f"{CPP_SPDX}#ifndef {guard}\n#define {guard}\n#include <map>\n#endif  // {guard}\n"


# Path, content, and a part of the expected violation; None where it is right.
SAMPLES = [
    ("cartographer_sdf/grid/a.cc",
     source("cartographer_sdf/grid/a.h", "cartographer_sdf/geometry/rigid2.h",
            "<vector>", "<Eigen/Core>", "Eigen/Core", "glog/logging.h"), None),
    ("cartographer_sdf/geometry/a.cc", source("cartographer_sdf/grid/a.h"),
     "geometry/ must not include"),
    ("cartographer_sdf/field/a.cc", source("cartographer_sdf/feature/a.h"),
     "field/ must not include"),
    ("cartographer_sdf/feature/a.cc", source("cartographer_sdf/matching/a.h"),
     "feature/ must not include"),
    ("cartographer_sdf/place/a.cc", source("cartographer_sdf/verification/a.h"),
     "place/ must not include"),
    ("cartographer_sdf/matching/a.cc", source("cartographer_sdf/place/a.h"),
     "matching/ must not include"),
    ("cartographer_sdf/verification/a.cc", source("cartographer_sdf/matching/a.h"),
     "verification/ must not include"),
    ("cartographer_sdf/closing/a.cc",
     source("cartographer_sdf/recognition/a.h", "cartographer_sdf/pose_graph/a.h"), None),
    ("cartographer_sdf/closing/b.cc", source("cartographer_sdf/localization/a.h"),
     "closing/ must not include"),
    ("cartographer_sdf/apps/a.cc", source("cartographer_sdf/simulation/a.h"),
     "apps/ must not include"),
    ("cartographer_sdf/report/c.cc", source("cartographer_sdf/evaluation/a.h"),
     "report/ must not include"),
    ("cartographer_sdf/recognition/a.cc", source("cartographer_sdf/pose_graph/pose_graph.h"),
     "recognition/ must not include"),
    ("cartographer_sdf/recognition/b.cc",
     source("cartographer_sdf/matching/a.h", "cartographer_sdf/verification/a.h"), None),
    ("cartographer_sdf/pose_graph/a.cc",
     source("cartographer_sdf/geometry/a.h", "ceres/ceres.h"), None),
    ("cartographer_sdf/pose_graph/b.cc", source("cartographer_sdf/pbstream/map_file.h"),
     "pose_graph/ must not include"),
    ("cartographer_sdf/pbstream/a.cc",
     source("cartographer_sdf/pose_graph/pose_graph.h", "absl/status/status.h",
            "cartographer_sdf/serialized_state.pb.h", "<zlib.h>"), None),
    ("cartographer_sdf/pbstream/b.cc", source("cartographer_sdf/pose_graph/optimize.h"),
     "pbstream/ must not include"),
    ("cartographer_sdf/report/a.cc", source("cartographer_sdf/serialized_state.pb.h"),
     "report/ must not include"),
    ("cartographer_sdf/report/b.cc", source("cartographer_sdf/tools/a.h"),
     "report/ must not include"),
    ("cartographer_sdf/live/a.cc",
     source("cartographer_sdf/recognition/a.h", "cartographer/mapping/map_builder.h"), None),
    ("cartographer_sdf/live/b.cc", source("cartographer/mapping/internal/2d/a.h"), "internal"),
    ("cartographer_sdf/live/c.cc", source("cartographer_sdf/report/picture.h"),
     "live/ must not include"),
    ("cartographer_sdf/tools/a.cc", source("cartographer/mapping/map_builder.h"),
     "only live/ may include"),
    ("cartographer_sdf/tools/b.cc",
     source("cartographer_sdf/report/a.h", "cartographer_sdf/live/a.h"), None),
    ("cartographer_sdf/field/absl.cc", source("absl/strings/str_cat.h"), "must not depend on absl"),
    ("cartographer_sdf/field/ceres.cc", source("<ceres/ceres.h>"), "must not depend on ceres"),
    ("cartographer_sdf/field/cairo.cc", source("<cairo/cairo.h>"), "must not depend on cairo"),
    ("cartographer_sdf/field/lua.cc", source("<lua.h>"), "must not depend on lua.h"),
    ("cartographer_sdf/field/proto.cc", source("cartographer_sdf/serialized_state.pb.h"),
     "field/ must not include"),
    ("cartographer_sdf/field/spaced.cc",
     CPP_SPDX + '  #  include   "cartographer_sdf/closing/a.h"\n', "field/ must not include"),
    ("cartographer_sdf/field/macro.cc", CPP_SPDX + "#include HEADER\n", "not spelled out"),
    ("cartographer_sdf/field/relative.cc", source("../closing/a.h"), "from the top of the tree"),
    ("cartographer_sdf/field/sibling.cc", source("sibling.h"), "from the top of the tree"),
    ("cartographer_sdf/field/sibling.h", header("CARTOGRAPHER_SDF_FIELD_SIBLING_H_"), None),
    ("cartographer_sdf/field/guard.h", header("CARTOGRAPHER_SDF_FIELD_GUARDS_H_"), "include guard"),
    ("cartographer_sdf/field/once.h", CPP_SPDX + "#pragma once\n", "include guard"),
    ("cartographer_sdf/utils/a.cc", source("<vector>"), "in none of the folders"),
    ("cartographer_sdf/a.cc", source("<vector>"), "in none of the folders"),
    ("python/a.cc",
     source("cartographer_sdf/apps/a.h", "cartographer_sdf/grid/a.h", "python/b.h",
            "pybind11/stl.h"), None),
    ("python/b.cc", source("cartographer_sdf/live/a.h"), "python/ must not include"),
    ("python/c.cc", source("cartographer_sdf/tools/a.h"), "python/ must not include"),
    ("test/field/a_test.cc",
     source("cartographer_sdf/feature/a.h", "test/testing/a.h", "gtest/gtest.h"), None),
    ("test/field/b_test.cc", source("cartographer_sdf/pbstream/map_file.h"), "a test of the core"),
    ("test/report/a_test.cc", source("cartographer/io/image.h"), "only live/ may include"),
    ("test/live/a_test.cc", source("cartographer/io/image.h"), None),
    ("test/benchmark/measure_full_submap_search.cc",
     source("cartographer/mapping/internal/2d/a.h"), None),
    ("test/benchmark/b.cc", source("cartographer/mapping/internal/2d/a.h"), "internal"),
    ("test/testing/a.h", header("TEST_TESTING_A_H_"), None),
    ("scripts/good.py", "#!/usr/bin/env python3\n" + HASH_SPDX, None),
    ("scripts/bare.sh", "#!/usr/bin/env bash\necho\n", "no SPDX"),
    ("configuration_files/good.lua", HASH_SPDX.replace("#", "--"), None),
    ("configuration_files/bare.lua", "return {}\n", "no SPDX"),
    ("proto/cartographer_sdf/bare.proto", 'syntax = "proto3";\n', "no SPDX"),
    ("cartographer_sdf/grid/wrong_licence.cc",
     f"// {SPDX[0]}\n// SPDX-License-Identifier: MIT\n", "no SPDX"),
    ("cmake/bare.cmake", "message(a)\n", "no SPDX"),
    (".ci/run", "#!/usr/bin/env bash\n", "no SPDX"),
]


def check_table():
    """Faults of the table itself."""
    for folder, allowed in CORE.items():
        if not set(allowed) <= set(CORE):
            yield f"the core folder {folder} may include more than the core"
    finished, todo = set(), dict(ALLOWED)
    while todo:
        ready = [folder for folder, allowed in todo.items()
                 if {entry.split("/")[0] for entry in allowed} <= finished | {"proto"}]
        if not ready:
            yield f"the arrows have a cycle among {', '.join(sorted(todo))}"
            return
        for folder in ready:
            finished.add(folder)
            del todo[folder]


def find_faults():
    """What is wrong with this check itself."""
    faults = list(check_table())
    with tempfile.TemporaryDirectory() as directory:
        root = pathlib.Path(directory)
        for path, content, _ in [("CMakeLists.txt", GOOD_CMAKE, None), *SAMPLES]:
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(content, encoding="utf-8")
        found = {}
        for line in check_tree(root):
            found.setdefault(line.split(":")[0], []).append(line)
        for path, _, expected in SAMPLES:
            lines = found.pop(path, [])
            if len(lines) != (expected is not None) or not all(expected in l for l in lines):
                faults.append(f"{path}: expected {expected!r}, got {lines}")
        faults += [line for lines in found.values() for line in lines]
        (root / "CMakeLists.txt").write_text(GOOD_CMAKE.replace(" grid", ""), encoding="utf-8")
        if not any(line.startswith("CMakeLists.txt") for line in check_tree(root)):
            faults.append("a folder that the build does not know went unnoticed")
    return faults


if __name__ == "__main__":
    sys.exit(source_check.run(__doc__, check_tree, find_faults))
