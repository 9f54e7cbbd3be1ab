#!/usr/bin/env bash
# install.sh [PACKAGE...]: installs what gaitpad needs from Debian 12, and those packages: nothing where
# all is there, apt else (sudo if not root).
set -euo pipefail

packages=(g++ clang cmake ninja-build libglm-dev libeigen3-dev libtbb-dev libtomlplusplus-dev libcli11-dev libfmt-dev
  nlohmann-json3-dev pkg-config libudev-dev libhidapi-dev libusb-1.0-0-dev libevdev-dev libsdl2-dev
  libcairo2-dev libimgui-dev libepoxy-dev libfreetype-dev libpng-dev libgl1 libegl1 libgl1-mesa-dri fonts-dejavu-core
  libgtest-dev libbenchmark-dev python3-numpy python3-matplotlib python3-pytest "$@")

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
echo "Installing ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update &&
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
    "${missing[@]}"; } >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
