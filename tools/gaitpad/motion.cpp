// gaitpad motion: prints the contents of a motion file.
#include "gaitpad/motion.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "gaitpad/config_files.h"
#include "gaitpad/flight.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/limbs.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/walk_model.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

struct MotionArguments {
  std::string file;
  bool as_json = false;
  LoadOptions load;
};

// Joint names as in an export: End Sites only if they serve as toes.
std::vector<std::string> joint_names(const Motion& motion) {
  std::vector<std::string> names;
  const auto& joints = motion.skeleton.joints;
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    const bool is_toe = j == motion.legs[0].toe || j == motion.legs[1].toe;
    if (!joints[j].is_end_site || is_toe) names.push_back(joints[j].name);
  }
  return names;
}

ordered_json leg_json(const Motion& motion, Side side) {
  const LegJoints& leg = motion.legs[side];
  const auto name = [&](int joint) { return motion.skeleton.joints[joint].name; };
  return {{"hip", name(leg.hip)},
          {"knee", name(leg.knee)},
          {"ankle", name(leg.ankle)},
          {"toe", name(leg.toe)},
          {"length_m", leg_length_m(motion, leg)}};
}

ordered_json flight_json(const std::optional<Swing>& swing) {
  if (!swing) return nullptr;
  return {{"heel_off_frame", swing->heel_off},
          {"lift_frame", swing->lift},
          {"peak_frame", swing->peak},
          {"land_frame", swing->land}};
}

ordered_json paper_json(const std::optional<Swing>& swing) {
  if (!swing) return nullptr;
  return {{"lift_frame", swing->lift}, {"peak_frame", swing->peak}, {"land_frame", swing->land}};
}

// The stride that the walk uses, as JSON.
ordered_json gait_json(const Result<GaitCycle>& cycle) {
  if (!cycle) return nullptr;
  const auto stick = own_stick(*cycle);
  return {{"first_frame", cycle->first_frame},
          {"frames", cycle->frames},
          {"stride_s", cycle->duration_s},
          {"step_left_m", cycle->step_m[kLeftSide]},
          {"step_right_m", cycle->step_m[kRightSide]},
          {"speed_m_s", cycle->stride_m / cycle->duration_s},
          {"turn_rad", cycle->turn_rad},
          {"own_stick", stick ? ordered_json(*stick) : ordered_json(nullptr)}};
}

ordered_json motion_json(const Motion& motion, const Result<GaitCycle>& cycle) {
  ordered_json out;
  out["metres_per_unit"] = motion.metres_per_unit;
  out["frame_rate_hz"] = 1.0 / motion.frame_time_s;
  out["frames"] = motion.frames.size();
  out["joints"] = joint_names(motion);
  // True if the motion walks on the spot: then the feet have no flight.
  const bool stays = !cycle && cycle.error().message.find("walks on the spot") != std::string::npos;
  for (const Side side : {kLeftSide, kRightSide}) {
    const char* name = kSideNames[side];
    out["legs"][name] = leg_json(motion, side);
    out["flight"][name] = stays ? nullptr : flight_json(robust_flight(motion, side));
    out["flight_paper"][name] = stays ? nullptr : paper_json(paper_flight(motion, side));
  }
  out["gait"] = gait_json(cycle);
  if (!cycle) out["reason"] = cycle.error().message;
  return out;
}

// A frame of the file. In a loop a swing may continue in the next round.
std::string frame_text(int frame, std::size_t frames) {
  const int last = static_cast<int>(frames) - 1;
  return frame <= last ? fmt::format("{}", frame)
                       : fmt::format("{} of the next round", frame - last);
}

std::string flight_text(const std::optional<Swing>& swing, std::size_t frames) {
  if (!swing) return "none found";
  return fmt::format("lift {}, peak {}, land {}", frame_text(swing->lift, frames),
                     frame_text(swing->peak, frames), frame_text(swing->land, frames));
}

// The swing that begins in the walk's stride; without a stride the most typical swing.
std::optional<Swing> walked_flight(const Motion& motion, Side side,
                                   const Result<GaitCycle>& cycle) {
  if (!cycle) return robust_flight(motion, side);
  const double first = cycle->first_frame, end = first + cycle->frames;
  for (const Swing& swing : swings(motion, side))
    if (swing.lift >= first && swing.lift < end) return swing;
  return robust_flight(motion, side);
}

std::string stick_text(const GaitCycle& cycle) {
  const auto stick = own_stick(cycle);
  if (!stick) return "an adult's pace is slower at full stick";
  if (cycle.pace == Pace::own) return fmt::format("stick {} walks so", *stick);
  return fmt::format("stick {:.3f} walks as fast, with an adult's steps", *stick);
}

