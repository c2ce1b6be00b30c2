#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs the paper's evaluation on maps with truth: docs/results/evaluation.md, and
# tables, plots and pictures in docs/results/evaluation/.
#
# usage: run_evaluation.sh [--help] [NAME=MAP.pbstream,TRUTH.csv[,RELATIONS] ...]

set -euo pipefail

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
command -v python3 > /dev/null || { echo "install the Debian package python3" >&2; exit 1; }
exec python3 "${SOURCE_DIR}/scripts/evaluation_report.py" "$@"
