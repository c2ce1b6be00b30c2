#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that the package of the libraries asks for what its users need: the packages that its CMake configuration finds, and those whose
headers its own include.

usage: package_dependencies_test.py
"""

import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
# In CMake's names and in those of folders of headers.
DEBIAN = {"Eigen3": "libeigen3-dev", "Eigen": "libeigen3-dev", "glog": "libgoogle-glog-dev", "absl": "libabsl-dev",
          "Ceres": "libceres-dev", "ceres": "libceres-dev", "Protobuf": "libprotobuf-dev", "ZLIB": "zlib1g-dev",
          "yaml-cpp": "libyaml-cpp-dev", "PkgConfig": "pkg-config", "CAIRO": "libcairo2-dev",
          "nlohmann": "nlohmann-json3-dev"}
# Of every system, or of an installed Cartographer, which is no Debian package.
OTHERS = {"Threads", "cartographer", "Boost"}
# Their headers are not for users of the libraries.
PRIVATE_FOLDERS = {"live", "tools"}


def depends():
    text = (SOURCE / "cmake/Packages.cmake").read_text(encoding="utf-8")
    return re.search(r"CPACK_DEBIAN_DEV_PACKAGE_DEPENDS(.*?)\)", text, re.DOTALL).group(1).split()


class PackageDependenciesTest(unittest.TestCase):
    def check(self, name):
        if name not in OTHERS:
            self.assertIn(name, DEBIAN, "a package of Debian has to be named for it here")
            self.assertIn(DEBIAN[name], depends())

    def test_what_the_configuration_finds(self):
        text = (SOURCE / "cmake/cartographer_sdf-config.cmake.in").read_text(encoding="utf-8")
        names = re.findall(r"(?:find_dependency|pkg_check_modules)\(([\w-]+)", text)
        self.assertGreater(len(names), 5)
        for name in names:
            self.check(name)

    def test_what_the_headers_include(self):
        names = set()
        for header in (SOURCE / "cartographer_sdf").glob("*/*.h"):
            if header.parent.name not in PRIVATE_FOLDERS:
                names |= set(re.findall(r'^#include ["<](\w+)/', header.read_text(encoding="utf-8"), re.MULTILINE))
        self.assertIn("Eigen", names)
        for name in names - {"cartographer_sdf"}:
            self.check(name)


if __name__ == "__main__":
    unittest.main()
