#include "tests/folders.h"

#include <stdlib.h>

namespace gaitpad {
namespace {

// Tests neither read the user's cache of strides nor add to it.
[[maybe_unused]] const int own_cache = ::setenv("XDG_CACHE_HOME", GAITPAD_TEST_CACHE, 1);

}  // namespace

const char* source_folder() noexcept { return GAITPAD_SOURCE_DIR; }
const char* shared_data_folder() noexcept { return GAITPAD_SHARED_DATA; }

}  // namespace gaitpad
