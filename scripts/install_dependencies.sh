#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Installs the Debian 12 packages that building and testing need, as root or
# with sudo. Asks the package manager for nothing where they are all there.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/install_dependencies.sh [--development] [--python] [--packages] [--ros]
                                        [--documentation] [--browser]
  --development  also what the static checks (clang-format, clang-tidy),
                 learning the score's weights (numpy), and the pictures of the
                 Python example (matplotlib) need
  --python       also what the Python module needs
  --packages     also what scripts/make_packages.sh and test_packages.sh need,
                 with the Python module
  --ros          also what the nodes for ROS 1 and scripts/test_ros.sh need,
                 besides an installed cartographer_ros
  --documentation  also what scripts/build_site.sh needs
  --browser      also what the test of reports in a browser needs
END
}

PACKAGES=(
  # Tools.
  cmake g++ ninja-build pkg-config protobuf-compiler python3
  # Libraries, in the order of CMakeLists.txt.
  libeigen3-dev libgoogle-glog-dev libgflags-dev libabsl-dev libceres-dev
  libprotobuf-dev zlib1g-dev liblua5.2-dev libcairo2-dev
  nlohmann-json3-dev libyaml-cpp-dev
  # Tests and benchmarks.
  libgtest-dev libgmock-dev libbenchmark-dev python3-jsonschema parallel valgrind
)
DEVELOPMENT_PACKAGES=(clang-format clang-tidy git python3-numpy python3-matplotlib)
PYTHON_PACKAGES=(pybind11-dev python3-dev python3-numpy)
# dpkg-shlibdeps, what it asks about files, and a bare root to install in.
PACKAGING_PACKAGES=(pybind11-dev python3-dev python3-numpy dpkg-dev file debootstrap)
ROS_PACKAGES=(
  # To build.
  catkin ros-message-generation ros-message-runtime libroscpp-dev
  libtf2-ros-dev libtf2-eigen-dev libtf2-dev libgeometry-msgs-dev
  libnav-msgs-dev libsensor-msgs-dev libvisualization-msgs-dev
  libdiagnostic-msgs-dev libstd-srvs-dev libstd-msgs-dev libpcl-conversions-dev
  librosbag-dev libroslib-dev liburdf-dev liburdfdom-headers-dev
  ros-geometry-msgs ros-std-msgs ros-sensor-msgs ros-nav-msgs
  ros-visualization-msgs ros-diagnostic-msgs ros-std-srvs ros-actionlib-msgs
  ros-tf2-msgs ros-roscpp-msg ros-rosgraph-msgs
  # To run: the master, launch files, bags, and scripts that listen.
  python3-rosbag python3-rosmaster python3-roslaunch python3-rosservice
  python3-rosnode python3-rostopic rosout python3-tf2-msgs python3-nav-msgs
  python3-sensor-msgs python3-std-srvs python3-diagnostic-msgs
  python3-visualization-msgs python3-rosgraph
  # The network of the test.
  iproute2 util-linux
)

# The generator of the site, its theme, Markdown and buttons, and the comments of
# headers.
DOCUMENTATION_PACKAGES=(python3-sphinx furo python3-myst-parser python3-sphinx-copybutton doxygen)
BROWSER_PACKAGES=(chromium chromium-driver python3-selenium)

fail() {
  echo "install_dependencies.sh: $*" >&2
  exit 1
}

while (($# > 0)); do
  case "$1" in
    --development) PACKAGES+=("${DEVELOPMENT_PACKAGES[@]}") ;;
    --python) PACKAGES+=("${PYTHON_PACKAGES[@]}") ;;
    --packages) PACKAGES+=("${PACKAGING_PACKAGES[@]}") ;;
    --ros) PACKAGES+=("${ROS_PACKAGES[@]}") ;;
    --documentation) PACKAGES+=("${DOCUMENTATION_PACKAGES[@]}") ;;
    --browser) PACKAGES+=("${BROWSER_PACKAGES[@]}") ;;
    -h | --help) usage && exit 0 ;;
    *) usage >&2 && exit 2 ;;
  esac
  shift
done

if ! command -v apt-get >/dev/null; then
  fail "needs Debian's package manager; elsewhere install by hand: ${PACKAGES[*]}"
fi

# Prints those of PACKAGES that are not installed, in one line.
missing_packages() {
  local package missing=()
  for package in "${PACKAGES[@]}"; do
    # One line for each installed architecture.
    dpkg-query -W -f='${db:Status-Status}\n' "${package}" 2>/dev/null |
      grep -x installed >/dev/null ||
      missing+=("${package}")
  done
  echo "${missing[*]}"
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  else
    sudo "$@"
  fi
}

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get \
    -o DPkg::Lock::Timeout=300 "$@" </dev/null
}

# Whether the package manager knows where to get each of the given packages.
all_available() {
  local package
  for package in "$@"; do
    apt-cache show "${package}" >/dev/null 2>&1 || return 1
  done
}

read -r -a missing <<<"$(missing_packages)"
if ((${#missing[@]} == 0)); then
  echo "All ${#PACKAGES[@]} packages are installed."
  exit 0
fi

((EUID == 0)) || command -v sudo >/dev/null ||
  fail "needs root or sudo to install: ${missing[*]}"

echo "Installing: ${missing[*]}"
all_available "${missing[@]}" || apt_get update ||
  echo "The package lists could not be updated; trying with what is there." >&2
if ! apt_get install -y --no-install-recommends "${missing[@]}"; then
  # A list that is out of date, or a download that broke.
  echo "Installation failed; trying once more with new package lists." >&2
  apt_get update || true
  apt_get install -y --no-install-recommends "${missing[@]}" ||
    fail "could not install: ${missing[*]}"
fi

read -r -a missing <<<"$(missing_packages)"
((${#missing[@]} == 0)) || fail "still not installed: ${missing[*]}"
echo "All ${#PACKAGES[@]} packages are installed."
