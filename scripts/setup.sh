#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Installs missing Debian packages, configures and builds. run.sh and test.sh source this file; called directly, it
# builds only the program:
#
#   scripts/setup.sh              packages for building, running and most tests
#   scripts/setup.sh browser      also the browser in which scripts/test.sh tests the pages of scripts/report.py
#   scripts/setup.sh pictures     also packages for scripts/render_*.py
#   scripts/setup.sh paraview     also ParaView for scripts/paraview_modes.py
#   scripts/setup.sh import       also packages for scripts/import_mesh.py and the fields of the Python module
#   scripts/setup.sh peers        also SLEPc for scripts/check_eigenvalues.py
#   scripts/setup.sh package      also packages for cpack
#
# If no package is missing, nothing is downloaded and no root privileges are needed.

set -euo pipefail

squeal_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# libdeal.ii-dev depends on MPI, Trilinos, p4est, METIS, ARPACK and the other libraries with which deal.II
# was built. The libraries that CMakeLists.txt links directly are listed as well.
packages=(g++ cmake ninja-build git
          libdeal.ii-dev libsuitesparse-dev libmumps-dev libparpack2-dev libgmsh-dev
          libopenblas-dev liblapacke-dev libeigen3-dev libboost-serialization-dev nlohmann-json3-dev libmuparser-dev libnlopt-cxx-dev libceres-dev libopenturns-dev zlib1g-dev libseccomp-dev
          libgtest-dev openmpi-bin python3 python3-numpy python3-scipy python3-matplotlib python3-mpmath python3-pandas python3-yaml
          python3-plotly libjs-three libjs-jquery libjs-jquery-datatables)
packages_browser=(chromium chromium-driver python3-selenium)
packages_pictures=(python3-vtk9 libgl1-mesa-dri xvfb xauth)
# In Debian, python3-paraview replaces python3-vtk9 and contains its modules.
packages_paraview=(paraview python3-paraview libgl1-mesa-dri xvfb xauth)
packages_import=(python3-meshio python3-h5py python3-netcdf4)
packages_peers=(python3-petsc4py python3-slepc4py)
packages_package=(dpkg-dev file)

complain() { printf '%s\n' "$*" >&2; }

# Prints the given packages that are not installed.
missing_packages()
{
  local installed package
  installed=" $(dpkg-query -W -f '${db:Status-Status}:${Package} ' "$@" 2>/dev/null || true)"
  for package in "$@"; do
    [[ $installed == *" installed:$package "* ]] || printf '%s\n' "$package"
  done
}

# Installs the missing packages, or prints the command to do so.
install_packages()
{
  local missing privilege=()
  (($# > 0)) || return 0
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    complain "Packages are checked only on Debian systems. CMake reports missing libraries."
    return
  fi
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]} > 0)) || return 0

  if (($(id -u) != 0)); then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
      privilege=(sudo -n)
    else
      complain "Missing packages: ${missing[*]}"
      complain "Install them, then run this script again:"
      complain "  sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}"
      exit 1
    fi
  fi

  echo "Installing ${missing[*]}"
  local log apt=("${privilege[@]}" env DEBIAN_FRONTEND=noninteractive
                 apt-get -qq -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300)
  log=$(mktemp)
  if ! { "${apt[@]}" update && "${apt[@]}" install --yes --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    complain "apt-get update or install failed for: ${missing[*]}; check the network and the sources of packages, then repeat"
    exit 1
  fi
  rm -f "$log"
}

# Prints the package of the linker that deal.II requires (mold on Debian 13); prints nothing if it requires none.
linker_package()
{
  local linker
  linker=$(grep -hos 'fuse-ld=[a-z]*' /usr/share/cmake/deal.II/deal.IIConfig.cmake | head -n 1 || true)
  case ${linker#fuse-ld=} in
    mold | lld) echo "${linker#fuse-ld=}" ;;
  esac
}

# deal.II uses the BLAS that the system's alternatives select; the reference BLAS is about ten times slower than
# OpenBLAS.
check_blas()
{
  local blas
  blas=$(readlink -f "/usr/lib/$(uname -m)-linux-gnu/libblas.so.3" 2>/dev/null || true)
  case $blas in
    */blas/libblas.so.*)
      complain "Note: deal.II uses the slow reference BLAS ($blas)." \
               "Select OpenBLAS: update-alternatives --config libblas.so.3-$(uname -m)-linux-gnu."
      ;;
  esac
}

