#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds with assertions and with the address and undefined-behaviour sanitizers, and runs the quick tests. Arguments are
# passed to ctest:
#
#   scripts/test_sanitizers.sh
#   scripts/test_sanitizers.sh -R contact
#   scripts/test_sanitizers.sh --all          all tests, which takes hours

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

targets=(quick) selection=(-L quick)
if [[ ${1:-} == --all ]]; then
  shift
  targets=() selection=()
fi
setup sanitizers "${targets[@]}"

cd "$squeal_root"
ctest --preset sanitizers --no-tests=error "${selection[@]}" "$@"
