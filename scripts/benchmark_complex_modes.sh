#!/usr/bin/env bash
# Times the complex modes of one run on one core: squeal against SLEPc's TOAR, in turn, medians at the end.
#
#   scripts/benchmark_complex_modes.sh DIRECTORY [OPTION...] [-- COMMAND...]
#
#   DIRECTORY        output of a run with Output/Write matrices = true
#   --modes N        modes to ask SLEPc for (66)
#   --runs N         repetitions (3)
#   --core N         the core to run on (0)
#   --step PATTERN   squeal's time is the number of seconds in the lines that match this extended regular
#                    expression, added up ("Factorisation|Real modes|Complex modes": the real
#                    modes tell the program how many complex ones there are, or are its basis)
#   -- COMMAND...    runs squeal and lets it print its steps (default: the run's own parameters again,
#                    without fields)
#
# SLEPc's time is from the coupled matrices in memory to the modes; reading and coupling are printed apart.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }

modes=66 runs=3 core=0 step="Factorisation|Real modes|Complex modes" directory=
while (($# > 0)); do
  case $1 in
    --) shift; break ;;
    -h | --help) usage; exit 0 ;;
    --modes | --runs | --core | --step)
      if (($# < 2)); then usage >&2; exit 2; fi
      printf -v "${1#--}" '%s' "$2"
      shift 2
      ;;
    -*) usage >&2; exit 2 ;;
    *) directory=$1; shift ;;
  esac
done
if [[ -z $directory ]]; then usage >&2; exit 2; fi
if [[ ! -d $directory/matrices ]]; then
  complain "$directory/matrices is missing; run squeal with --set \"Output/Write matrices=true\"."
  exit 1
fi

set_environment
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 DEAL_II_NUM_THREADS=1
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
command=("$@")
if ((${#command[@]} == 0)); then
  command=("$squeal_root/build/release/squeal" "$directory/parameters.prm" --output "$temporary/run"
           --set "Output/Mode shapes=none" --set "Output/Write matrices=false")
fi

median() { sort -g "$1" | awk '{ value[NR] = $1 } END { print (value[int((NR + 1) / 2)] + value[int(NR / 2) + 1]) / 2 }'; }

for ((run = 1; run <= runs; ++run)); do
  rm -rf "$temporary/run"
  if ! taskset -c "$core" "${command[@]}" >"$temporary/log" 2>&1; then
    cat "$temporary/log" >&2
    complain "squeal failed: ${command[*]}"
    exit 1
  fi
  # The seconds of each matching line.
  grep -E "$step" "$temporary/log" |
    awk '{ for (i = 2; i <= NF; ++i) if ($i == "s" && $(i - 1) ~ /^[0-9.]+$/) { sum += $(i - 1); n = 1; break } }
         END { if (!n) exit 1; print sum }' >"$temporary/one" || {
    cat "$temporary/log" >&2
    complain "squeal printed no time in a line that matches \"$step\"."
    exit 1
  }
  cat "$temporary/one" >>"$temporary/squeal"

  taskset -c "$core" "$squeal_root/scripts/slepc_toar.py" "$directory" --modes "$modes" --runs 1 >"$temporary/log"
  ((run > 1)) || grep -E '^(reading|coupling)' "$temporary/log"
  slepc=$(grep '^run 1' "$temporary/log")
  sed -n 's/^median: \([0-9.]*\) s.*/\1/p' "$temporary/log" >>"$temporary/slepc"
  echo "run $run: squeal $(cat "$temporary/one") s; SLEPc ${slepc#run 1: }"
done

squeal=$(median "$temporary/squeal")
slepc=$(median "$temporary/slepc")
echo "median: squeal $squeal s, SLEPc $slepc s, ratio $(awk -v a="$slepc" -v b="$squeal" 'BEGIN { printf "%.1f", (b > 0) ? a / b : 0 }')"
