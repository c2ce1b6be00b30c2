#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# What compilers and analysers say without running anything: clang and its
# warnings as errors, clang-tidy with .clang-tidy, and cppcheck with
# .cppcheck. Takes half an hour for the whole tree, so that CI does not run
# it; before a release, and with --since for a change.

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
  "-DCMAKE_CXX_FLAGS_RELEASE=-O1" -DCARTOGRAPHER_SDF_WARNINGS_AS_ERRORS=ON -DCARTOGRAPHER_SDF_UNITY_BUILD="${unity}" \
  -DCARTOGRAPHER_SDF_BUILD_TESTS=ON -DCARTOGRAPHER_SDF_BUILD_PYTHON=ON >/dev/null
cmake --build "${BUILD_DIR}" --target cartographer_sdf_proto --parallel "${JOBS}" >/dev/null

# What is compiled of the files, and its objects, a line each.
compiled() {
  python3 - "${BUILD_DIR}/compile_commands.json" "${SOURCE_DIR}" "${unity}" "${files[@]}" <<'END'
import json, os, sys
commands, source, unity, files = sys.argv[1], sys.argv[2], sys.argv[3], set(sys.argv[4:])
for entry in json.load(open(commands)):
    file = entry["file"]
    if os.path.relpath(file, source) in files or (unity == "ON" and "/Unity/" in file):
        words = entry["command"].split()
        print(file, words[words.index("-o") + 1])
END
}

failed=()
if wants clang; then
  step "clang: -Wall -Wextra -Wconversion -Werror"
  # The objects alone; nothing is linked or run.
  mapfile -t objects < <(compiled | cut -d ' ' -f 2)
  ninja -C "${BUILD_DIR}" -j "${JOBS}" -k 0 "${objects[@]}" >"${BUILD_DIR}/clang.log" 2>&1 || failed+=(clang)
  grep -E ': (warning|error):' "${BUILD_DIR}/clang.log" | sort -u || true
fi
if wants tidy; then
  step "clang-tidy"
  # Sources that a file of several includes count as headers, and may declare
  # what is defined before them.
  compiled | cut -d ' ' -f 1 |
    xargs -n 1 -P "${JOBS}" clang-tidy -p "${BUILD_DIR}" --config-file=.clang-tidy --quiet \
      --warnings-as-errors='*' --checks=-bugprone-suspicious-include,-readability-redundant-declaration \
      --header-filter="${SOURCE_DIR}/(cartographer_sdf|test|python)/" \
      >"${BUILD_DIR}/tidy.log" 2>/dev/null || failed+=(clang-tidy)
  grep -E ': (warning|error):' "${BUILD_DIR}/tidy.log" | sort -u || true
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
