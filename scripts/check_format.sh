#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Checks the licence headers and, with clang-format 14 (the version in Debian 12), the layout of the sources:
#
#   scripts/check_format.sh          lists the files with errors
#   scripts/check_format.sh --fix    corrects the layout

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
  complain "The licence line is missing in:" "$unlicensed"
  exit 1
fi
