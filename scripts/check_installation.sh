#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Installs a finished build into a temporary place and uses it from there as
# another project would: headers, libraries and find_package().

set -euo pipefail

if (($# != 1)) || [[ ! -f "$1/CMakeCache.txt" ]]; then
  echo "usage: scripts/check_installation.sh BUILD_DIR" >&2
  exit 2
fi

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
PREFIX="$(mktemp -d)"
trap 'rm -rf "${PREFIX}"' EXIT

cmake --install "$1" --prefix "${PREFIX}"
cmake -S "${SOURCE_DIR}/test/installation" -B "${PREFIX}/consumer" -G Ninja \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="${PREFIX}" \
  -DCARTOGRAPHER_SDF_INCLUDE_DIRECTORY="${PREFIX}/include"
cmake --build "${PREFIX}/consumer"
"${PREFIX}/consumer/consumer"

# `cartographer_sdf` alone is wrong usage, which it has to say by itself.
status=0
"${PREFIX}/bin/cartographer_sdf" </dev/null >/dev/null 2>&1 || status=$?
if ((status != 2)); then
  echo "check_installation.sh: the installed program exits with ${status}, not 2" >&2
  exit 1
fi
