// The folders of the repository and of the real data, for tests. The paths stand in folders.cpp
// alone, so that a compiler cache serves every checkout with the same objects.
#pragma once
#include <string>

namespace gaitpad {

const char* source_folder() noexcept;
const char* shared_data_folder() noexcept;
inline const std::string kSourceFolder = source_folder();     // the root of the repository
inline const std::string kSharedData = shared_data_folder();  // need not exist

}  // namespace gaitpad
