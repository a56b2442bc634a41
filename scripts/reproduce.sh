#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Computes the numbers that README.md and the pages of doc/ quote, and prints each beside what the page says:
#
#   scripts/reproduce.sh [--list] [--only WORDS] [PAGE]...
#
#   PAGE          README, table1, dissipation, ...; without any, all pages
#   --list        prints pages and sentences, runs nothing
#   --only WORDS  only the sentences that contain WORDS
#
# Results go to results/reproduce/; runs that are there already, of the same command and not older than the program, are
# not repeated. The exit status is 1 where a number differs from the page in a printed digit. All pages take hours of one core. Times
# are not among the numbers: doc/benchmarks.md names their commands.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

case ${1:-} in
  -h | --help) sed -n '4,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
set_environment
cd "$squeal_root"
PYTHONPATH=scripts exec /usr/bin/python3 -B -m reproduction "$@"
