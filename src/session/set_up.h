// The set-up of a replay before its first tick: the files about pads, and the walk with its models
// and strides. Several recordings share it.
#pragma once
#include <memory>
#include <vector>

#include "files/input_files.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"

namespace gaitpad {

struct PadSetUp {
  PadFiles files;
  std::vector<InputFile> read;  // files that were read from the disk
};
struct WalkSetUp {
  SimulationConfig config;      // without pads
  Result<Simulation> start;     // without pads; an error of Simulation::create()
  std::vector<InputFile> read;  // files that were read from the disk
};

// Keeps the set-up of the latest recording for the next one, which gets it if it is made of the
// same options and files. Files on the disk that change meanwhile are not read again. One thread
// uses it at a time.
class SetUps {
 public:
  SetUps();
  ~SetUps();

  // Both results last until the next call. `spec` is completed by with_recorded(), and the
  // recording's files are open (InputFiles).
  Result<const PadSetUp*> pads(const SessionSpec& spec);
  // `asked`: the session before the recording `trace` completed it. `spec.walk.pace` is known.
  Result<const WalkSetUp*> walk(const SessionSpec& asked, const SessionSpec& spec,
                                const Trace& trace, int rate_hz);

 private:
  struct Pads;
  struct Walk;
  std::unique_ptr<Pads> pads_;
  std::unique_ptr<Walk> walk_;
};

}  // namespace gaitpad
