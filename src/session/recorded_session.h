// What a session is made of, as its recording holds it, and the session of a recording.
#pragma once
#include <string>
#include <vector>

#include "base/files.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/trace.h"
#include "session/recording.h"

namespace gaitpad {

// `walk_files`: what simulation_config() has read; every style among it may be named by a command.
// `pad_files`: what load_pad_files() has read; a recording holds those whose entries its pads
// match. The names of files of the folders of configuration begin at these folders; other names are
// whole paths.
RecordedSession recorded_session(const SessionSpec& spec, Pace pace,
                                 const std::vector<InputFile>& walk_files,
                                 const std::vector<InputFile>& pad_files,
                                 const PadOverrides& overrides);

// The session that `spec` asks for: what it leaves open is as the recording says, if that holds
// files. They are found below the recording's path (held_files()).
// Error: a crowd that there cannot be.
Result<SessionSpec> with_recorded(const SessionSpec& spec, const Trace& trace);
// For InputFiles: without the styles that were saved while the recording ran.
std::vector<InputFile> held_files(const Trace& trace);

// The path of a file in the folders of configuration, counted from its folder. Empty: it is not in
// one, or a file of an earlier folder hides it.
std::string name_in_folders(const std::string& path, const std::vector<std::string>& folders);

// A file on the disk that a replay depends on.
struct UsedFile {
  std::string path;
  std::uint64_t hash = 0;  // FNV-1a of its bytes
};
std::uint64_t bytes_hash(std::string_view bytes);
// Of the files that were read for a replay. Styles and entries for pads that it has no use for are
// left out.
std::vector<UsedFile> used_files(const std::vector<InputFile>& read, const Trace& trace,
                                 const SimulationConfig& config, const PadOverrides& overrides);

// Styles of the user's folder that commands or zones name and that the replay did not read, because
// nobody asked for them: a sentence each.
std::vector<std::string> left_out_styles(const SessionSpec& spec, const Trace& trace,
                                         const SimulationConfig& config);

// From a tick on, before its reports, the styles are these.
struct StyleChange {
  std::int64_t tick = 0;
  std::shared_ptr<const std::vector<Style>> styles;
};
// Of the styles that were saved while the recording ran. `styles`: those at its start.
Result<std::vector<StyleChange>> style_changes(const Trace& trace, std::vector<Style> styles);

}  // namespace gaitpad