# Prints the number of parallel compilations: one per core, but at most one per 2 GB of memory.
build_jobs()
{
  local cores memory limit jobs
  cores=$(nproc)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo 2>/dev/null || true)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || true)
  memory=${memory:-2048}
  if [[ $limit =~ ^[0-9]+$ ]] && ((limit / 1048576 < memory)); then
    memory=$((limit / 1048576))
  fi
  jobs=$((memory / 2048))
  ((jobs < cores)) || jobs=$cores
  ((jobs > 0)) || jobs=1
  echo "$jobs"
}

# build PRESET [TARGET]...: configures if necessary and builds the named targets, or everything. After an error, the output
# is shown and kept in build/PRESET/build.log.
build()
{
  local preset=$1 targets=()
  shift
  (($# == 0)) || targets=(--target "$@")
  local directory=$squeal_root/build/$preset
  local log=$directory/build.log fresh=()
  mkdir -p "$directory"
  # Configure again in a copied source tree, whose build directory would build the original sources.
  if [[ -f $directory/CMakeCache.txt ]] &&
     ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$squeal_root" "$directory/CMakeCache.txt"; then
    fresh=(--fresh)
  fi
  echo "Building build/$preset"
  if ! (
    cd "$squeal_root"
    if [[ ! -f $directory/build.ninja ]] || ((${#fresh[@]} > 0)); then
      cmake --preset "$preset" "${fresh[@]}" || exit 1
    fi
    cmake --build --preset "$preset" "${targets[@]}" -- --quiet -j "$(build_jobs)"
  ) >"$log" 2>&1; then
    cat "$log" >&2
    complain "The build failed; the messages above are in $log."
    exit 1
  fi
}

# Selects OpenBLAS kernels by the flags of the processor, because OpenBLAS uses SSE3 kernels on unknown processors.
set_blas_kernels()
{
  local flags
  [[ -z ${OPENBLAS_CORETYPE:-} ]] || return 0
  OPENBLAS_VERBOSE=2 "$squeal_root/build/release/squeal" --version 2>&1 | grep -q 'Core: Prescott' || return 0
  flags=" $(grep -m 1 '^flags' /proc/cpuinfo) "
  case $flags in
    *" avx512vl "*) export OPENBLAS_CORETYPE=SkylakeX ;;
    *" avx2 "*) export OPENBLAS_CORETYPE=Haswell ;;
  esac
}

# Sets one BLAS thread per process, because threads that compete for cores slow down factorisations considerably, and
# configures Open MPI for containers, for root, and for more processes than cores.
set_environment()
{
  set_blas_kernels
  export OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1}
  export OMPI_MCA_rmaps_base_oversubscribe=1
  export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe # for Open MPI 5
  export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle:-1}
  export OMPI_MCA_btl_vader_single_copy_mechanism=none
  if (($(id -u) == 0)); then
    export OMPI_ALLOW_RUN_AS_ROOT=1
    export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  fi
}

# setup PRESET [TARGET]...: installs packages, configures and builds; without TARGET, it also builds the tests.
setup()
{
  install_packages "${packages[@]}"
  mapfile -t packages_linker < <(linker_package)
  install_packages "${packages_linker[@]}"
  check_blas
  build "$@"
  set_environment
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
  additional=()
  for group in "$@"; do
    case $group in
      browser) additional+=("${packages_browser[@]}") ;;
      pictures)
        if [[ -z $(missing_packages python3-paraview) ]]; then
          packages_pictures=("${packages_pictures[@]/python3-vtk9/python3-paraview}")
        fi
        additional+=("${packages_pictures[@]}") ;;
      paraview) additional+=("${packages_paraview[@]}") ;;
      import) additional+=("${packages_import[@]}") ;;
      peers) additional+=("${packages_peers[@]}") ;;
      package) additional+=("${packages_package[@]}") ;;
      *) complain "usage: scripts/setup.sh [browser] [pictures] [paraview] [import] [peers] [package]"; exit 2 ;;
    esac
  done
  install_packages "${packages[@]}" "${additional[@]}"
  setup release squeal
fi
