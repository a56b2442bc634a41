#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Installs missing packages, builds, and runs the tests; arguments other than --extended are passed to ctest:
#
#   scripts/test.sh
#   scripts/test.sh -R contact
#   scripts/test.sh --extended        only the long tests, which are omitted otherwise

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

selection=(-LE extended)
if [[ ${1:-} == --extended ]]; then
  shift
  selection=(-L extended)
fi

install_packages "${packages[@]}" "${packages_browser[@]}" "${packages_import[@]}"
setup release

cd "$squeal_root"
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} # ctest runs several tests concurrently
ctest --preset release --no-tests=error "${selection[@]}" "$@"
