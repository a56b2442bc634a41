#!/usr/bin/env bash
# Builds, and runs the tests that hang on dense decompositions with several sets of OpenBLAS kernels, whose results differ in the last digits:
#
#   scripts/test_kernels.sh
#   scripts/test_kernels.sh -R sliding
#
# Arguments are handed to ctest. Kernels that the processor cannot run are skipped, and named.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# What each set of kernels asks of the processor
declare -A needs=([Prescott]="pni" [Haswell]="avx2 fma" [SkylakeX]="avx512f avx512dq avx512bw avx512vl avx512cd")
flags=" $(grep -m 1 '^flags' /proc/cpuinfo) "

setup release

cd "$squeal_root"
failed=()
for kernels in Prescott Haswell SkylakeX; do
  missing=()
  for flag in ${needs[$kernels]}; do
    [[ $flags == *" $flag "* ]] || missing+=("$flag")
  done
  if ((${#missing[@]} > 0)); then
    echo "Kernels $kernels skipped: the processor has no ${missing[*]}"
    continue
  fi
  echo "Kernels $kernels"
  OPENBLAS_CORETYPE=$kernels ctest --preset release --no-tests=error -L lapack "$@" || failed+=("$kernels")
done
if ((${#failed[@]} > 0)); then
  complain "Tests failed with the kernels ${failed[*]}."
  exit 1
fi
