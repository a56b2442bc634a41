#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Runs the two commands of the README in a chroot with a minimal Debian, to reveal missing dependencies. Requires root
# and debootstrap.
#
#   scripts/try_debian.sh [RELEASE] [--kernels NAME]... [--run-only | --package DEB] [--keep] [--in DIR]
#
#   RELEASE          bookworm (Debian 12, default), trixie (Debian 13) or sid
#   --kernels NAME   OPENBLAS_CORETYPE of the tests; if repeated, the tests run once with each (default: as detected)
#   --run-only       only scripts/run.sh
#   --package DEB    instead of both commands: installs this package, runs it and writes the report
#   --keep           keeps the chroot for inspection or a quick retry
#   --in DIR         folder of the chroot (default: a temporary folder)
#
# Tests a fresh clone of the last commit. Packages are downloaded from the mirror of this machine. The times printed at
# the end include the installation of packages.

set -euo pipefail
# Mounts are visible only to this script and disappear when it ends.
if [[ -z ${squeal_private_mounts:-} ]] && (($(id -u) == 0)); then
  squeal_private_mounts=yes exec unshare --mount "${BASH_SOURCE[0]}" "$@"
fi
squeal_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
usage() { sed -n '4,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
complain() { printf '%s\n' "$*" >&2; }

release=bookworm kernels=() run_only=false package= keep=false directory=
while (($# > 0)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --run-only) run_only=true; shift ;;
    --keep) keep=true; shift ;;
    --kernels | --package | --in)
      if (($# < 2)); then usage >&2; exit 2; fi
      case $1 in
        --kernels) kernels+=("$2") ;;
        --package) package=$(realpath "$2") ;;
        --in) directory=$2 ;;
      esac
      shift 2
      ;;
    bookworm | trixie | sid) release=$1; shift ;;
    *) usage >&2; exit 2 ;;
  esac
done
((${#kernels[@]} > 0)) || kernels=("")
if (($(id -u) != 0)); then complain "A chroot requires root: run this script as root."; exit 1; fi
if ! command -v debootstrap >/dev/null; then complain "debootstrap is missing: apt-get install debootstrap"; exit 1; fi
mirror=$(apt-get indextargets 'Created-By: Packages' --format '$(REPO_URI)' | grep -E '/debian/?$' | head -n 1)
if [[ -z $mirror ]]; then complain "apt-get lists no Debian mirror. Check /etc/apt/sources.list."; exit 1; fi

directory=${directory:-$(mktemp -d)}
root=$directory/$release
clean_up()
{
  umount --recursive --lazy "$root/proc" "$root/dev" "$root/sys" 2>/dev/null || true
  $keep || rm -rf --one-file-system "$root"
}
trap clean_up EXIT

if [[ ! -x $root/usr/bin/apt-get ]]; then
  echo "Debian $release in $root"
  mkdir -p "$root"
  debootstrap --variant=minbase --include=ca-certificates "$release" "$root" "$mirror" >"$directory/debootstrap.log" 2>&1 ||
    { tail -n 20 "$directory/debootstrap.log" >&2; complain "debootstrap failed; see $directory/debootstrap.log"; exit 1; }
fi
# The mirror may require the proxies and certificates of this machine
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
cp -L --remove-destination /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/" 2>/dev/null || true
cp -L --remove-destination /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev" && mount --make-rslave "$root/dev"
mount --rbind /sys "$root/sys" && mount --make-rslave "$root/sys"

rm -rf "$root/root/squeal"
git clone --quiet "$squeal_root" "$root/root/squeal"

# Use a clean environment, without the variables of this shell
inside() { chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }
times=()
try()
{
  local name=$1 start=$SECONDS status=0
  shift
  echo "--- $release: $name"
  inside "$@" || status=$?
  times+=("$release: $name: $((SECONDS - start)) s, exit status $status")
  return "$status"
}

failed=false
if [[ -n $package ]]; then
  cp "$package" "$root/root/"
  try "installation of the package" sh -c 'apt-get -qq update && DEBIAN_FRONTEND=noninteractive apt-get -qq install --yes --no-install-recommends /root/squeal_*.deb >/dev/null' &&
    try "first run" sh -c 'cd /root && OPENBLAS_NUM_THREADS=1 squeal /usr/share/squeal/prm/disc_pins.prm' &&
    try "report" /usr/share/squeal/scripts/report.py /root/results/disc_pins || failed=true
  printf '%s\n' "${times[@]}"
  ! $failed
  exit
fi
try "scripts/run.sh" /root/squeal/scripts/run.sh || failed=true
if ! $run_only; then
  for kernel in "${kernels[@]}"; do
    try "scripts/test.sh${kernel:+ with $kernel kernels}" ${kernel:+"OPENBLAS_CORETYPE=$kernel"} /root/squeal/scripts/test.sh || failed=true
  done
fi
warnings=$(grep -c 'warning:' "$root/root/squeal/build/release/build.log" || true)
times+=("$release: warnings of the last build: $warnings")
printf '%s\n' "${times[@]}"
! $failed
