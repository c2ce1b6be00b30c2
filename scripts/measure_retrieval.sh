#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures what match finds of what match --all_pairs finds, on the real maps,
# and writes the transcript that docs/results/retrieval.md sums up to
# docs/results/runs/retrieval.md, or to OUTPUT. The maps are no part of the
# project; see CONTRIBUTING.md.
#
# usage: [OUTPUT=FILE] measure_retrieval.sh [DIRECTORY OF THE MAPS, default ../shared/data]

source "$(dirname "${BASH_SOURCE[0]}")/transcript.sh" "$@"

# Exactly the best so many candidates of each submap.
for count in 5 10 20; do
  cat > "${WORK_DIR}/top_${count}.lua" <<LUA
include "sdf_global_constraints.lua"
SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.retrieval.min_num_candidates = ${count}
SDF_GLOBAL_CONSTRAINTS.loop_closing.recognition.retrieval.max_num_candidates = ${count}
return SDF_GLOBAL_CONSTRAINTS
LUA
done

# Prints what a run of match with these arguments finds, and its score.
show() {
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

measure() {
  local name map truth count
  for name in intel aces mit_killian willow_1 willow_2 fr079; do
    map="$(map_of "${name}")"
    truth="${DATA_DIR}/${name}.truth.csv"
    echo
    echo "## ${name}"
    show "every pair" "${truth}" --input "${map}" --all_pairs
    show "as shipped" "${truth}" --input "${map}"
    for count in 5 10 20; do
      show "the best ${count} of each submap" "${truth}" --input "${map}" \
        --configuration_directory "${WORK_DIR}" \
        --configuration_basename "top_${count}.lua"
    done
  done
}
write_transcript retrieval "match with retrieval and of every pair" measure
