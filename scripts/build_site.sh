#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Builds the site of the documentation from docs/, the program and the sources:
# pages that need no network to be read. Checks all of their links.

set -euo pipefail

usage() {
  cat <<END_OF_USAGE
usage: scripts/build_site.sh [OUTPUT]
  OUTPUT  where the pages go, site/ of the checkout by default; what is there is
          replaced
environment:
  BUILD_DIR  has the program cartographer_sdf; build/ of the checkout by default
Exits with 77 where Sphinx, its theme or Doxygen is absent:
scripts/install_dependencies.sh --documentation installs them.
END_OF_USAGE
}

case "${1:-}" in
  -h | --help) usage && exit 0 ;;
  -*) usage >&2 && exit 2 ;;
esac
(($# <= 1)) || { usage >&2 && exit 2; }

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
PROGRAM="${BUILD_DIR:-${SOURCE_DIR}/build}/cartographer_sdf"
OUTPUT="${1:-${SOURCE_DIR}/site}"

# Debian's modules are for Debian's Python, which need not be the first one.
PYTHON=/usr/bin/python3
[[ -x "${PYTHON}" ]] || PYTHON=python3
for module in sphinx myst_parser furo sphinx_copybutton; do
  if ! "${PYTHON}" -c "import ${module}" 2>/dev/null; then
    echo "skipped: needs ${module} (scripts/install_dependencies.sh --documentation)"
    exit 77
  fi
done
if ! command -v doxygen >/dev/null; then
  echo "skipped: needs doxygen (scripts/install_dependencies.sh --documentation)"
  exit 77
fi
if [[ ! -x "${PROGRAM}" ]]; then
  echo "build_site.sh: build first: ${PROGRAM} is missing" >&2
  exit 1
fi

WORK_DIR="$(mktemp -d)"
trap 'rm -rf "${WORK_DIR}"' EXIT
export PYTHONDONTWRITEBYTECODE=1
stage() {
  "${PYTHON}" "${SOURCE_DIR}/scripts/site/stage.py" "${SOURCE_DIR}" "${PROGRAM}" "${WORK_DIR}/pages" "$@"
}

mkdir -p "${WORK_DIR}/doxygen" "${WORK_DIR}/pages/_static"
stage --headers "${WORK_DIR}/doxygen"
(cd "${WORK_DIR}/doxygen" && doxygen "${SOURCE_DIR}/scripts/site/Doxyfile")
stage --doxygen-xml "${WORK_DIR}/doxygen/xml"
cp "${SOURCE_DIR}/scripts/site/conf.py" "${WORK_DIR}/pages/"
cp "${SOURCE_DIR}/scripts/site/site.css" "${WORK_DIR}/pages/_static/"

SITE_VERSION="$("${PROGRAM}" version | sed -n 's/^cartographer_sdf //p')"
export SITE_VERSION
"${PYTHON}" -m sphinx -q -W --keep-going -b html "${WORK_DIR}/pages" "${WORK_DIR}/html"
rm -rf "${WORK_DIR}/html/.doctrees" "${WORK_DIR}/html/.buildinfo" "${WORK_DIR}/html/objects.inv"
"${PYTHON}" "${SOURCE_DIR}/scripts/site/check_links.py" "${WORK_DIR}/html"

rm -rf "${OUTPUT}"
mkdir -p "$(dirname "${OUTPUT}")"
mv "${WORK_DIR}/html" "${OUTPUT}"
echo "${OUTPUT}/index.html"
