#!/usr/bin/env bash
# Installs Khronos' glTF validator into build/gltf, for the tests of glTF; does nothing if it is already there.
# node and npm come from Debian if they are missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=$root/build/gltf
cmp -s "$here/package-lock.json" "$target/package-lock.json" && [ -d "$target/node_modules/gltf-validator" ] &&
  exit 0
command -v node >/dev/null && command -v npm >/dev/null || bash "$root/tools/install.sh" nodejs npm
mkdir -p "$target"
cp "$here/package.json" "$here/package-lock.json" "$target"
if ! log=$(cd "$target" && npm ci --no-audit --no-fund --ignore-scripts 2>&1); then
  rm -f "$target/package-lock.json"
  echo "$log" >&2
  exit 1
fi
