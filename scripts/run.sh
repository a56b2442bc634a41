#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Installs missing packages, builds, and runs squeal on parameter files:
#
#   scripts/run.sh [PRM]... [-- OPTION...]
#
# Without PRM, runs prm/disc_pins.prm. Results of x.prm are written to results/x, their plots to results/x/plots, and a report for the
# browser to results/x/report.html. Options after -- are passed to squeal:
#
#   scripts/run.sh prm/disc_pins.prm -- --set "Operation/Friction coefficient=0.3"

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage="usage: scripts/run.sh [PRM]... [-- OPTION...]"
parameter_files=()
while (($# > 0)); do
  case $1 in
    --) shift; break ;;
    -h | --help) echo "$usage"; exit 0 ;;
    -*) complain "$usage"; complain "Put options of squeal after --: $1"; exit 2 ;;
    *)
      if [[ ! -f $1 ]]; then
        complain "There is no parameter file $1."
        exit 2
      fi
      parameter_files+=("$(realpath "$1")")
      shift
      ;;
  esac
done
options=("$@")
((${#parameter_files[@]} > 0)) || parameter_files=("$squeal_root/prm/disc_pins.prm")

# Prints an identifier of the results in a folder; nothing if there are none.
state_of() { stat --format '%i %y' "$1/run.json" 2>/dev/null || true; }

# Draws plots and writes the report; ignores errors.
draw_plots()
{
  local python
  if python=$(command -v /usr/bin/python3 || command -v python3); then
    "$python" scripts/plot_results.py "$1" || true
    "$python" scripts/report.py "$1" || true
  else
    complain "No plots: Python is missing. Install python3-matplotlib, then run scripts/plot_results.py $1"
  fi
}

setup release squeal

cd "$squeal_root"
for parameter_file in "${parameter_files[@]}"; do
  name=$(basename "$parameter_file" .prm)
  former=$(state_of "results/$name")
  build/release/squeal "${parameter_file#"$squeal_root/"}" --output "results/$name" "${options[@]}"
  # Skip plots if options such as --dry-run write no results
  [[ $(state_of "results/$name") == "$former" ]] || draw_plots "results/$name"
done
