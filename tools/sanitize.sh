#!/usr/bin/env bash
# The same tests under AddressSanitizer and UndefinedBehaviorSanitizer, long ones shortened
# (GAITPAD_QUICK). The tests that build the program themselves have no sanitizer: left out by label.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$root/build-asan" all -DGAITPAD_SANITIZE=ON -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
export GAITPAD_QUICK=1
bash "$root/tools/ctest.sh" "$root/build-asan" -LE own_build
