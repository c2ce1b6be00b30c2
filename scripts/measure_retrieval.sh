#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures what match --retrieval finds of what match finds, on the real maps,
# and writes the transcript that docs/results/retrieval.md sums up to
# docs/results/runs/retrieval.md, or to OUTPUT. The maps are no part of the
# project; see CONTRIBUTING.md.
#
# usage: [OUTPUT=FILE] measure_retrieval.sh [DIRECTORY OF THE MAPS, default ../shared/data]

set -euo pipefail

[[ -x /usr/bin/time ]] || { echo "install the Debian package time" >&2; exit 1; }

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD_DIR="${BUILD_DIR:-${SOURCE_DIR}/build}"
DATA_DIR="${1:-${SOURCE_DIR}/../shared/data}"
PROGRAM="${BUILD_DIR}/cartographer_sdf"
REPORT="${OUTPUT:-${SOURCE_DIR}/docs/results/runs/retrieval.md}"
WORK_DIR="$(mktemp -d)"
trap 'rm -rf "${WORK_DIR}"' EXIT

[[ -d "${DATA_DIR}" ]] || { echo "no maps at ${DATA_DIR}" >&2; exit 1; }
[[ -x "${PROGRAM}" ]] || { echo "build first: ${PROGRAM} is missing" >&2; exit 1; }
mkdir -p "$(dirname "${REPORT}")"

# Exactly the best so many candidates of each submap.
for count in 5 10 20; do
  cat > "${WORK_DIR}/top_${count}.lua" <<LUA
include "sdf_global_constraints.lua"
SDF_GLOBAL_CONSTRAINTS.loop_closing.retrieval.min_num_candidates = ${count}
SDF_GLOBAL_CONSTRAINTS.loop_closing.retrieval.max_num_candidates = ${count}
return SDF_GLOBAL_CONSTRAINTS
LUA
done

# Prints what a run of match with these arguments finds, and its score.
measure() {
  local title="$1" truth="$2"
  shift 2
  echo
  echo "${title}:"
  echo '```'
  /usr/bin/time -f '%U s of CPU' "${PROGRAM}" match --threads 1 "$@" \
    --output "${WORK_DIR}/matches.csv" 2>&1 | sed -e "s#: ${WORK_DIR}.*##"
  "${PROGRAM}" evaluate --input "$2" --truth "${truth}" \
    --matches "${WORK_DIR}/matches.csv"
  echo '```'
}

{
  echo "# match with and without retrieval"
  echo
  echo "Made by \`scripts/measure_retrieval.sh\` on $(date +%Y-%m-%d), commit" \
    "$(git -C "${SOURCE_DIR}" rev-parse --short HEAD)," \
    "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores;" \
    "options as shipped."
  for name in intel aces mit_killian willow_1 willow_2; do
    map="${DATA_DIR}/${name}.pbstream"
    [[ -f "${map}" ]] || map="${DATA_DIR}/${name}_open_loop.pbstream"
    truth="${DATA_DIR}/${name}.truth.csv"
    echo
    echo "## ${name}"
    measure "every pair" "${truth}" --input "${map}"
    measure "retrieval" "${truth}" --input "${map}" --retrieval
    for count in 5 10 20; do
      measure "the best ${count} of each submap" "${truth}" --input "${map}" \
        --retrieval --configuration_directory "${WORK_DIR}" \
        --configuration_basename "top_${count}.lua"
    done
  done
} > "${REPORT}.tmp"
mv "${REPORT}.tmp" "${REPORT}"
echo "${REPORT}"
