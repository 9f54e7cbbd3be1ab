#!/usr/bin/env bash
# Installs what is missing, builds, runs every test. Where it builds: as run.sh.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/tools/folders.sh"
bash "$root/tools/install.sh" xvfb ffmpeg # a display and an encoder for the window's tests
if command -v npm >/dev/null && ! bash "$root/tools/gltf/install.sh"; then
  echo "No glTF validator: its test is skipped." >&2
fi
bash "$root/tools/build.sh" "$build" all -DCMAKE_BUILD_TYPE=Release
bash "$root/tools/ctest.sh" "$build"
