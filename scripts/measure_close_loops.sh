#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures close_loops and match on the real maps, and writes the transcript that
# docs/results/close_loops.md sums up to docs/results/runs/close_loops.md, or to
# OUTPUT. The maps are no part of the project; see CONTRIBUTING.md.
#
# usage: [OUTPUT=FILE] measure_close_loops.sh [DIRECTORY OF THE MAPS, default ../shared/data]

source "$(dirname "${BASH_SOURCE[0]}")/transcript.sh" "$@"

# Prints a command as a reader would type it, and what it says.
show() {
  echo
  echo '```'
  echo "\$ cartographer_sdf $*" | sed -e "s#${DATA_DIR}/##g" -e "s#${WORK_DIR}/##g"
  /usr/bin/time -f 'whole process: %e s, %U s of CPU, %M kB at most' \
    "${PROGRAM}" "$@" 2>&1 | sed -e "s#${WORK_DIR}/##g"
  echo '```'
}

measure() {
  local name map relations method pair
  for name in intel aces mit_killian; do
    map="${DATA_DIR}/${name}_open_loop.pbstream"
    relations=()
    [[ -f "${DATA_DIR}/${name}.relations" ]] && relations=(--relations "${DATA_DIR}/${name}.relations")
    echo
    echo "## ${name}"
    show evaluate --input "${map}" --truth "${DATA_DIR}/${name}.truth.csv" "${relations[@]}"
    show close_loops --threads 1 --input "${map}" --output "${WORK_DIR}/closed.pbstream" \
      --closures "${WORK_DIR}/closures.csv"
    show evaluate --input "${WORK_DIR}/closed.pbstream" \
      --truth "${DATA_DIR}/${name}.truth.csv" "${relations[@]}"
    show evaluate --input "${map}" --truth "${DATA_DIR}/${name}.truth.csv" \
      --matches "${WORK_DIR}/closures.csv"
    if [[ -f "${DATA_DIR}/${name}_stock.pbstream" ]]; then
      echo
      echo "Stock Cartographer with its own loop closing:"
      show evaluate --input "${DATA_DIR}/${name}_stock.pbstream" \
        --truth "${DATA_DIR}/${name}.truth.csv" "${relations[@]}"
    fi
  done
  echo
  echo "## All pairs, without injection"
  for name in intel aces mit_killian willow_1 willow_2; do
    map="$(map_of "${name}")"
    for method in sdf paper; do
      echo
      echo "${name}, ${method}:"
      show match --input "${map}" --method "${method}" --all_pairs --output "${WORK_DIR}/matches.csv"
      show evaluate --input "${map}" --truth "${DATA_DIR}/${name}.truth.csv" \
        --matches "${WORK_DIR}/matches.csv"
    done
  done
  echo
  echo "## Different buildings: every accepted match is wrong"
  for pair in intel_open_loop:aces_open_loop willow_1:intel_open_loop aces_open_loop:willow_2 \
    mit_killian_open_loop:willow_1 mit_killian_open_loop:intel_open_loop \
    mit_killian_open_loop:aces_open_loop; do
    show match --input "${DATA_DIR}/${pair%%:*}.pbstream" \
      --query "${DATA_DIR}/${pair##*:}.pbstream" --output "${WORK_DIR}/matches.csv"
  done
  echo
  echo "## Maps that users saved"
  for name in user_map_arena user_map_odometry user_map_two_sessions; do
    show close_loops --input "${DATA_DIR}/${name}.pbstream" --output "${WORK_DIR}/closed.pbstream"
  done
}
write_transcript close_loops "close_loops and match on real maps" measure
