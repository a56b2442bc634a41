#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests; arguments are handed to ctest:
#
#   scripts/test.sh
#   scripts/test.sh -R contact

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${packages[@]}" "${packages_browser[@]}"
setup release

cd "$squeal_root"
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} # tests run side by side
ctest --preset release --no-tests=error "$@"
