// What one character's walk leaves behind: pose.bvh, frames.csv and summary.json.
#pragma once
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "motion/bvh_writer.h"
#include "session/output_files.h"
#include "session/simulation.h"

namespace gaitpad {

// `pose.bvh` for the first character, `pose-2.bvh` ... for further ones.
std::string numbered_name(const std::string& stem, const std::string& extension,
                          std::size_t walker);

// Writes as the walk goes on. The walker and the files outlive it.
class WalkExport {
 public:
  static Result<WalkExport> open(OutputFiles& files, const Walker& walker, std::size_t index,
                                 int rate_hz, int fps);
  // The walker after `tick`; ticks come in order, from 0.
  void write(std::int64_t tick, const Stick& stick);
  // The rest, the summary last.
  void finish(const nlohmann::ordered_json& summary);

 private:
  WalkExport(const Walker& walker, int rate_hz, int fps)
      : walker_(&walker), rate_hz_(rate_hz), fps_(fps) {}

  const Walker* walker_;
  int rate_hz_, fps_;
  std::ostream* frames_ = nullptr;
  std::ostream* summary_ = nullptr;
  std::unique_ptr<BvhWriter> poses_;
  fmt::memory_buffer row_;
};

// The character's part of a summary: names of joints, lengths, steps.
nlohmann::ordered_json walker_summary(const Walker& walker);

}  // namespace gaitpad
