#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Tells the sources whose layout is not that of .clang-format, with clang-format 14, the version of Debian 12, and those that do not
# name their licence:
#
#   scripts/check_format.sh          lists them
#   scripts/check_format.sh --fix    lays them out

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
mode=(--dry-run -Werror)
[[ ${1:-} == --fix ]] && mode=(-i)

command -v clang-format-14 > /dev/null || install_packages clang-format-14
cd "$squeal_root"
find include source tests -name '*.h' -print0 -o -name '*.cc' -print0 | xargs -0 clang-format-14 "${mode[@]}"
unlicensed=$(git ls-files -z | grep -zE '\.(cc|h|in|py|sh|cmake|geo)$|CMakeLists.txt$|^\.ci/run$' |
  xargs -0 grep -L 'SPDX-License-Identifier: GPL-3.0-or-later' || true)
if [[ -n $unlicensed ]]; then
  complain "No line of the licence in:" "$unlicensed"
  exit 1
fi
