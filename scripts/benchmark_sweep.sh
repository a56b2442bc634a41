#!/usr/bin/env bash
# Times a error-controlled sweep on one core beside full-order solutions by SLEPc's TOAR.
#
#   scripts/benchmark_sweep.sh PRM [--modes N] [--core N] [-- OPTION...]
#
#   PRM         parameter file with Study = sweep; OPTIONs are handed to squeal
#   --modes N   modes to ask SLEPc for (66)
#   --core N    the core to run on (0)
#
# Processor seconds: of squeal, the whole run from the mesh to the tables; of SLEPc, the solution from the
# assembled matrices at five of the friction coefficients, of which the mean stands for all. Both get the same BLAS kernels.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }

modes=66 core=0 parameters=
while (($# > 0)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --modes | --core)
      if (($# < 2)); then usage >&2; exit 2; fi
      printf -v "${1#--}" '%s' "$2"
      shift 2
      ;;
    --) shift; break ;;
    -*) usage >&2; exit 2 ;;
    *) parameters=$1; shift ;;
  esac
done
if [[ ! -f $parameters ]]; then usage >&2; exit 2; fi
options=("$@")

set_environment
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 DEAL_II_NUM_THREADS=1
if grep -q avx512vl /proc/cpuinfo; then export OPENBLAS_CORETYPE="${OPENBLAS_CORETYPE:-SkylakeX}"; fi
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
squeal=(taskset -c "$core" "$squeal_root/build/release/squeal" "$parameters" "${options[@]}")

"${squeal[@]}" --output "$temporary/sweep" >"$temporary/log" || { cat "$temporary/log" >&2; exit 1; }
"${squeal[@]}" --output "$temporary/matrices" --set "Study=stability" --set "Output/Write matrices=true" \
  --set "Output/Mode shapes=none" >"$temporary/log" || { cat "$temporary/log" >&2; exit 1; }

# Processor seconds of the whole sweep, and its friction coefficients
read -r sweep number first last < <(python3 - "$temporary/sweep" <<'PYTHON'
import json, sys
print(sum(step["CPU time [s]"] for step in json.load(open(sys.argv[1] + "/run.json"))["steps"]), end=" ")
section, values = "", {}
for line in open(sys.argv[1] + "/parameters.prm"):
    words = line.split(None, 1)
    if words[:1] == ["subsection"]:
        section = words[1].strip()
    elif words[:1] == ["set"] and section == "Sweep":
        name, value = words[1].split("=", 1)
        values[name.strip()] = value.strip()
print(values["Number of friction coefficients"], values["First friction coefficient"], values["Last friction coefficient"])
PYTHON
)
echo "squeal: $number friction coefficients, $sweep s CPU"
for part in 0.1 0.3 0.5 0.7 0.9; do
  mu=$(awk -v a="$first" -v b="$last" -v s="$part" 'BEGIN { print a + s * (b - a) }')
  line=$(taskset -c "$core" "$squeal_root/scripts/slepc_toar.py" "$temporary/matrices" --mu "$mu" --modes "$modes" --runs 1 | grep '^run 1')
  echo "SLEPc at mu = $mu: ${line#run 1: }"
  sed -n 's/.* wall, \([0-9.]*\) s CPU (setup.*/\1/p' <<<"$line" >>"$temporary/slepc"
done
awk -v n="$number" -v sweep="$sweep" '{ sum += $1 } END {
  printf "mean of %d solutions: %.2f s; %d of them would take %.0f s, %.1f times the sweep\n", NR, sum / NR, n, n * sum / NR, n * sum / NR / sweep }' \
  "$temporary/slepc"
