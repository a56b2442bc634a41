#!/usr/bin/env bash
# Installs what is missing, builds, and runs squeal on parameter files:
#
#   scripts/run.sh [PRM]... [-- OPTION...]
#
# Without PRM, runs prm/disc_pins.prm. Results of x.prm go to results/x. Options after -- are handed to squeal:
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
    -*) complain "$usage"; complain "Options of squeal go after --: $1"; exit 2 ;;
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

setup squeal

cd "$squeal_root"
for parameter_file in "${parameter_files[@]}"; do
  name=$(basename "$parameter_file" .prm)
  build/release/squeal "${parameter_file#"$squeal_root/"}" --output "results/$name" "${options[@]}"
done
