// The files of one run: they appear in their folder together and complete, or not at all.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "gaitpad/bvh.h"
#include "gaitpad/gltf.h"
#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/stick.h"
#include "gaitpad/walk.h"

namespace gaitpad {

// Everything is written under temporary names in the same folder; publish() renames. Without it the
// temporaries vanish, and files of an earlier run stay as they were.
class OutputFiles {
 public:
  // Makes the folder where it is missing.
  static Result<OutputFiles> open(const std::string& folder);
  // A new file, empty so far; the stream lives as long as this object. What cannot be written to it
  // comes out of publish().
  Result<std::ostream*> add(const std::string& name);
  std::optional<Error> publish();
  // A file without a name in the same folder, to write and read while running; it is gone with its
  // stream, whatever happens.
  Result<std::fstream> scratch() const;

  OutputFiles(OutputFiles&&) noexcept = default;
  OutputFiles& operator=(OutputFiles&&) = delete;
  ~OutputFiles();

 private:
  struct File {
    std::string path, temporary;
    std::unique_ptr<std::ofstream> stream;
  };
  explicit OutputFiles(std::string folder) : folder_(std::move(folder)) {}

  std::string folder_;
  std::vector<File> files_;
};

// frames.csv: one row a tick, what a character did, in metres, seconds and radians of the world.

void append_frames_header(fmt::memory_buffer& out);
// The state after `tick`, which had `stick` and ran at rate_hz.
void append_frames_row(std::int64_t tick, int rate_hz, const Stick& stick, const WalkFrame& frame,
                       fmt::memory_buffer& out);

// What one character's walk leaves behind: pose.bvh (pose.glb), frames.csv and summary.json.

// `pose.bvh` for the first character, `pose-2.bvh` ... for further ones.
std::string numbered_name(const std::string& stem, const std::string& extension,
                          std::size_t walker);

struct ExportFormat {
  int rate_hz = 240;
  int fps = 240;           // poses a second, in every file of poses
  bool with_gltf = false;  // pose.glb beside pose.bvh
};

// Writes as the walk goes on. The walker and the files outlive it.
class WalkExport {
 public:
  static Result<WalkExport> open(OutputFiles& files, const Walker& walker, std::size_t index,
                                 const ExportFormat& format);
  // The walker after `tick`; ticks come in order, from 0.
  void write(std::int64_t tick, const Stick& stick);
  // The rest, the summary last. An error where a walk does not fit into a file's format.
  std::optional<Error> finish(const nlohmann::ordered_json& summary);

 private:
  WalkExport(const Walker& walker, const ExportFormat& format)
      : walker_(&walker), format_(format) {}

  const Walker* walker_;
  ExportFormat format_;
  std::ostream* frames_ = nullptr;
  std::ostream* summary_ = nullptr;
  std::unique_ptr<BvhWriter> poses_;
  std::unique_ptr<GltfWriter> gltf_;  // where asked for
  fmt::memory_buffer row_;
};

// The character's part of a summary: names of joints, lengths, steps.
nlohmann::ordered_json walker_summary(const Walker& walker);

// What a run comes to, for summary.json and for who reads it: replay's and a live session's are the
// same.

// The whole run's numbers and one character's. `damaged_lines`: of the trace, 0 for a live session.
nlohmann::ordered_json run_summary(const Simulation& simulation, const Walker& walker, int rate_hz,
                                   std::int64_t damaged_lines);

}  // namespace gaitpad
