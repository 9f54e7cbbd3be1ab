// The effects of force feedback that programs have uploaded to a virtual pad, each with its number
// on the real pad behind it. The kernel numbers the effects of every device by itself.
#pragma once
#include <linux/input.h>

#include <array>
#include <cstdint>
#include <optional>

namespace gaitpad {

// Receives the effects: a real pad. Each call returns 0 or errno.
class EffectTarget {
 public:
  virtual ~EffectTarget() = default;
  // Uploads an effect. An id of -1 becomes the number of the new effect.
  virtual int upload(ff_effect& effect) noexcept = 0;
  virtual int erase(int id) noexcept = 0;
  // Sends an event of EV_FF. `code` is an effect, which starts `value` times or stops (0), or
  // FF_GAIN.
  virtual int send(std::uint16_t code, std::int32_t value) noexcept = 0;
};

class EffectTable {
 public:
  // Sets the real pad: all effects are uploaded to it, and none runs. Null: the pad is gone; the
  // effects are kept for the next one.
  void set_target(EffectTarget* target) noexcept;

  // Handle a program's requests to the virtual pad, with the program's numbers of effects. upload()
  // and erase() return what EffectTarget's functions return.
  int upload(const ff_effect& effect) noexcept;
  int erase(int id) noexcept;
  void send(std::uint16_t code, std::int32_t value) noexcept;

 private:
  struct Entry {
    ff_effect effect{};     // the effect as it was uploaded last, with the program's number
    int id_on_target = -1;  // the effect's number on the real pad; -1: it is not there
  };
  int upload_to_target(Entry& entry) noexcept;

  // The effects by the program's numbers, which are below FF_GAIN, because an event's code holds
  // either.
  std::array<std::optional<Entry>, FF_GAIN> entries_;
  std::optional<std::int32_t> gain_;
  EffectTarget* target_ = nullptr;
};

}  // namespace gaitpad
