# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
#
# To be sourced by scripts that measure the program on the real maps and write a
# transcript to docs/results/runs/, with "$@": their argument is the directory of
# the maps. Sets PROGRAM, DATA_DIR and WORK_DIR, which is removed in the end.

set -euo pipefail

[[ -x /usr/bin/time ]] || { echo "install the Debian package time" >&2; exit 1; }

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
DATA_DIR="${1:-${SOURCE_DIR}/../shared/data}"
PROGRAM="${BUILD_DIR:-${SOURCE_DIR}/build}/cartographer_sdf"
WORK_DIR="$(mktemp -d)"
trap 'rm -rf "${WORK_DIR}"' EXIT

[[ -d "${DATA_DIR}" ]] || { echo "no maps at ${DATA_DIR}" >&2; exit 1; }
[[ -x "${PROGRAM}" ]] || { echo "build first: ${PROGRAM} is missing" >&2; exit 1; }

# write_transcript NAME TITLE COMMAND: what the command prints, below the title
# and a line that says how it was made, to docs/results/runs/NAME.md or OUTPUT.
# The file appears when it is whole.
write_transcript() {
  local file="${OUTPUT:-${SOURCE_DIR}/docs/results/runs/$1.md}"
  mkdir -p "$(dirname "${file}")"
  {
    echo "# $2"
    echo
    echo "Made by \`scripts/measure_$1.sh\` on $(date +%Y-%m-%d), commit" \
      "$(git -C "${SOURCE_DIR}" rev-parse --short HEAD)," \
      "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores;" \
      "options as shipped."
    "$3"
  } > "${file}.tmp"
  mv "${file}.tmp" "${file}"
  echo "${file}"
}

# The map of that name, with its own loops open where there are two.
map_of() {
  local map="${DATA_DIR}/$1.pbstream"
  [[ -f "${map}" ]] || map="${DATA_DIR}/$1_open_loop.pbstream"
  echo "${map}"
}
