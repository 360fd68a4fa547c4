#!/usr/bin/env bash
# Installs the missing packages of scripts/packages.txt and builds build/release/bin/holdfast.
#   ./setup.sh           everything needed to run and to test
#   ./setup.sh --lint    also the tools of the style checks
# A second run finds nothing to install and nothing to build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

groups='runtime|build|test'
case "${1-}" in
  '') ;;
  --lint) groups="$groups|lint" ;;
  *) echo "usage: ./setup.sh [--lint]" >&2; exit 2 ;;
esac

missing_packages() {
  local wanted installed
  wanted=$(sed 's/#.*//' scripts/packages.txt |
    awk -v groups="^($groups)\$" '$1 ~ groups {print $2}')
  # dpkg-query fails when it does not know one of them, and still lists the others.
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null |
    awk '$1 == "installed" {print $2}' || true)
  comm -23 <(sort -u <<<"$wanted") <(sort -u <<<"$installed")
}

install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "setup.sh: neither root nor sudo; have these installed: $*" >&2
      exit 1
    fi
    as_root=(sudo)
  fi
  echo "setup: installing $*"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq
    -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
  "${apt[@]}" update </dev/null
  "${apt[@]}" install -y --no-install-recommends "$@" </dev/null >/dev/null
}

if ! command -v dpkg-query >/dev/null; then
  echo "setup.sh: expected Debian 12 or Ubuntu 22.04+ (dpkg), found neither" >&2
  exit 1
fi
missing=$(missing_packages)
if [ -n "$missing" ]; then install_packages $missing; fi

scripts/build release holdfast
