#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the documentation as a site in build/site and checks its links and anchors; warnings count as errors:
#
#   scripts/site.sh           builds and checks
#   scripts/site.sh --serve   shows the site at http://localhost:8000 until Ctrl-C; pages reload when they are edited
#
# Installs Debian's mkdocs-material and linkchecker if they are missing. Neither the build nor the site loads anything from the network.

set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

case ${1:-} in
  "" | --serve) ;;
  -h | --help) sed -n '4,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
  *) complain "usage: scripts/site.sh [--serve]"; exit 2 ;;
esac

install_packages mkdocs-material linkchecker
cd "$squeal_root"
if [[ ${1:-} == --serve ]]; then
  exec mkdocs serve
fi
mkdocs build --quiet --clean

# Check relative links of the pages outside the site
n_missing=0
for page in README.md CONTRIBUTING.md SECURITY.md CHANGELOG.md; do
  while read -r link; do
    if [[ ! -e $link ]]; then
      complain "$page: $link does not exist."
      n_missing=$((n_missing + 1))
    fi
  done < <(grep -oP '\]\(\K[^)#:]+(?=[)#])' "$page")
done

# Check links and anchors of a copy of the site, because linkchecker run as root switches to the user nobody, who may not
# have access to the source tree
readable=$(mktemp -d)
trap 'rm -rf "$readable"' EXIT
cp -r build/site/. "$readable"
printf '[AnchorCheck]\n' >"$readable/linkchecker.ini"
chmod -R a+rX "$readable"
if ! linkchecker --config "$readable/linkchecker.ini" --no-status --no-robots --ignore-url='sitemap\.xml' "$readable/index.html" >"$readable/log" 2>&1; then
  cat "$readable/log" >&2
  complain "linkchecker reports errors in the site; see above."
  exit 1
fi
((n_missing == 0))
echo "build/site/index.html"
