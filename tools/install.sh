#!/usr/bin/env bash
# install.sh [--program] [PACKAGE...]: installs gaitpad's dependencies and those packages from Debian 12 with apt (by
# sudo if not root), if any are missing. --program: without packages that only tests need.
set -euo pipefail

packages=(g++ cmake ninja-build libglm-dev libeigen3-dev libtbb-dev libtomlplusplus-dev libcli11-dev libfmt-dev
  nlohmann-json3-dev pkg-config libudev-dev libhidapi-dev libusb-1.0-0-dev libevdev-dev libsdl2-dev
  libcairo2-dev libimgui-dev libepoxy-dev libfreetype-dev libpng-dev zlib1g-dev liblo-dev libgl1 libegl1 libgl1-mesa-dri fonts-dejavu-core
  libgtest-dev libbenchmark-dev)
if [ "${1:-}" = --program ]; then
  shift
else
  packages+=(clang python3-numpy python3-matplotlib python3-pytest strace)
fi
packages+=("$@")

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
    missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Missing: ${missing[*]}. Install them as root (apt-get install), sudo is not here." >&2
    exit 1
  fi
  as_root=(sudo)
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# apt WORDS...: apt-get with everything it says in the log, which is shown if it fails.
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "$@" >>"$log" 2>&1 || {
    cat "$log" >&2
    exit 1
  }
}
echo "Installing ${missing[*]}" >&2
apt update
# Size of the download, in apt's words: "Need to get ...", "After this operation ...".
LC_ALL=C apt-get install --no-install-recommends --assume-no "${missing[@]}" 2>/dev/null |
  grep -E '^(Need to get|After this operation)' | sed 's/^/  /' >&2 || true
apt install -y --no-install-recommends "${missing[@]}"