std::string gait_text(const Result<GaitCycle>& cycle) {
  if (!cycle) return "none, " + cycle.error().message;
  // Adding 0.0 turns -0 into 0, so that a turn that rounds to 0 has no sign.
  const double turn_deg = std::round(10.0 * cycle->turn_rad / kDegree) / 10.0 + 0.0;
  return fmt::format(
      "{:.1f} frames from frame {:.1f} on: {:.2f} s, steps {:.2f} m left and {:.2f} m right, "
      "{:.2f} m/s, turn {:.1f} degrees; {}",
      cycle->frames, cycle->first_frame, cycle->duration_s, cycle->step_m[kLeftSide],
      cycle->step_m[kRightSide], cycle->stride_m / cycle->duration_s, turn_deg, stick_text(*cycle));
}

void print_motion(const Motion& motion, const Result<GaitCycle>& cycle) {
  const double rate_hz = 1.0 / motion.frame_time_s;
  const std::size_t frames = motion.frames.size();
  say("motion        {}\n", printable(motion.name));
  say("units         1 unit = {:.6g} m\n", motion.metres_per_unit);
  say("rate          {:.6g} Hz, {} frames, {:.2f} s\n", rate_hz, frames,
      static_cast<double>(frames) * motion.frame_time_s);
  say("joints        {} (pelvis {})\n", joint_names(motion).size(),
      printable(motion.skeleton.joints[motion.pelvis].name));
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegJoints& leg = motion.legs[side];
    const auto name = [&](int joint) { return printable(motion.skeleton.joints[joint].name); };
    say("{:<5} leg     {} - {} - {} - {}, thigh + shank {:.3f} m\n", kSideNames[side],
        name(leg.hip), name(leg.knee), name(leg.ankle), name(leg.toe), leg_length_m(motion, leg));
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    const auto flight = walked_flight(motion, side, cycle);
    const std::string heel_off =
        flight ? fmt::format("heel off {}, ", frame_text(flight->heel_off, frames)) : "";
    say("{:<5} flight  {}{}; by the paper's rule {}\n", kSideNames[side], heel_off,
        flight_text(flight, frames), flight_text(paper_flight(motion, side), frames));
  }
  say("gait          {}\n", printable(gait_text(cycle)));
}

Result<Motion> chosen_motion(const MotionArguments& arguments) {
  if (arguments.file == "procedural") return procedural_motion();
  const auto path = motion_path(config_folders(), arguments.file);
  if (!path) return path.error();
  return load_motion_source(*path, arguments.load);
}

int run_motion(const MotionArguments& arguments) {
  const auto motion = chosen_motion(arguments);
  if (!motion) return fail("motion", motion.error().message);
  const Result<GaitCycle> cycle =
      arguments.file == "procedural" ? procedural_gait() : gait_cycle(*motion);
  if (!arguments.as_json) {
    print_motion(*motion, cycle);
    return 0;
  }
  print_json(motion_json(*motion, cycle));
  return 0;
}

void add_leg_options(CLI::App& command, LegNames& leg, const std::string& side) {
  command.add_option("--" + side + "-hip", leg.hip, "joint at the top of the " + side + " thigh");
  command.add_option("--" + side + "-knee", leg.knee, "joint at the top of the " + side + " shank");
  command.add_option("--" + side + "-ankle", leg.ankle,
                     "joint at the top of the " + side + " foot");
  command.add_option("--" + side + "-toe", leg.toe,
                     "joint or End Site (NAME_End) of the " + side + " toes");
}

}  // namespace

void add_motion(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("motion",
                                         "shows a motion file's units, rate, joints, legs and "
                                         "stride, and when each foot is in flight");
  const auto arguments = std::make_shared<MotionArguments>();
  command
      ->add_option("FILE", arguments->file,
                   "motion (.bvh, .amc with its .asf, .asf, .toml), a NAME of config/motions, or "
                   "`procedural`")
      ->required();
  command->add_flag("--json", arguments->as_json, "print one JSON object");
  command
      ->add_option("--metres-per-unit", arguments->load.metres_per_unit,
                   "length of the file's unit (default: found from the legs' length)")
      ->check(CLI::Range(1e-6, 1e3));
  command->add_option("--skeleton", arguments->load.skeleton,
                      "the .asf file of an .amc file (default: found beside it by its name)");
  command
      ->add_option("--frame-rate", arguments->load.frame_rate_hz,
                   "frames a second (default: the file's; 120 for .amc, which does not say)")
      ->check(CLI::Range(1.0, 1e4));
  for (int s = 0; s < 2; ++s) add_leg_options(*command, arguments->load.legs[s], kSideNames[s]);
  command->callback([arguments, &status] { status = run_motion(*arguments); });
}

}  // namespace gaitpad
