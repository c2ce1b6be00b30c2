#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# From a bare machine to a closed loop: installs what is missing, builds the
# program, lets a simulated robot drift, closes the loops and compares both
# maps with the truth. Given a map, closes the loops of that instead.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/demo.sh [MAP.pbstream]
environment:
  BUILD_DIR  the build directory, build/ of the checkout by default
  DEMO_DIR   where the results go, demo/ of the checkout by default
END
}

case "${1:-}" in
  -h | --help) usage && exit 0 ;;
  -*) usage >&2 && exit 2 ;;
esac
(($# <= 1)) || { usage >&2 && exit 2; }

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build}"
DEMO_DIR="${DEMO_DIR:-${SOURCE_DIR}/demo}"
MAP="${1:-}"
if [[ -n "${MAP}" && ! -r "${MAP}" ]]; then
  echo "demo.sh: cannot read ${MAP}" >&2
  exit 1
fi

"${SOURCE_DIR}/scripts/install_dependencies.sh"
options=()
[[ -f "${BUILD_DIR}/CMakeCache.txt" ]] || options+=(-G Ninja -DCMAKE_BUILD_TYPE=Release)
cmake -S "${SOURCE_DIR}" -B "${BUILD_DIR}" "${options[@]}"
cmake --build "${BUILD_DIR}" --parallel "$(nproc)" --target cartographer_sdf

# Prints a command of the program as it can be typed again, and runs it.
run() {
  echo
  echo "\$ cartographer_sdf $*"
  "${BUILD_DIR}/cartographer_sdf" "$@"
}

mkdir -p "${DEMO_DIR}"
if [[ -z "${MAP}" ]]; then
  MAP="${DEMO_DIR}/open_loop.pbstream"
  run simulate --output "${MAP}" --truth "${DEMO_DIR}/truth.csv"
  has_truth=true
else
  has_truth=false
fi
run close_loops --input "${MAP}" --output "${DEMO_DIR}/closed.pbstream" \
  --closures "${DEMO_DIR}/closures.csv" --report "${DEMO_DIR}/report"
if "${has_truth}"; then
  run evaluate --input "${MAP}" --truth "${DEMO_DIR}/truth.csv"
  run evaluate --input "${DEMO_DIR}/closed.pbstream" --truth "${DEMO_DIR}/truth.csv"
fi

cat <<END

The map before and after, with every closure:  ${DEMO_DIR}/report/index.html
The accepted closures:                         ${DEMO_DIR}/closures.csv
The corrected map, for Cartographer:           ${DEMO_DIR}/closed.pbstream
END
