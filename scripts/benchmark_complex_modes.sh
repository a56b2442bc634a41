#!/usr/bin/env bash
# Times the complex modes of one run on one core: squeal against SLEPc's TOAR, in turn, medians at the end.
#
#   scripts/benchmark_complex_modes.sh DIRECTORY [--modes N] [--runs N] [--core N]
#
#   DIRECTORY   results of a run with Output/Write matrices = true
#   --modes N   modes to ask SLEPc for (66)
#   --runs N    repetitions (3)
#   --core N    the core to run on (0)
#
# Both times are processor seconds from the assembled matrices in memory to the modes: of squeal, the steps
# Factorisation and Complex modes of its run record, and the same with the step Real modes, which a run makes in
# any case and from which it takes the number of modes to look for; of SLEPc, set-up and solution with that number
# given. Reading the matrices is not counted. Both get the same BLAS kernels.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }

modes=66 runs=3 core=0 directory=
while (($# > 0)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --modes | --runs | --core)
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
command=("$squeal_root/build/release/squeal" "$directory/parameters.prm" --output "$temporary/run"
         --set "Output/Mode shapes=none" --set "Output/Write matrices=false")
# squeal chooses its kernels itself where OpenBLAS does not know the processor; SLEPc gets the same.
if grep -q avx512vl /proc/cpuinfo; then export OPENBLAS_CORETYPE="${OPENBLAS_CORETYPE:-SkylakeX}"; fi

# Processor seconds of the named steps in the run record.
steps() { python3 -c 'import json, sys
print(sum(step["CPU time [s]"] for step in json.load(open(sys.argv[1]))["steps"] if step["name"] in sys.argv[2:]))' "$@"; }

median() { sort -g "$1" | awk '{ value[NR] = $1 } END { print (value[int((NR + 1) / 2)] + value[int(NR / 2) + 1]) / 2 }'; }

for ((run = 1; run <= runs; ++run)); do
  rm -rf "$temporary/run"
  if ! taskset -c "$core" "${command[@]}" >"$temporary/log" 2>&1; then
    cat "$temporary/log" >&2
    complain "squeal failed: ${command[*]}"
    exit 1
  fi
  steps "$temporary/run/run.json" "Factorisation" "Complex modes" >"$temporary/one"
  cat "$temporary/one" >>"$temporary/squeal"
  steps "$temporary/run/run.json" "Factorisation" "Complex modes" "Real modes" >>"$temporary/squeal_with_real"

  taskset -c "$core" "$squeal_root/scripts/slepc_toar.py" "$directory" --modes "$modes" --runs 1 >"$temporary/log"
  ((run > 1)) || grep -E '^(reading|coupling)' "$temporary/log"
  slepc=$(grep '^run 1' "$temporary/log")
  sed -n 's/.* wall, \([0-9.]*\) s CPU (setup.*/\1/p' <<<"$slepc" >>"$temporary/slepc"
  echo "run $run: squeal $(cat "$temporary/one") s; SLEPc ${slepc#run 1: }"
done

squeal=$(median "$temporary/squeal")
with_real=$(median "$temporary/squeal_with_real")
slepc=$(median "$temporary/slepc")
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", a / b }'; }
echo "median CPU: squeal $squeal s, SLEPc $slepc s, ratio $(ratio "$squeal" "$slepc");" \
     "squeal with its real modes $with_real s, ratio $(ratio "$with_real" "$slepc")"
