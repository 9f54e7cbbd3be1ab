#include "tests/folders.h"

namespace gaitpad {

const char* source_folder() noexcept { return GAITPAD_SOURCE_DIR; }
const char* shared_data_folder() noexcept { return GAITPAD_SHARED_DATA; }

}  // namespace gaitpad
