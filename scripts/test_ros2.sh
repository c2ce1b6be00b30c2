#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Builds the packages in ros/ with colcon in a sourced workspace of ROS 2 that has
# cartographer_ros, starts the node, and lets it save its map. With a recording,
# maps it, localises in the map, and finds a robot again that was carried away.
# Does nothing where one of these is absent, and says so.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/test_ros2.sh
environment:
  BUILD_DIR     the build directory of this project, which must be built; build/
                of the checkout by default
  ROS_TEST_LOG  the recording to drive; willow_1.log.gz of the data that are not
                part of the project by default, nothing where it is absent
and that of ROS 2 (source .../setup.bash)
END
}

case "${1:-}" in
  "") ;;
  -h | --help) usage && exit 0 ;;
  *) usage >&2 && exit 2 ;;
esac

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build}"
LOG="${ROS_TEST_LOG:-${SOURCE_DIR}/../shared/data/willow_1.log.gz}"
START_SECONDS=60
MIN_INTER_CONSTRAINTS=50

skip() {
  echo "test_ros2.sh: skipped: $*"
  exit 0
}

fail() {
  cat "${WORK}"/*.log >&2 || true
  echo "test_ros2.sh: $*" >&2
  exit 1
}

# Whether a package is in a prefix of the environment.
has_package() {
  local prefix
  while read -r prefix; do
    [[ -e "${prefix}/share/ament_index/resource_index/packages/$1" ]] && return 0
  done < <(tr ':' '\n' <<<"${AMENT_PREFIX_PATH:-}")
  return 1
}

[[ "${ROS_VERSION:-}" == 2 ]] || skip "no workspace of ROS 2 is sourced"
command -v colcon >/dev/null || skip "there is no colcon"
for package in rclcpp tf2_ros cartographer_ros rosidl_default_generators; do
  has_package "${package}" || skip "${package} is in no sourced workspace"
done
[[ -f "${BUILD_DIR}/libcartographer_sdf_live.a" ]] || skip "live/ is not built in ${BUILD_DIR}"

WORK="$(mktemp -d)"
trap 'rm -rf "${WORK}"' EXIT

build() {
  cmake --install "${BUILD_DIR}" --prefix "${WORK}/prefix" >/dev/null
  mkdir -p "${WORK}/workspace/src"
  ln -s "${SOURCE_DIR}/ros" "${WORK}/workspace/src/ros"
  ln -s "${SOURCE_DIR}/test/ros2" "${WORK}/workspace/src/test"
  local cartographer
  cartographer="$(sed -n 's/^cartographer_DIR:PATH=//p' "${BUILD_DIR}/CMakeCache.txt")"
  (cd "${WORK}/workspace" &&
    CMAKE_PREFIX_PATH="${WORK}/prefix:${cartographer%/share/cartographer}:${CMAKE_PREFIX_PATH:-}" \
      colcon build --executor sequential --cmake-args \
      -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE=/usr/bin/python3)
}

build >"${WORK}/build.log" 2>&1 || fail "the packages in ros/ do not build"
echo "ok   the packages in ros/ build with colcon beside cartographer_ros"

PREFIX="${WORK}/workspace/install/cartographer_sdf_ros"
for file in lib/cartographer_sdf_ros/cartographer_sdf_node \
  share/ament_index/resource_index/packages/cartographer_sdf_ros \
  share/cartographer_sdf_ros/{package.xml,launch/mapping.launch.py,launch/localization.launch.py} \
  share/cartographer_sdf_ros/configuration_files/{robot_mapping.lua,sdf_live.lua,cartographer_mapping.lua}; do
  [[ -e "${PREFIX}/${file}" ]] || fail "${file} is not installed"
done
echo "ok   programs, launch files and configuration are where ROS 2 looks for them"

# Waits for a line of the node's log.
wait_for() {
  local k
  for ((k = 0; k < 10 * START_SECONDS; ++k)); do
    grep -q "$1" "${WORK}/node.log" && return 0
    kill -0 "${NODE}" 2>/dev/null || return 1
    sleep 0.1
  done
  return 1
}

# Others in the network see nothing of it.
export ROS_LOCALHOST_ONLY=1
set +u
# shellcheck disable=SC1091
source "${WORK}/workspace/install/local_setup.bash"
set -u

start_node() {
  "${PREFIX}/lib/cartographer_sdf_ros/cartographer_sdf_node" \
    -configuration_directory "${PREFIX}/share/cartographer_sdf_ros/configuration_files" \
    -configuration_basename "$@" >"${WORK}/node.log" 2>&1 &
  NODE=$!
  wait_for "Added trajectory with ID" || fail "the node starts no trajectory"
}

end_node() {
  kill -INT "${NODE}"
  wait "${NODE}" || fail "the node ends with an error"
}

drive() {
  "${WORK}/workspace/install/cartographer_sdf_drive_test/lib/cartographer_sdf_drive_test/drive_test" "$1" "${LOG}" ||
    { kill -INT "${NODE}" && fail "the drive failed"; }
}

MAP="${WORK}/map.pbstream"
start_node robot_mapping.lua -save_state_filename "${MAP}"
echo "ok   the node starts a trajectory"
end_node
[[ -s "${MAP}" ]] || fail "the node saves no map"
echo "ok   it saves its map as it ends"
if [[ ! -f "${LOG}" ]]; then
  echo "     no robot drives: there is no recording ${LOG}"
  exit 0
fi

start_node robot_mapping_searcher_only.lua -collect_metrics -save_state_filename "${MAP}" \
  --ros-args -p use_sim_time:=true
drive map
end_node
constraints="$("${BUILD_DIR}/cartographer_sdf" info --input "${MAP}" |
  sed -n 's/.* \([0-9]*\) inter-submap.*/\1/p')"
((constraints >= MIN_INTER_CONSTRAINTS)) || fail "${constraints} inter-submap constraints in the map"
echo "ok   ${constraints} inter-submap constraints in the map"
start_node robot_localization.lua -load_state_filename "${MAP}" --ros-args -p use_sim_time:=true
drive localize
end_node
echo "ok   the node ends as it should"
