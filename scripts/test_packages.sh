#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Installs the Debian packages in a bare Debian 12, which debootstrap makes from
# the mirror that this machine's apt knows, runs the demo there, and removes
# them: the steps of the Dockerfile, without Docker.

set -euo pipefail

usage() {
  cat <<END
usage: scripts/test_packages.sh [--build | PACKAGES_DIR] [--with-libraries]
  --build           makes the packages in a bare Debian 12 of its own, too, from
                    the files that git knows: both stages of the Dockerfile
  PACKAGES_DIR      where make_packages.sh left the .deb files, packages/ of the
                    checkout by default; made if there are none
  --with-libraries  also builds a program that uses the installed libraries, for
                    which some 600 MB of compilers and libraries are installed
environment:
  WORK_DIR  where the bare system goes, some 500 MB; removed at the end
Without root or debootstrap, or not on Debian 12, the test is skipped.
END
}

SOURCE_DIR="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
PACKAGES_DIR="${SOURCE_DIR}/packages"
builds=false
with_libraries=false
while (($# > 0)); do
  case "$1" in
    --build) builds=true ;;
    --with-libraries) with_libraries=true ;;
    -h | --help) usage && exit 0 ;;
    -*) usage >&2 && exit 2 ;;
    *) PACKAGES_DIR="$1" ;;
  esac
  shift
done

skip() {
  echo "test_packages.sh: skipped: $*"
  exit 0
}
step() { printf '\n=== %s\n' "$*"; }

((EUID == 0)) || skip "needs root, for debootstrap"
command -v debootstrap >/dev/null || skip "needs debootstrap (scripts/install_dependencies.sh --packages)"
# shellcheck disable=SC1091
CODENAME="$(. /etc/os-release && echo "${ID}:${VERSION_CODENAME:-}")"
[[ "${CODENAME}" == debian:bookworm ]] || skip "the packages are for Debian 12, this is ${CODENAME}"
CODENAME="${CODENAME#debian:}"
# Where this machine gets Debian from.
MIRROR="$(apt-get indextargets --format '$(CODENAME) $(COMPONENT) $(REPO_URI)' 'Created-By: Packages' |
  awk -v codename="${CODENAME}" '$1 == codename && $2 == "main" { print $3; exit }')"
[[ -n "${MIRROR}" ]] || skip "apt knows no mirror of ${CODENAME}"

"${builds}" || compgen -G "${PACKAGES_DIR}/cartographer-sdf_*.deb" >/dev/null ||
  "${SOURCE_DIR}/scripts/make_packages.sh" "${PACKAGES_DIR}"

WORK_DIR="$(mktemp -d "${WORK_DIR:-${TMPDIR:-/tmp}}/cartographer_sdf_root.XXXXXX")"
ROOT="${WORK_DIR}/root"
clean_up() {
  # Nothing of this machine may be mounted where files are removed.
  local root
  for root in "${WORK_DIR}"/*/proc; do
    if mountpoint --quiet "${root}"; then umount "${root}" || return; fi
  done
  rm -rf "${WORK_DIR}"
}
trap clean_up EXIT

in_root() {
  chroot "${ROOT}" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@" </dev/null
}
shown() {
  echo "\$ $*"
  in_root "$@"
}

step "a bare Debian 12"
debootstrap --variant=minbase "${CODENAME}" "${ROOT}" "${MIRROR}" >"${WORK_DIR}/debootstrap.log" 2>&1 ||
  { tail -20 "${WORK_DIR}/debootstrap.log" >&2 && exit 1; }
# How this machine reaches its mirrors; not what it does with packages.
cp /etc/resolv.conf "${ROOT}/etc/resolv.conf" 2>/dev/null || true
apt-config dump Acquire | grep -E '^Acquire::(http|https)::?(Proxy|Verify|CaInfo)' \
  >"${ROOT}/etc/apt/apt.conf.d/90mirror" || true
if "${builds}"; then
  step "build the packages in another"
  cp -a "${ROOT}" "${WORK_DIR}/builder"
  ROOT="${WORK_DIR}/builder"
  mount -t proc proc "${ROOT}/proc"
  mkdir "${ROOT}/source"
  git -C "${SOURCE_DIR}" ls-files -z |
    tar --create --directory "${SOURCE_DIR}" --null --files-from - | tar --extract --directory "${ROOT}/source"
  COMMIT="$(git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12)"
  shown env BUILD_DIR=/build "CMAKE_OPTIONS=-DCARTOGRAPHER_SDF_COMMIT=${COMMIT}" \
    /source/scripts/make_packages.sh /packages >"${WORK_DIR}/build.log" 2>&1 ||
    { tail -30 "${WORK_DIR}/build.log" >&2 && exit 1; }
  tail -4 "${WORK_DIR}/build.log"
  PACKAGES_DIR="${ROOT}/packages"
  ROOT="${WORK_DIR}/root"
fi
mount -t proc proc "${ROOT}/proc"
in_root dpkg-query --show | sort >"${WORK_DIR}/before"
echo "$(wc -l <"${WORK_DIR}/before") packages, no compiler, no Python"

step "install"
mkdir "${ROOT}/packages"
cp "${PACKAGES_DIR}"/*cartographer-sdf*.deb "${ROOT}/packages"
# The libraries for developers bring compilers along.
packages=()
for file in "${ROOT}"/packages/*.deb; do
  case "${file##*/}" in
    lib*) "${with_libraries}" || continue ;;
  esac
  packages+=("/packages/${file##*/}")
