#!/usr/bin/env bash
# test.sh [--all]: installs what is missing, builds, and runs the tests of every room and the program, with a part of
# the long sweeps, in a few minutes. --all: the whole sweeps, and the tests that compile the sources themselves (other
# compilers, without the drivers' libraries, as an installed library). Builds in the folder of run.sh.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
chosen=(-LE own_build)
case ${1:-} in
  "") ;;
  --all) export GAITPAD_ALL=1 ;;
  *)
    echo "test.sh: unknown option $1" >&2
    exit 2
    ;;
esac
[ "${GAITPAD_ALL:-}" != 1 ] || chosen=()
source "$root/tools/folders.sh"
bash "$root/tools/install.sh" xvfb ffmpeg # a display and an encoder for the window's tests
# Packages for tests that only a whole run includes: other processors, standard libraries and WebAssembly, valgrind, locales with decimal commas.
[ "${GAITPAD_ALL:-}" != 1 ] ||
  bash "$root/tools/install.sh" g++-aarch64-linux-gnu g++-i686-linux-gnu qemu-user-static libc++-dev libc++abi-dev \
    emscripten valgrind locales
if command -v npm >/dev/null && ! bash "$root/tools/gltf/install.sh"; then
  echo "No glTF validator: its test is skipped." >&2
fi
bash "$root/tools/build.sh" "$build" all -DCMAKE_BUILD_TYPE=Release
bash "$root/tools/ctest.sh" "$build" "${chosen[@]}"
