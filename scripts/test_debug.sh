#!/usr/bin/env bash
# Builds with the assertions of deal.II and of squeal, and runs the quick tests; arguments are handed to ctest:
#
#   scripts/test_debug.sh
#   scripts/test_debug.sh -R contact

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

setup debug quick

cd "$squeal_root"
ctest --preset debug --no-tests=error -L quick "$@"
