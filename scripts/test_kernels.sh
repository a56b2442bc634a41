#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds, and runs tests of dense decompositions with several sets of OpenBLAS kernels, whose rounding differs:
#
#   scripts/test_kernels.sh
#   scripts/test_kernels.sh -R sliding
#
# Arguments are passed to ctest. Kernels that the processor does not support, and the kernels used by scripts/test.sh, are skipped
# with a message.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# Processor features required by each set of kernels
declare -A needs=([Prescott]="pni" [Haswell]="avx2 fma" [SkylakeX]="avx512f avx512dq avx512bw avx512vl avx512cd")
flags=" $(grep -m 1 '^flags' /proc/cpuinfo) "

setup release

cd "$squeal_root"
own=$(/usr/bin/python3 -c 'import ctypes; name = ctypes.CDLL("libopenblas.so.0").openblas_get_corename; name.restype = ctypes.c_char_p; print(name().decode())')
failed=()
for kernels in Prescott Haswell SkylakeX; do
  if [[ $kernels == "$own" || $kernels$own == SkylakeXCooperlake ]]; then # the two sets differ only in bfloat16
    echo "Kernels $kernels skipped: already used by scripts/test.sh"
    continue
  fi
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
