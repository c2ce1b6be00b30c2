#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
"""Compiles the node for ROS 2 where ROS 2 is not installed, and runs nothing.

usage: check_ros2.py

Against the headers of ROS 2's packages, from their sources, with messages (ours,
too) by the generators that Debian has (rosidl-generator-c-cpp). Object files are
made, but not linked. Does nothing where something is absent, and says so.

environment:
  ROS2_SOURCES  a folder with the sources of ROS 2's packages and of
                cartographer_ros, as the src/ of a workspace (docs/ros.md lists them)
  BUILD_DIR     the build directory of this project; build/ of the checkout by
                default
  CXX           the compiler; c++ by default
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

SOURCE = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("BUILD_DIR", SOURCE / "build"))
NODE = SOURCE / "ros" / "cartographer_sdf_ros"
# What Debian has itself, in the version of its generators.
OF_DEBIAN = ("rosidl_runtime_c", "rosidl_runtime_cpp", "rosidl_typesupport_interface",
             "rosidl_typesupport_introspection_c", "rosidl_typesupport_introspection_cpp")
INTERFACES = ("msg", "srv")


def skip(why):
    print(f"check_ros2.py: skipped: {why}")
    sys.exit(0)


def fail(what):
    print(f"check_ros2.py: {what}", file=sys.stderr)
    sys.exit(1)


def find_packages(*roots):
    """Folders of packages by name."""
    packages = {}
    for root in roots:
        for folder, folders, files in os.walk(root):
            folders.sort()
            if "package.xml" in files:
                name = xml.etree.ElementTree.parse(pathlib.Path(folder, "package.xml")).findtext(
                    "name")
                packages.setdefault(name.strip(), pathlib.Path(folder))
                folders.clear()
    return packages


def dependencies_of(package):
    """What it needs to be compiled against in ROS 2."""
    tree = xml.etree.ElementTree.parse(package / "package.xml")
    return [element.text.strip() for element in tree.getroot()
            if re.fullmatch("(build_|build_export_)?depend", element.tag)
            and "!= 2" not in element.get("condition", "")]


def needed_packages(packages, names):
    """With all that they depend on, as far as it is there."""
    needed, waiting = {}, list(names)
    while waiting:
        name = waiting.pop()
        if name in needed or name not in packages:
            continue
        needed[name] = packages[name]
        waiting += dependencies_of(packages[name])
    return needed


def run(command, **options):
    result = subprocess.run([str(word) for word in command], check=False, text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, **options)
    if result.returncode != 0:
        fail(f"{' '.join(str(word) for word in command[:4])} ... failed:\n"
             + result.stdout[-20000:])


def generate_messages(needed, work):
    """Headers of messages and services of all packages; returns their number."""
    environment = dict(os.environ, AMENT_PREFIX_PATH="/usr",
                       PYTHONPATH=str(needed["ament_index_python"]))
    count = 0
    for name, package in sorted(needed.items()):
        files = [f"{package}:{path.relative_to(package)}" for kind in INTERFACES
                 for path in sorted(package.glob(f"{kind}/*.{kind}"))]
        if files:
            run(["rosidl", "generate", "-o", work / "messages" / name, "-t", "cpp", name, *files],
                cwd=work, env=environment)
        count += len(files)
    return count


def expand_templates(needed, work):
    """Headers that ROS 2's own builds make of templates, as their CMakeLists.txt do."""
    expand = ["/usr/bin/python3", "-c", "import em, sys; em.invoke(sys.argv[1:])"]
    made = work / "templates"
    interfaces = made / "rclcpp" / "node_interfaces"
    for folder in (interfaces, made / "rcutils", made / "tracetools"):
        folder.mkdir(parents=True)
    rcutils, rclcpp = needed["rcutils"], needed["rclcpp"]
    run([*expand, "-o", made / "rcutils" / "logging_macros.h",
         "-D", f'rcutils_module_path="{rcutils}"', rcutils / "resource" / "logging_macros.h.em"])
    run([*expand, "-o", made / "rclcpp" / "logging.hpp",
         rclcpp / "resource" / "logging.hpp.em"],
        env=dict(os.environ, PYTHONPATH=str(rcutils)))
    for path in sorted(rclcpp.glob("include/rclcpp/node_interfaces/node_*_interface.hpp")):
        for template, name in (("interface_traits", path.stem + "_traits"),
                               ("get_interface", "get_" + path.stem)):
            run([*expand, "-o", interfaces / (name + ".hpp"),
                 "-D", f"interface_name = '{path.stem}'",
                 rclcpp / "resource" / (template + ".hpp.em")])
    template = needed["tracetools"] / "include" / "tracetools" / "config.h.in"
    if template.exists():
        (made / "tracetools" / "config.h").write_text(
            re.sub(r"#cmakedefine (\w+)", r"#define \1", template.read_text()))
    return made


def include_options(needed, work, templates):
    """Ours with warnings, others' without."""
    cache = (BUILD / "CMakeCache.txt").read_text()
    found = re.search("^cartographer_DIR:PATH=(.*)/share/cartographer$", cache, re.MULTILINE)
    if not found:
        skip(f"{BUILD} is not built beside Cartographer")
    folders = [pathlib.Path("/usr/include") / name for name in OF_DEBIAN]
    folders += sorted((work / "messages").iterdir()) if (work / "messages").exists() else []
    folders += [work / "messages", templates]
    folders += [package / "include" for name, package in sorted(needed.items())
                if name not in OF_DEBIAN and (package / "include").is_dir()]
    folders += [pathlib.Path(found[1]) / "include", pathlib.Path("/usr/include/eigen3"),
                pathlib.Path("/usr/include/lua5.2"), pathlib.Path("/usr/include/pcl-1.13")]
    options = ["-I", SOURCE, "-I", NODE.parent]
    for folder in folders:
        options += ["-isystem", folder]
    return options


def main():
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    for command in ("rosidl", os.environ.get("CXX", "c++")):
        if not shutil.which(command):
            skip(f"there is no {command}")
    if "ROS2_SOURCES" not in os.environ:
        skip("ROS2_SOURCES does not say where the sources of ROS 2 are")
    if not (BUILD / "CMakeCache.txt").exists():
        skip(f"there is no build in {BUILD}")
    packages = find_packages(os.environ["ROS2_SOURCES"], SOURCE / "ros")
    needed = needed_packages(packages, ["cartographer_sdf_ros", "ament_index_python", "tracetools"])
    for name in ("rclcpp", "rcutils", "cartographer_ros", "ament_index_python", "tracetools"):
        if name not in needed:
            skip(f"{name} is not in {os.environ['ROS2_SOURCES']}")
    with tempfile.TemporaryDirectory() as directory:
        work = pathlib.Path(directory)
        count = generate_messages(needed, work)
        print(f"ok   headers of {count} messages and services, ours among them, are generated")
        options = include_options(needed, work, expand_templates(needed, work))
        for path in (NODE / "ros2" / "node_main.cc", NODE / "node_flags.cc"):
            run([os.environ.get("CXX", "c++"), "-std=c++17", "-O0", "-Wall", "-Wextra", "-Werror",
                 '-DCARTOGRAPHER_SDF_CONFIGURATION_DIRECTORY="."', *options,
                 "-c", path, "-o", work / (path.stem + ".o")])
            print(f"ok   {path.relative_to(SOURCE)} compiles")


if __name__ == "__main__":
    main()
