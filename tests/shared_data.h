// Recordings of pads and captured motions, which stay outside the repository.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/folders.h"

namespace gaitpad {

inline const std::string kPadRecordings = kSharedData + "/hid/",
                         kCapturedMotions = kSharedData + "/mocap/";

// Skips the test if the folder is not there.
#define GAITPAD_NEEDS(folder) \
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there"

// Paths of a folder's files with this ending, ordered by name; none if there is no folder.
inline std::vector<std::string> files_in(const std::string& folder, const std::string& ending) {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ending) paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace gaitpad
