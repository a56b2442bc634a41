#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Computes numbers quoted in README.md and the pages of doc/, and prints each next to the quoted number:
#
#   scripts/reproduce.sh [--list] [--only WORDS] [PAGE]...
#
#   PAGE          README, table1, dissipation, ...; default: all pages
#   --list        prints pages and sentences without any run
#   --only WORDS  only the sentences that contain WORDS
#
# Results are written to results/reproduce/. A run is not repeated if results of the same command exist and are newer than
# the program. The exit status is 1 if a number differs from the page in a printed digit or exceeds a bound. All pages take hours on one core.
# Times are not reproduced; doc/benchmarks.md lists the commands that measure them.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

case ${1:-} in
  -h | --help) sed -n '4,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
set_environment
cd "$squeal_root"
PYTHONPATH=scripts exec /usr/bin/python3 -B -m reproduction "$@"
