#!/usr/bin/env bash
# Installs what is missing, builds, runs every test.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh" xvfb ffmpeg # a display and an encoder for the window's tests
if command -v npm >/dev/null && ! bash "$root/tools/gltf/install.sh"; then
  echo "No glTF validator: its test is skipped." >&2
fi
bash "$root/tools/build.sh" "$root/build" all -DCMAKE_BUILD_TYPE=Release
bash "$root/tools/ctest.sh" "$root/build"
