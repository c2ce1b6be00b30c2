#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Builds everything with warnings as errors and runs all tests. Installs what
# is missing first.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/run_tests.sh [--sanitize | --benchmark]
  --sanitize   builds the libraries with the address and undefined behaviour
               sanitizers and with assertions, in a directory of its own, and
               runs the tests of what reads bytes from outside or computes on
               them, without the real maps, and the fuzzers for some seconds
  --benchmark  builds and runs the benchmarks after the tests
environment:
  BUILD_DIR    the build directory; build/ of the checkout by default,
               build-sanitize/ with --sanitize
END
}

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
JOBS="$(nproc)"
sanitize=false
benchmark=false
for argument in "$@"; do
  case "${argument}" in
    --sanitize) sanitize=true ;;
    --benchmark) benchmark=true ;;
    -h | --help) usage && exit 0 ;;
    *) usage >&2 && exit 2 ;;
  esac
done
if "${sanitize}" && "${benchmark}"; then
  echo "run_tests.sh: a benchmark under sanitizers says nothing." >&2
  exit 2
fi

options=(-DCARTOGRAPHER_SDF_UNITY_BUILD=ON)
dependencies=()
if "${sanitize}"; then
  BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build-sanitize}"
  # No -Werror: the sanitizers make the compiler see ghosts in Eigen. The real
  # maps are left out for time; the plain run has them.
  options+=(
    -DCMAKE_BUILD_TYPE=RelWithDebInfo
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1"
    "-DCARTOGRAPHER_SDF_SANITIZE=address,undefined"
    -DCARTOGRAPHER_SDF_BUILD_FUZZERS=ON
    -DCARTOGRAPHER_SDF_TEST_DATA_DIRECTORY=none
  )
  # A minute of all that other tests do in a second.
  export GTEST_FILTER="${GTEST_FILTER:--*OptionEffectsTest.*}"
  export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_stack_use_after_return=1}"
  export UBSAN_OPTIONS="${UBSAN_OPTIONS:-halt_on_error=1:print_stacktrace=1}"
else
  BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build}"
  options+=(-DCARTOGRAPHER_SDF_WARNINGS_AS_ERRORS=ON -DCARTOGRAPHER_SDF_BUILD_PYTHON=ON)
  dependencies+=(--python)
fi
"${benchmark}" && options+=(-DCARTOGRAPHER_SDF_BUILD_BENCHMARKS=ON)
# Each test is a program of its own, so links add up.
for linker in lld gold; do
  if [[ -z "${LDFLAGS:-}" ]] && command -v "ld.${linker}" >/dev/null; then
    options+=("-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=${linker}")
    break
  fi
done
# An existing directory keeps the generator it was made with.
[[ -f "${BUILD_DIR}/CMakeCache.txt" ]] || options+=(-G Ninja)

"${SOURCE_DIR}/scripts/install_dependencies.sh" "${dependencies[@]}"
cmake -S "${SOURCE_DIR}" -B "${BUILD_DIR}" -DCARTOGRAPHER_SDF_BUILD_TESTS=ON "${options[@]}"
cmake --build "${BUILD_DIR}" --parallel "${JOBS}"

# Says which tests skipped themselves: ctest counts those as passed.
report_skipped_tests() {
  # GoogleTest prints "FILE:LINE: Skipped", the reason, "[  SKIPPED ] NAME (N ms)".
  awk '
    / Skipped$/ { in_reason = 1; reason = ""; next }
    /^\[  SKIPPED \] .* \([0-9]+ ms\)$/ {
      if (reason ~ /needs the real map/) absent[++num_absent] = $4
      else other[++num_other] = $4
      in_reason = 0
      next
    }
    in_reason { reason = reason $0 }
    function tests(n) { return n (n == 1 ? " test" : " tests") }
    END {
      if (num_absent) print tests(num_absent) " skipped: real maps absent"
      for (i = 1; i <= num_absent; ++i) print "  " absent[i]
      if (num_other) print tests(num_other) " skipped for other reasons"
      for (i = 1; i <= num_other; ++i) print "  " other[i]
    }' "${BUILD_DIR}/Testing/Temporary/LastTest.log"
}

# Passes the output on, but holds the summary back to put the skipped tests
# before it.
insert_skipped_tests() {
  local line summary=()
  while IFS= read -r line; do
    if ((${#summary[@]} > 0)) || [[ "${line}" == *"% tests passed"* ]]; then
      summary+=("${line}")
    else
      printf '%s\n' "${line}"
    fi
  done
  report_skipped_tests
  ((${#summary[@]} == 0)) || printf '%s\n' "${summary[@]}"
}

ctest --test-dir "${BUILD_DIR}" --output-on-failure --no-tests=error \
  --parallel "${JOBS}" </dev/null | insert_skipped_tests

if "${benchmark}"; then
  for program in "${BUILD_DIR}"/test/benchmark/*_benchmark; do
    echo
    echo "=== ${program##*/}"
    "${program}"
  done
fi
