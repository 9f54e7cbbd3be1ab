// Solved families of strides. The built-in walk's is solved when gaitpad is built; other motions'
// are solved when first loaded and then kept in files. Solving takes some tenths of a second and
// reading less than a millisecond; both give the same bits.
#pragma once
#include <string>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/result.h"

namespace gaitpad {

// $XDG_CACHE_HOME/gaitpad/strides, otherwise $HOME/.cache/gaitpad/strides. Empty (no cache) if
// neither is set or GAITPAD_CACHE is `off`.
std::string stride_cache_folder();

// with_clean_strides() that first looks for the solution in the built-in strides and in the files
// of `folder`. If `folder` is empty, missing, read-only, full or damaged, the strides are solved,
// and a failure to keep them is no error. A file is used only if it is complete and was made from
// the same numbers by the same sources. At most 64 files are kept; the oldest are deleted first.
// Several processes may share a folder, and it may be deleted at any time.
Result<GaitCycle> cached_clean_strides(GaitCycle cycle, const std::string& folder);

}  // namespace gaitpad
