// What one character's walk leaves behind: pose.bvh (pose.glb), frames.csv and summary.json.
#pragma once
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>

#include "motion/bvh_writer.h"
#include "session/gltf_writer.h"
#include "session/output_files.h"
#include "session/simulation.h"

namespace gaitpad {

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

}  // namespace gaitpad
