// Output files of a run: they appear in their folder together and complete, or not at all.
#pragma once
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
#include "gaitpad/summary.h"
#include "gaitpad/walk.h"
#include "system/whole_file.h"

namespace gaitpad {

// A folder, made with its parents if they are missing. At the end those that it made and that are
// empty are removed.
class OutputFolder {
 public:
  static Result<OutputFolder> open(const std::string& folder);
  OutputFolder(OutputFolder&&) noexcept = default;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();
  std::string path_of(const std::string& name) const;

 private:
  explicit OutputFolder(std::string folder) : folder_(std::move(folder)) {}
  std::string folder_;
  std::vector<std::string> made_;  // the innermost first
};

// Files of one run. publish() names them; without it the files of an earlier run stay.
class OutputFiles {
 public:
  // Makes the folder if it is missing. Without publish() it is removed again.
  static Result<OutputFiles> open(const std::string& folder);
  // Adds a new, empty file. The stream lives as long as this object. publish() reports its write
  // errors.
  Result<std::ostream*> add(const std::string& name);
  std::optional<Error> publish();
  std::string path_of(const std::string& name) const { return folder_.path_of(name); }
  // A nameless temporary file in the same folder. It vanishes with its stream, even if the program
  // is killed.
  Result<std::fstream> scratch() const;

 private:
  struct File {
    NewFile file;
    std::unique_ptr<char[]> buffer;  // the stream's
    std::unique_ptr<std::ofstream> stream;
  };
  explicit OutputFiles(OutputFolder folder) : folder_(std::move(folder)) {}

  OutputFolder folder_;  // before the files: they leave it first
  std::vector<File> files_;
};

// frames.csv: one row for each tick with the state of the character, in metres, seconds and
// radians, world frame.
void append_frames_header(std::string& out);
// The row of `tick`: its stick and the state after it.
void append_frames_row(std::int64_t tick, int rate_hz, const Stick& stick, const WalkFrame& frame,
                       std::string& out);

// `pose.bvh` for the first character, `pose-2.bvh` and so on for the others.
std::string numbered_name(const std::string& stem, const std::string& extension,
                          std::size_t walker);

struct ExportFormat {
  int rate_hz = 240;
  int fps = 240;           // poses in a second, in every file of poses
  bool with_gltf = false;  // writes pose.glb beside pose.bvh
};

// Writes pose.bvh, frames.csv, summary.json and, if asked for, pose.glb of one character while it
// walks. The walker and the files must outlive it.
class WalkExport {
 public:
  static Result<WalkExport> open(OutputFiles& files, const Walker& walker, std::size_t index,
                                 const ExportFormat& format);
  // Writes the walker's state after `tick`. Ticks come in order, from 0.
  void write(std::int64_t tick, const Stick& stick);
  // Writes the rest, and the summary last. Error: the walk does not fit into a file format.
  std::optional<Error> finish(const nlohmann::ordered_json& summary);

 private:
  WalkExport(const Walker& walker, const ExportFormat& format)
      : walker_(&walker), format_(format) {}

  const Walker* walker_;
  ExportFormat format_;
  std::ostream* frames_ = nullptr;
  std::ostream* summary_ = nullptr;
  std::unique_ptr<BvhWriter> poses_;
  std::unique_ptr<GltfWriter> gltf_;  // null: the file was not asked for
  std::string gltf_path_;
  std::string row_;
};

// summary.json of one character: the run's numbers, then its own. The order of the keys is part of
// the interface; keys end with their units.
nlohmann::ordered_json summary_json(const RunSummary& run, std::size_t walker);
nlohmann::ordered_json summary_json(const RunSummary& run, const WalkerSummary& walker);

// Presents a follower as a walker, so that the same files can be written.
class ExportedFollower {
 public:
  ExportedFollower(const Simulation& simulation, int member);
  // Copies the follower's state after a tick.
  void follow(const Simulation& simulation) noexcept;
  const Walker& walker() const noexcept { return *walker_; }
  WalkerSummary summary(const Simulation& simulation) const;

 private:
  int member_;
  std::unique_ptr<Walker> walker_;  // on the heap, because an export keeps its address
};

}  // namespace gaitpad
