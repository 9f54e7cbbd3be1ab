#include "session/set_up.h"

#include <string>
#include <utility>

#include "session/recorded_session.h"

namespace gaitpad {
namespace {

// Everything that load_pad_files() depends on.
struct PadKey {
  std::vector<std::string> config_folders;
  std::string map, calibration, recording;
  bool operator==(const PadKey&) const = default;
};

// Everything that the walk depends on. The recording's own path is none of it.
struct WalkKey {
  SessionSpec::Walk walk;
  int rate_hz = 0;
  std::vector<std::string> config_folders;
  bool user_styles = false, is_recorded = false;
  std::vector<std::string> options;  // those of the recording
  std::vector<InputFile> held;       // files of the recording
  bool operator==(const WalkKey&) const = default;
};

WalkKey key_of(const SessionSpec& asked, const SessionSpec& spec, const Trace& trace, int rate_hz) {
  WalkKey key{asked.walk, rate_hz, spec.config_folders, spec.replay.user_styles, false, {}, {}};
  key.walk.pace = spec.walk.pace;
  if (spec.recording.empty()) return key;
  key.is_recorded = true;
  key.options = trace.options;
  key.held = held_files(trace);
  return key;
}

}  // namespace

struct SetUps::Pads {
  PadKey key;
  PadSetUp set_up;
};
struct SetUps::Walk {
  WalkKey key;
  std::string recording;
  WalkSetUp set_up;

  // Sentences of a set-up name the recording's path, so a set-up with some is for that path alone.
  bool is_for(const WalkKey& wanted, const std::string& wanted_recording) const {
    const bool has_sentences = !set_up.start || !set_up.config.remarks.empty();
    return key == wanted && (!has_sentences || recording == wanted_recording);
  }
};

SetUps::SetUps() = default;
SetUps::~SetUps() = default;

Result<const PadSetUp*> SetUps::pads(const SessionSpec& spec) {
  PadKey key{spec.config_folders, spec.pad.map, spec.pad.calibration, spec.recording};
  // The pad files that a recording holds are not compared.
  const bool is_kept = pads_ && spec.recording.empty() && pads_->key == key;
  if (!is_kept) {
    const InputFiles inputs;
    auto files = load_pad_files(spec);
    if (!files) return files.error();
    pads_ = std::make_unique<Pads>(Pads{std::move(key), {std::move(*files), inputs.read()}});
  }
  return &pads_->set_up;
}

Result<const WalkSetUp*> SetUps::walk(const SessionSpec& asked, const SessionSpec& spec,
                                      const Trace& trace, int rate_hz) {
  WalkKey key = key_of(asked, spec, trace, rate_hz);
  if (!walk_ || !walk_->is_for(key, spec.recording)) {
    walk_.reset();
    const InputFiles inputs;
    auto config = simulation_config(spec, rate_hz);
    if (!config) return config.error();
    auto start = Simulation::create(*config);
    walk_ = std::make_unique<Walk>(Walk{
        std::move(key), spec.recording, {std::move(*config), std::move(start), inputs.read()}});
  }
  return &walk_->set_up;
}

}  // namespace gaitpad
