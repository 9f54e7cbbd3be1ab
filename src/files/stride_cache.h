// Families of strides that were solved once: of the built-in walk when gaitpad was built, of other
// motions when they were first loaded, kept in files. Solving takes some tenths of a second,
// reading less than a millisecond, and both give the same bits.
#pragma once
#include <string>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/result.h"

namespace gaitpad {

// $XDG_CACHE_HOME/gaitpad/strides, else $HOME/.cache/gaitpad/strides. Empty, which means no cache,
// where neither is set or where GAITPAD_CACHE is `off`.
std::string stride_cache_folder();

// with_clean_strides() by way of the built-in strides and the files in `folder`, which may be
// empty, missing, read-only, full or damaged: then the strides are solved, and that they could not
// be kept is no error. A file is used only if it is whole and was made from the same numbers by the
// same sources. At most 64 files are kept; the oldest go first. Several processes may share a
// folder, and it may be deleted at any time.
Result<GaitCycle> cached_clean_strides(GaitCycle cycle, const std::string& folder);

}  // namespace gaitpad
