#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# What compilers and analysers say without running anything: clang and its
# warnings as errors, clang-tidy with .clang-tidy, and cppcheck with
# .cppcheck. Takes an hour of CPU time or more for the whole tree, so that CI
# does not run it; before a release, and with --since for a change.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/check_static.sh [--since COMMIT] [--only clang,tidy,cppcheck]
  --since COMMIT  looks only at files that have changed since then
  --only LIST     only these checks
environment:
  BUILD_DIR  the build directory, build-static/ of the checkout by default
  JOBS       how many processes, as many as cores by default
END
}

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build-static}"
JOBS="${JOBS:-$(nproc)}"
since=""
only=clang,tidy,cppcheck
while (($# > 0)); do
  case "$1" in
    --since) since="${2:?--since needs a commit}" && shift ;;
    --only) only="${2:?--only needs a list}" && shift ;;
    -h | --help) usage && exit 0 ;;
    *) usage >&2 && exit 2 ;;
  esac
  shift
done
cd "${SOURCE_DIR}"

wants() { [[ ",${only}," == *",$1,"* ]]; }
step() { printf '\n=== %s\n' "$*"; }

for check in clang:clang++ tidy:clang-tidy cppcheck:cppcheck; do
  if wants "${check%%:*}" && ! command -v "${check##*:}" >/dev/null; then
    echo "check_static.sh: needs ${check##*:}, of Debian's packages clang, clang-tidy and cppcheck" >&2
    exit 1
  fi
done

# Sources that are checked; headers by the sources that include them.
if [[ -n "${since}" ]]; then
  mapfile -t files < <(git diff --name-only --diff-filter=d "${since}" -- '*.cc')
else
  mapfile -t files < <(git ls-files -- 'cartographer_sdf/*.cc' 'test/*.cc' 'python/*.cc')
fi
if ((${#files[@]} == 0)); then
  echo "check_static.sh: no source has changed since ${since}"
  exit 0
fi
echo "${#files[@]} sources"

# All of them are compiled several at once: most of the time goes into the
# headers of others.
unity=ON
[[ -z "${since}" ]] || unity=OFF
options=()
[[ -f "${BUILD_DIR}/CMakeCache.txt" ]] || options+=(-G Ninja)
cmake -S . -B "${BUILD_DIR}" "${options[@]}" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release \
  -DCARTOGRAPHER_SDF_WARNINGS_AS_ERRORS=ON -DCARTOGRAPHER_SDF_UNITY_BUILD="${unity}" \
  -DCARTOGRAPHER_SDF_BUILD_TESTS=ON -DCARTOGRAPHER_SDF_BUILD_BENCHMARKS=ON -DCARTOGRAPHER_SDF_BUILD_FUZZERS=ON \
  -DCARTOGRAPHER_SDF_BUILD_PYTHON=ON >/dev/null
ninja -C "${BUILD_DIR}" -j "${JOBS}" cartographer_sdf_proto generated/inspector_template.cc >/dev/null
# With the sources joined, as the analyser is blind to those that a file includes.
JOINED_DIR="${BUILD_DIR}/joined"
rm -rf "${JOINED_DIR}"
scripts/join_sources.py "${BUILD_DIR}" "${JOINED_DIR}"

# What is compiled of the files: with "file", the file, else the command that
# looks at it without making an object, each ended by a zero byte.
compiled() {
  python3 - "${JOINED_DIR}/compile_commands.json" "${SOURCE_DIR}" "$1" "${files[@]}" <<'END'
import json, os, sys
commands, source, what, files = sys.argv[1], sys.argv[2], sys.argv[3], set(sys.argv[4:])
joined, seen = os.path.dirname(os.path.abspath(commands)), set()
for entry in json.load(open(commands)):
    file = entry["file"]
    if os.path.dirname(file) != joined and os.path.relpath(file, source) not in files or file in seen:
        continue
    seen.add(file)
    print(file if what == "file" else f"cd '{entry['directory']}' && {entry['command']} -fsyntax-only", end="\0")
END
}
# The findings of a log, once each, with places in the sources.
findings() {
  grep -E ': (warning|error):' "$1" | scripts/join_sources.py --name "${JOINED_DIR}" | sort -u
}

failed=()
if wants clang; then
  step "clang: -Wall -Wextra -Wconversion -Werror"
  compiled command | xargs -0 -n 1 -P "${JOBS}" bash -c >"${BUILD_DIR}/clang.log" 2>&1 || failed+=(clang)
  findings "${BUILD_DIR}/clang.log" || true
fi
if wants tidy; then
  step "clang-tidy"
  # A source may declare what is defined before it in the joined file.
  compiled file |
    xargs -0 -n 1 -P "${JOBS}" clang-tidy -p "${JOINED_DIR}" --config-file=.clang-tidy --quiet \
      --warnings-as-errors='*' --checks=-readability-redundant-declaration \
      --header-filter="${SOURCE_DIR}/(cartographer_sdf|test|python)/" \
      >"${BUILD_DIR}/tidy.log" 2>"${BUILD_DIR}/tidy_errors.log" || failed+=(clang-tidy)
  findings "${BUILD_DIR}/tidy.log" || true
fi
if wants cppcheck; then
  step "cppcheck"
  cppcheck --quiet -j "${JOBS}" --std=c++17 --language=c++ --library=googletest --enable=warning,performance,portability \
    --inline-suppr --suppressions-list=.cppcheck -I . --error-exitcode=1 "${files[@]}" || failed+=(cppcheck)
fi

echo
if ((${#failed[@]} > 0)); then
  echo "check_static.sh: findings of ${failed[*]}" >&2
  exit 1
fi
echo "check_static.sh: no findings"
