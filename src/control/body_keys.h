// The part of a style that is above the hips: its tables in a file, its keys by name.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/toml_file.h"
#include "gaitpad/gait_params.h"

namespace gaitpad {

// `[arms]`, `[left_arm]`, `[right_arm]`, `[hands]`, `[left_hand]`, `[right_hand]`, `[spine]`,
// `[head]`: what stands in them over what `body` holds. Problems stay with the file.
void read_body(TomlTable& root, BodyParams& body);
// The tables that read_body() reads back; empty for plain values.
std::string body_text(const BodyParams& body);

struct BodyKey {
  std::string name;  // `arms.weight.elbow`
  double min = 0.0, max = 1.0;
};
// For both sides, for the left and for the right, spine and head; in the order of the tables above.
std::vector<BodyKey> body_keys();
// No heap. False where there is no such name or the value is out of its bounds or all weights of an
// arm or of the spine would be 0: `body` is then as it was.
bool set_body_value(BodyParams& body, std::string_view name, double value) noexcept;
// Where several stand for it and differ: the first one's.
std::optional<double> body_value(const BodyParams& body, std::string_view name) noexcept;

// All values part of the way from one to the other: share 0 .. 1.
BodyParams mixed(const BodyParams& from, const BodyParams& to, double share) noexcept;

}  // namespace gaitpad
