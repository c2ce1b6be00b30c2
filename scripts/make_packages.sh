#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Makes the Debian packages: the program, the libraries with headers, the Python
# module and, where Cartographer is installed, what runs beside it.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/make_packages.sh [OUTPUT_DIR]
  OUTPUT_DIR  where the .deb files go, packages/ of the checkout by default
environment:
  BUILD_DIR      the build directory, build-packages/ of the checkout by default
  CMAKE_OPTIONS  more options for CMake, separated by spaces
END
}

case "${1:-}" in
  -h | --help) usage && exit 0 ;;
  -*) usage >&2 && exit 2 ;;
esac
(($# <= 1)) || { usage >&2 && exit 2; }

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build-packages}"
OUTPUT_DIR="${1:-${SOURCE_DIR}/packages}"
read -r -a more_options <<<"${CMAKE_OPTIONS:-}"

"${SOURCE_DIR}/scripts/install_dependencies.sh" --packages
options=()
[[ -f "${BUILD_DIR}/CMakeCache.txt" ]] || options+=(-G Ninja)
cmake -S "${SOURCE_DIR}" -B "${BUILD_DIR}" "${options[@]}" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr \
  -DCARTOGRAPHER_SDF_BUILD_TESTS=OFF -DCARTOGRAPHER_SDF_BUILD_PYTHON=ON \
  -DCARTOGRAPHER_SDF_PACKAGING=ON -DCARTOGRAPHER_SDF_UNITY_BUILD=ON "${more_options[@]}"
cmake --build "${BUILD_DIR}" --parallel "$(nproc)"

# Of this build alone.
mkdir -p "${OUTPUT_DIR}"
OUTPUT_DIR="$(cd "${OUTPUT_DIR}" && pwd)"
rm -f "${OUTPUT_DIR}"/*cartographer-sdf*.deb
rm -rf "${BUILD_DIR}/_CPack_Packages"
(cd "${BUILD_DIR}" && cpack -G DEB -B "${OUTPUT_DIR}")
rm -rf "${OUTPUT_DIR}/_CPack_Packages"

echo
for package in "${OUTPUT_DIR}"/*cartographer-sdf*.deb; do
  dpkg-deb --show --showformat='${Package} ${Version}, ${Installed-Size} kB\n' "${package}"
done
