// Finds which field of a pad is which control, for the terminal and the window: asks for one
// control after the other, and watches what the user moves.
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/decode.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Call its functions from one thread.
class MappingDialog {
 public:
  static Result<std::unique_ptr<MappingDialog>> start(const PadFiles& files,
                                                      const PadSelector& selector);

  // Takes in the reports that have come; if there are none, waits for one, at most `timeout`.
  void look(std::chrono::milliseconds timeout);

  bool has_pad() const noexcept { return device_ != kNoDevice; }
  // The pad, once there is one.
  const DeviceInfo& pad() const noexcept { return stream_->device(device_).info; }
  std::int64_t plugged() const noexcept { return stream_->counts().plugged; }
  // True if the source is a recording and all of it was read.
  bool has_ended() const noexcept { return has_ended_; }
  std::vector<std::string> take_remarks() { return stream_->take_remarks(); }

  // The number of the present step, from 0; step_count(): every control was asked for.
  std::size_t step() const noexcept { return step_; }
  static std::size_t step_count() noexcept;
  bool is_done() const noexcept { return step_ == step_count(); }
  // The request: "push the left stick forward"; null while everything is to be released first.
  const char* prompt() const noexcept;
  void skip() noexcept;  // Goes on without the present control, which the pad does not have.

  std::size_t found() const noexcept { return found_count_; }
  // The source that was found for the last control: "Rz (0001:0035), reversed"; empty: none was
  // found yet.
  const std::string& last_found() const noexcept { return last_found_; }
  bool has_left_stick() const noexcept;
  // Stores the mapping as a line of SDL's in that file, in place of an older line of the pad, and
  // returns the line. Empty: user_mapping_file().
  Result<std::string> keep(const std::string& file) const;

 private:
  struct Step;
  static const std::vector<Step>& steps() noexcept;

  // An input field of the pad, as it is and as it was when the step began: -1 to 1 over its logical
  // range.
  struct PadField {
    const Field* field;
    std::uint32_t occurrence;  // number of the field among those of its report with the same usage
    double value = 0.0, rest = 0.0;
    bool is_known = false, is_taken = false;

    bool is_button() const noexcept { return field->logical_max - field->logical_min == 1; }
    double moved() const noexcept { return is_known ? value - rest : 0.0; }
  };

  MappingDialog() = default;
  void take_report(const Report& report);
  void take_values(const Report& report);
  void prompt_when_still();
  PadField* moved_field(const Step& step);
  void take(const Step& step, PadField& field);
  bool is_at_rest() const;

  std::unique_ptr<PadStream> stream_;
  std::uint16_t device_ = kNoDevice;
  std::vector<PadField> fields_;
  PadOverride found_;
  std::size_t step_ = 0, found_count_ = 0;
  bool is_prompted_ = false, is_held_ = false, has_ended_ = false;
  std::int64_t still_since_ns_ = 0;
  std::string last_found_;
};

}  // namespace gaitpad
