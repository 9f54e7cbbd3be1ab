// Everything that a recording stores of its session, and the session that a recording makes.
#pragma once
#include <string>
#include <vector>

#include "files/input_files.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/trace.h"
#include "session/recording.h"

namespace gaitpad {

// `walk_files`: the files that simulation_config() has read, with every style that a command may
// name. `pad_files`: the files that load_pad_files() has read; the recording stores those with an
// entry for one of its pads. Files in the folders of configuration are named relative to their
// folder, others by their whole path.
RecordedSession recorded_session(const SessionSpec& spec, Pace pace,
                                 const std::vector<InputFile>& walk_files,
                                 const std::vector<InputFile>& pad_files,
                                 const PadOverrides& overrides);

// Completes `spec` with the recording's options and files, if it has files, where `spec` leaves
// them open. Their paths are below the recording's path (held_files()). Error: the recording's
// crowd is impossible.
Result<SessionSpec> with_recorded(const SessionSpec& spec, const Trace& trace);
// The recording's files for InputFiles, without the styles that were saved while it ran.
std::vector<InputFile> held_files(const Trace& trace);

// A file's path relative to the folder of configuration that holds it. Empty: it is in none of
// them, or the same name in an earlier folder hides it.
std::string name_in_folders(const std::string& path, const std::vector<std::string>& folders);

// A file on the disk that a replay depends on.
struct UsedFile {
  std::string path;
  std::uint64_t hash = 0;  // FNV-1a hash of the file's bytes
};
std::uint64_t bytes_hash(std::string_view bytes);
// The files, of those that were read, on which the replay depends: without styles that it does not
// name and without entries for other pads.
std::vector<UsedFile> used_files(const std::vector<const InputFile*>& read, const Trace& trace,
                                 const SimulationConfig& config, const PadOverrides& overrides);

// Names the user's styles that commands or zones of the recording name and that the replay did not
// read because no option asked for them: one sentence each.
std::vector<std::string> left_out_styles(const SessionSpec& spec, const Trace& trace,
                                         const SimulationConfig& config);

// Replaces the styles at the beginning of a tick, before its reports.
struct StyleChange {
  std::int64_t tick = 0;
  std::shared_ptr<const std::vector<Style>> styles;
};
// The changes by styles that were saved while the recording ran. `styles`: those at its start.
Result<std::vector<StyleChange>> style_changes(const Trace& trace, std::vector<Style> styles);

}  // namespace gaitpad
