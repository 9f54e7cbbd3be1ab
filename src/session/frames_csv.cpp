#include "session/frames_csv.h"

#include <iterator>
#include <string_view>

namespace gaitpad {
namespace {

constexpr std::string_view kHeader =
    "tick,time_s,stick_x,stick_y,stride_left_m,stride_right_m,speed_m_s,turn_rate_rad_s,heading_"
    "rad,"
    "root_x_m,root_y_m,root_z_m,stage,swing,"
    "left_heel_planted,left_toe_planted,right_heel_planted,right_toe_planted,"
    "left_heel_x_m,left_heel_y_m,left_heel_z_m,left_toe_x_m,left_toe_y_m,left_toe_z_m,"
    "right_heel_x_m,right_heel_y_m,right_heel_z_m,right_toe_x_m,right_toe_y_m,right_toe_z_m,"
    "left_ik_iterations,right_ik_iterations,left_ik_error_m,right_ik_error_m,"
    "left_heel_ground_m,left_toe_ground_m,right_heel_ground_m,right_toe_ground_m\n";

constexpr std::string_view kStageNames[] = {"idle", "flight", "roll"};

std::string_view swing_name(const WalkFrame& frame) {
  if (frame.stage == Stage::idle) return "none";
  return frame.swing == kLeftSide ? "left" : "right";
}

void append_number(double value, fmt::memory_buffer& out) {
  fmt::format_to(std::back_inserter(out), ",{:.9f}", value + 0.0);  // + 0.0: no "-0"
}

void append_place(const vec3& place_m, fmt::memory_buffer& out) {
  append_number(place_m.x, out);
  append_number(place_m.y, out);
  append_number(place_m.z, out);
}

}  // namespace

void append_frames_header(fmt::memory_buffer& out) {
  out.append(kHeader.data(), kHeader.data() + kHeader.size());
}

void append_frames_row(std::int64_t tick, int rate_hz, const Stick& stick, const WalkFrame& frame,
                       fmt::memory_buffer& out) {
  const auto end = std::back_inserter(out);
  fmt::format_to(end, "{}", tick);
  append_number(static_cast<double>(tick) / rate_hz, out);
  append_number(stick.left.x, out);
  append_number(stick.left.y, out);
  append_number(frame.stride_m[kLeftSide], out);
  append_number(frame.stride_m[kRightSide], out);
  append_number(frame.speed_m_s, out);
  append_number(frame.turn_rate_rad_s, out);
  append_number(frame.heading_rad, out);
  append_place(frame.pelvis_m, out);
  fmt::format_to(end, ",{},{}", kStageNames[static_cast<int>(frame.stage)], swing_name(frame));
  for (const Side side : {kLeftSide, kRightSide}) {
    fmt::format_to(end, ",{:d},{:d}", frame.heel_planted[side], frame.toe_planted[side]);
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    append_place(frame.heel_m[side], out);
    append_place(frame.toe_m[side], out);
  }
  fmt::format_to(end, ",{},{}", frame.ik_iterations[kLeftSide], frame.ik_iterations[kRightSide]);
  append_number(frame.ik_error_m[kLeftSide], out);
  append_number(frame.ik_error_m[kRightSide], out);
  for (const Side side : {kLeftSide, kRightSide}) {
    append_number(frame.heel_ground_m[side], out);
    append_number(frame.toe_ground_m[side], out);
  }
  out.push_back('\n');
}

}  // namespace gaitpad
