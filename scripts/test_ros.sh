#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Builds the packages in ros/ beside an installed cartographer_ros (ROS 1), and
# runs them: maps a recording, localises in the map, and finds a robot again
# that was carried away. Does nothing where one of these is absent, and says so.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/test_ros.sh
environment:
  BUILD_DIR                the build directory of this project, which must be
                           built; build/ of the checkout by default
  CARTOGRAPHER_ROS_PREFIX  where cartographer_ros is installed, as by
                           catkin_make_isolated --install;
                           ~/cartographer_ros_ws/install_isolated by default
  ROS_TEST_LOG             the recording to drive; willow_1.log.gz of the data
                           that are not part of the project by default
  ROS_TEST_RECORD          a bag to record what the layouts show into, for
                           scripts/draw_foxglove_layout.py; none by default
END
}

case "${1:-}" in
  "") ;;
  -h | --help) usage && exit 0 ;;
  *) usage >&2 && exit 2 ;;
esac

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build}"
export CARTOGRAPHER_ROS_PREFIX="${CARTOGRAPHER_ROS_PREFIX:-${HOME}/cartographer_ros_ws/install_isolated}"
if [[ -n "${ROS_TEST_RECORD:-}" ]]; then
  ROS_TEST_RECORD="$(realpath -m "${ROS_TEST_RECORD}")"
  export ROS_TEST_RECORD
fi
LOG="${ROS_TEST_LOG:-${SOURCE_DIR}/../shared/data/willow_1.log.gz}"

skip() {
  echo "test_ros.sh: skipped: $*"
  exit 0
}

for command in catkin_make_isolated roscore roslaunch rosbag rosnode ip unshare; do
  command -v "${command}" >/dev/null || skip "there is no ${command} (docs/ros.md lists the packages)"
done
/usr/bin/python3 -c "import rosbag, rospy, nav_msgs.msg, sensor_msgs.msg, tf2_msgs.msg, \
diagnostic_msgs.msg, std_srvs.srv, visualization_msgs.msg" 2>/dev/null ||
  skip "Python modules of ROS are missing (docs/ros.md lists the packages)"
[[ -x "${CARTOGRAPHER_ROS_PREFIX}/lib/cartographer_ros/cartographer_node" ]] ||
  skip "cartographer_ros is not installed in ${CARTOGRAPHER_ROS_PREFIX}"
[[ -f "${LOG}" ]] || skip "there is no recording ${LOG}"
[[ -f "${BUILD_DIR}/libcartographer_sdf_live.a" ]] ||
  skip "live/ is not built in ${BUILD_DIR}"
unshare -rn true 2>/dev/null || unshare -n true 2>/dev/null ||
  skip "no network namespace can be made"

WORK="$(mktemp -d)"
trap 'rm -rf "${WORK}"' EXIT

# Whether a workspace with the checkout and with ros/ has the three packages, in
# ROS 1 and in ROS 2, to catkin and, where it is installed, to colcon.
check_workspace() {
  local version expected="cartographer_sdf cartographer_sdf_msgs cartographer_sdf_ros"
  mkdir -p "${WORK}/whole/src"
  ln -s "${SOURCE_DIR}" "${WORK}/whole/src/cartographer_sdf"
  ln -s "${SOURCE_DIR}/ros" "${WORK}/whole/src/ros"
  for version in 1 2; do
    [[ "$(ROS_VERSION="${version}" /usr/bin/python3 -c '
import sys
from catkin_pkg.topological_order import topological_order
print(*[package.name for _, package in topological_order(sys.argv[1])])
' "${WORK}/whole/src")" == "${expected}" ]] || return 1
    command -v colcon >/dev/null || continue
    [[ "$(cd "${WORK}/whole" && ROS_VERSION="${version}" colcon list --names-only |
      sort | tr '\n' ' ')" == "${expected} " ]] || return 1
  done
}

build() {
  cmake --install "${BUILD_DIR}" --prefix "${WORK}/prefix" >/dev/null
  mkdir -p "${WORK}/workspace/src"
  ln -s "${SOURCE_DIR}/ros" "${WORK}/workspace/src/ros"
  local cartographer
  cartographer="$(sed -n 's/^cartographer_DIR:PATH=//p' "${BUILD_DIR}/CMakeCache.txt")"
  (cd "${WORK}/workspace" &&
    CMAKE_PREFIX_PATH="${CARTOGRAPHER_ROS_PREFIX}:${WORK}/prefix:${cartographer%/share/cartographer}:/usr" \
      catkin_make_isolated --use-ninja --install --cmake-args \
      -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_BUILD_TYPE=Release)
}

if ! check_workspace; then
  echo "test_ros.sh: a workspace does not have the three packages" >&2
  exit 1
fi
echo "ok   a workspace of ROS 1 or ROS 2 has the three packages"
if ! build >"${WORK}/build.log" 2>&1; then
  cat "${WORK}/build.log" >&2
  echo "test_ros.sh: the packages in ros/ do not build" >&2
  exit 1
fi
echo "ok   the packages in ros/ build beside cartographer_ros"

# Programs of ROS listen on all addresses, so they get a network of their own.
drive() {
  unshare "$1" bash -euc '
    ip link set lo up
    export ROS_MASTER_URI=http://127.0.0.1:11311 ROS_IP=127.0.0.1
    export ROS_HOME="$1/ros" ROS_LOG_DIR="$1/ros/log"
    set +u
    source "$1/workspace/install_isolated/setup.bash"
    exec /usr/bin/python3 "$2/scripts/ros_drive_test.py" "$3" "$4/cartographer_sdf" "$1"
  ' drive "${WORK}" "${SOURCE_DIR}" "${LOG}" "${BUILD_DIR}"
}

namespace=-n
((EUID == 0)) || namespace=-rn
if ! drive "${namespace}"; then
  tail -n 30 "${WORK}"/*.log >&2 || true
  echo "test_ros.sh: failed" >&2
  exit 1
fi
