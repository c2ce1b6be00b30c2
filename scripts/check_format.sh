#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Checks that all C++ is formatted as clang-format 14 does; --fix formats it.

set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  "") mode=(--dry-run --Werror) ;;
  --fix) mode=(-i) ;;
  *) echo "usage: scripts/check_format.sh [--fix]" >&2 && exit 2 ;;
esac

# Other versions format differently.
for program in clang-format-14 clang-format none; do
  [[ "$("${program}" --version 2>/dev/null)" == *"version 14."* ]] && break
done
if [[ "${program}" == none ]]; then
  echo "check_format.sh: needs clang-format 14" \
    "(scripts/install_dependencies.sh --development)" >&2
  exit 1
fi

mapfile -t files < <(find cartographer_sdf python ros test -name '*.h' -o -name '*.cc' | sort)
"${program}" "${mode[@]}" --style=file "${files[@]}"
echo "Format: ${#files[@]} files are right."
