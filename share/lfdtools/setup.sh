#!/bin/sh
# Installs what is missing (Debian 12 packages, as root or through sudo) and builds lfdtools.
#
#   sh share/lfdtools/setup.sh             the programs
#   sh share/lfdtools/setup.sh --tests     the programs and the tests, with the packages that the tests ask for
#
# Result: build/release/tools. Running it again costs a second when nothing has changed.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${LFD_BUILD_DIR:-$root/build/release}

packages="g++ cmake make ninja-build ccache libeigen3-dev libcli11-dev nlohmann-json3-dev libfmt-dev liblbfgspp-dev libmd-dev libyaml-cpp-dev"
testing=OFF
case "${1-}" in
  "") ;;
  --tests)
    testing=ON
    packages="$packages catch2 liborocos-kdl-dev libfcl-dev libompl-dev python3-numpy python3-scipy python3-sklearn"
    ;;
  *) echo "setup.sh: unknown option $1" >&2; exit 64 ;;
esac

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=none
  [ "$status" = installed ] || missing="$missing $package"
done
if [ -n "$missing" ]; then
  echo "setup: installing$missing" >&2
  sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || { echo "setup: packages are missing and neither root nor sudo is there" >&2; exit 1; }
    sudo=sudo
  fi
  export DEBIAN_FRONTEND=noninteractive
  $sudo apt-get -o DPkg::Lock::Timeout=300 -qq update >&2
  # shellcheck disable=SC2086  # the list is meant to be split
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -qq install -y --no-install-recommends $missing >&2
fi

log=$build/setup.log
mkdir -p "$build"
[ "$testing" = ON ] || ! grep -q '^BUILD_TESTING:BOOL=ON' "$build/CMakeCache.txt" 2>/dev/null || testing=ON
if ! { cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=$testing &&
       cmake --build "$build"; } >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  echo "setup: the build failed; the whole log is $log" >&2
  exit 1
fi
