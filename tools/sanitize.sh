#!/usr/bin/env bash
# The same tests under AddressSanitizer and UndefinedBehaviorSanitizer; long ones shorten themselves.
# Those that compile the sources themselves would run without sanitizers: left out by their label.
# By clang++: so both of Debian's compilers build all of it, and every test passes with either.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$root/build-asan" all -DCMAKE_CXX_COMPILER=clang++ \
  -DGAITPAD_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
bash "$root/tools/ctest.sh" "$root/build-asan" -LE own_build