done
in_root apt-get update -qq
in_root apt-get install -y -qq --no-install-recommends "${packages[@]}" man-db bash-completion \
  >"${WORK_DIR}/install.log" 2>&1 || { tail -30 "${WORK_DIR}/install.log" >&2 && exit 1; }
in_root dpkg-query --show '*cartographer-sdf*'

step "use"
shown cartographer_sdf version
shown cartographer_sdf simulate --output /root/map.pbstream --truth /root/truth.csv
shown cartographer_sdf close_loops /root/map.pbstream -o /root/closed.pbstream --report /root/report \
  --result /root/result.json
shown cartographer_sdf evaluate /root/map.pbstream --truth /root/truth.csv
shown cartographer_sdf evaluate /root/closed.pbstream --truth /root/truth.csv
shown cartographer_sdf export /root/closed.pbstream --map_filestem /root/map
shown cartographer_sdf batch /root/map.pbstream -o /root/night
if compgen -G "${ROOT}/packages/cartographer-sdf-live_*.deb" >/dev/null; then
  shown cartographer_sdf_run_log --version
fi
if compgen -G "${ROOT}/packages/python3-cartographer-sdf_*.deb" >/dev/null; then
  shown python3 -c 'import cartographer_sdf as sdf
matches = sdf.recognize(sdf.describe_map("/root/map.pbstream"))
score = sdf.score_matches(matches, sdf.read_map("/root/map.pbstream"), "/root/truth.csv")
print("recall of a map: %.3f" % score["accepted_recall"])'
fi
for page in cartographer_sdf cartographer_sdf-close_loops; do
  shown man "${page}" | sed -n 1,12p
done
shown bash -c 'source /usr/share/bash-completion/completions/cartographer_sdf && complete -p cartographer_sdf'

if "${with_libraries}"; then
  step "build with the libraries"
  in_root apt-get install -y -qq --no-install-recommends cmake g++ ninja-build libgflags-dev \
    >"${WORK_DIR}/install2.log" 2>&1 || { tail -30 "${WORK_DIR}/install2.log" >&2 && exit 1; }
  cp -r "${SOURCE_DIR}/test/installation" "${ROOT}/root/consumer"
  in_root cmake -S /root/consumer -B /root/consumer/build -G Ninja -DCMAKE_BUILD_TYPE=Debug \
    -DCARTOGRAPHER_SDF_INCLUDE_DIRECTORY=/usr/include
  in_root cmake --build /root/consumer/build
  shown /root/consumer/build/consumer
fi

step "remove"
in_root bash -c 'dpkg-query --show --showformat="\${Package}\n" "*cartographer-sdf*" | xargs dpkg --listfiles' |
  sort -u >"${WORK_DIR}/files"
in_root bash -c 'dpkg-query --show --showformat="\${Package}\n" "*cartographer-sdf*" |
  xargs apt-get purge -y -qq' >"${WORK_DIR}/remove.log" 2>&1 ||
  { tail -30 "${WORK_DIR}/remove.log" >&2 && exit 1; }
left=0
while IFS= read -r file; do
  if [[ "${file}" == *cartographer* && -e "${ROOT}${file}" ]]; then
    echo "left behind: ${file}" >&2
    left=1
  fi
done <"${WORK_DIR}/files"
in_root apt-get autoremove --purge -y -qq >/dev/null 2>&1
((left == 0)) || exit 1
echo "$(grep -c cartographer "${WORK_DIR}/files") files and folders were installed, none is left"

step "done: the packages install, run, and go without a trace"
