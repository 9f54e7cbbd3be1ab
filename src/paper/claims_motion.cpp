// Assertions 1-5: extraction of the foot's flight from the motion data. `paper` follows the rule
// literally; `robust` uses the last low before the peak, and lift and landing by speed. Assertions
// 6 and 29: the same motion on other legs.

#include <fmt/format.h>

#include <algorithm>

#include "gaitpad/flight.h"
#include "paper/claims.h"
#include "paper/flight_rules.h"
#include "paper/study.h"

namespace gaitpad {
namespace {

constexpr const char* kSection = "3.2, figure 2";
constexpr int kSamples = 120;                // samples of a stride, as in the derivation of the
                                             // bounds
constexpr double kFrame = 100.0 / kSamples;  // length of a sample in percent of the stride
constexpr const char* kNotAdult = "this number was derived for the built-in adult's curve alone";

double percent(int index) { return 100.0 * index / kSamples; }
Bound near_frame(double at_percent) {
  constexpr double kRounding = 0.05;  // half a unit of the bounds' one decimal
  return within(at_percent - kFrame - kRounding, at_percent + kFrame + kRounding);
}
FlightRule rule_of(IkMode mode) { return {true, mode == IkMode::robust}; }
constexpr const char* kLastNote = "last low before the peak";
constexpr const char* kNoTargets = "no three targets in this motion's stride";

struct Wanted {
  FootPoint point;
  const char* name;
  std::array<double, 3> percent;  // phases in percent of the stride; 0: not stated
};
constexpr std::array<Wanted, 2> kWanted = {Wanted{FootPoint::ankle, "ankle", {44.2, 71.7, 94.2}},
                                           Wanted{FootPoint::heel, "heel", {0.0, 70.8, 95.0}}};

// Claim 1: the phases of the targets.
void target_claims(const PaperSource& source, const Wanted& wanted, IkMode mode, ClaimList& list) {
  const auto heights = stride_heights(source.cycle, kRightSide, wanted.point, kSamples);
  const FlightTargets t =
      flight_targets(heights, rule_of(mode)).value_or(FlightTargets{-1, -1, -1});
  const std::array<int, 3> at = {t.lift, t.peak, t.land};
  const std::array<const char*, 3> what = {"first", "second", "third"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (wanted.percent[i] == 0.0) continue;
    const std::string name =
        fmt::format("1 {} target of the {}'s height, % of the stride", what[i], wanted.name);
    const Bound bound = near_frame(wanted.percent[i]);
    if (source.is_adult) {
      list.add(name, percent(at[i] < 0 ? at[i] : at[i] % kSamples), bound,
               mode == IkMode::robust ? kLastNote : "the first low there is");
    } else {
      list.add_untested(name, bound, kNotAdult);
    }
  }
}

// Claim 1: the bands that the targets lie in.
void band_claims(const PaperSource& source, IkMode mode, ClaimList& list) {
  const auto heights = stride_heights(source.cycle, kRightSide, FootPoint::ankle, kSamples);
  const auto targets = flight_targets(heights, rule_of(mode));
  const auto [low, high] = std::ranges::minmax(heights);
  const auto share = [&heights, low = low, high = high](int i) {
    return 100.0 * (heights[static_cast<std::size_t>(i)] - low) / (high - low);
  };
  const char* peak = "1 peak below the greatest height, % of the range";
  const char* ends = "1 ends of the flight above the least height, % of the range";
  const Bound none = at_most(1e-9), band = at_most(100.0 * kFlightBand);
  if (!targets) {
    list.add_untested(peak, none, kNoTargets);
    list.add_untested(ends, band, kNoTargets);
    return;
  }
  list.add(peak, 100.0 - share(targets->peak), none);
  list.add(ends, std::max(share(targets->lift), share(targets->land)), band);
}

// Claim 1: both feet, in frames of the file.
void file_claims(const PaperSource& source, IkMode mode, ClaimList& list) {
  int found = 0;
  std::string text;
  for (const Side side : {kLeftSide, kRightSide}) {
    const auto swing = mode == IkMode::paper ? paper_flight(source.frames, side)
                                             : robust_flight(source.frames, side);
    found += swing.has_value();
    text += std::string(side == kLeftSide ? "left " : ", right ") +
            (swing ? fmt::format("{} / {} / {}", swing->lift, swing->peak, swing->land) : "none");
  }
  list.add("1 feet whose flight is found in the file's frames", found, equal_to(2),
           "frames: " + text +
               (mode == IkMode::paper ? "; the literal rule needs a gradient change within 10 % of "
                                        "the lowest height on both sides, which a clip that begins "
                                        "or ends in a flight or stands unevenly need not have"
                                      : ""));
}

double apart_percent(const FlightTargets& a, const FlightTargets& b) {
  return percent(
      std::max({std::abs(a.lift - b.lift), std::abs(a.peak - b.peak), std::abs(a.land - b.land)}));
}

// Claims 2 and 3: the purpose of the 10 % bands.
void threshold_claims(const PaperSource& source, IkMode mode, ClaimList& list) {
  const auto heights = stride_heights(source.cycle, kRightSide, FootPoint::ankle, kSamples);
  const FlightRule rule = rule_of(mode);
  const auto on = flight_targets(heights, rule), off = flight_targets(heights, {false, false});
  const std::string name = "2 targets without the 10 % bands off those with them, % of the stride";
  if (!on || !off) {
    list.add_untested(name, more_than(kFrame), kNoTargets);
  } else if (*on == *off) {
    list.add_untested(name, more_than(kFrame), "no blip in this motion's stride");
  } else {
    list.add(name, apart_percent(*on, *off), more_than(kFrame),
             fmt::format("without: {:.1f} / {:.1f} / {:.1f}; prototype 8.3 / 9.2 / 44.2",
                         percent(off->lift), percent(off->peak), percent(off->land)));
  }
  for (const double blip_m : {0.0, 0.003}) {
    const auto curve = blip_curve(blip_m);
    const auto with = flight_targets(curve, rule), without = flight_targets(curve, {false, false});
    const char* kind = blip_m > 0.0 ? "a rise of 3 mm" : "a stand-still";
    list.add(fmt::format("3 third target of a curve with {} near frame 25, frame", kind),
             with ? with->land : kNoNumber, equal_to(40));
    if (blip_m > 0.0) {
      list.add("3 third target of that curve without the bands, frame",
               without ? without->land : kNoNumber, within(kBlipFrame - 2, kBlipFrame + 2),
               "the blip is taken for the landing: what the bands are there for");
    }
  }
}

// Claim 4: which low and which point of the foot the paper means.
void ambiguity_claims(const PaperSource& source, IkMode mode, ClaimList& list) {
  auto heights = stride_heights(source.cycle, kRightSide, FootPoint::ankle, kSamples);
  add_standing_jitter(heights, kSamples);
  const auto targets = flight_targets(heights, rule_of(mode));
  const double first = targets ? percent(targets->lift) : kNoNumber;
  if (mode == IkMode::paper) {
    list.add("4 first target on a standing foot that jitters by 4 mm, % of the stride", first,
             less_than(20.0),
             "\"the first target\" read as the first low: all of the stance is "
             "taken into the flight; prototype 5.8");
  } else {
    list.add("4 first target on a standing foot that jitters by 4 mm, % of the stride", first,
             within(35.0, 60.0), std::string(kLastNote) + "; prototype 44.2");
  }
  const auto toe = flight_targets(
      stride_heights(source.cycle, kRightSide, FootPoint::toe_tip, kSamples), rule_of(mode));
  const std::string name = "4 second target of the toe tip's height, % of the stride";
  if (source.is_adult) {
    list.add(name, toe ? percent(toe->peak) : kNoNumber, more_than(90.0),
             "late swing lifts the toe highest, so its height is no foot height; prototype 100.8");
  } else {
    list.add_untested(name, more_than(90.0), kNotAdult);
  }
}

// Claim 5: no result instead of an incomplete one, and the same result for every beginning of the
// clip.
void completeness_claims(const PaperSource& source, IkMode mode, ClaimList& list) {
  auto heights = stride_heights(source.cycle, kRightSide, FootPoint::ankle, kSamples);
  const auto whole = flight_targets(heights, rule_of(mode));
  if (!whole) {
    list.add_untested("5 targets in a curve that ends at its peak", equal_to(0), kNoTargets);
    return;
  }
  const std::vector<double> cut(heights.begin(), heights.begin() + whole->peak + 2);
  list.add("5 targets in a curve that ends at its peak", flight_targets(cut, rule_of(mode)) ? 3 : 0,
           equal_to(0));
  double worst = 0.0;
  for (const int shift : {10, 30, 50, 80, 110}) {
    std::vector<double> moved(heights.begin() + shift, heights.end());
    moved.insert(moved.end(), heights.begin() + 1, heights.begin() + 1 + kSamples);
    const auto t = flight_targets(moved, rule_of(mode));
    const auto phase = [](int i) { return (i % kSamples + kSamples) % kSamples; };
    if (!t) {
      worst = 100.0;
      continue;
    }
    for (const auto& [a, b] :
         {std::pair(t->lift + shift, whole->lift), std::pair(t->peak + shift, whole->peak),
          std::pair(t->land + shift, whole->land)}) {
      const int gap = std::abs(phase(a) - phase(b));
      worst = std::max(worst, percent(std::min(gap, kSamples - gap)));
    }
  }
  list.add("5 targets move with where the looping clip begins, % of the stride", worst,
           at_most(kFrame),
           mode == IkMode::paper ? "a clip that begins in the stance has a later first low" : "");
}

constexpr std::array<double, 3> kRatios = {0.6, 1.0, 1.6};

// Heights of the heel over the flight, with both ends, relative to the data's own stride length.
std::vector<double> flight_heights_m(const WalkModel& model, Side side) {
  constexpr int kSamples = 65;
  const double strike = model.cycle.strike[side], lift = strike + model.leg[side].toe_off;
  std::vector<double> heights_m;
  for (int i = 0; i < kSamples; ++i) {
    const double phase = mix(lift, strike + 1.0, static_cast<double>(i) / (kSamples - 1));
    heights_m.push_back(stride_of(model, false, phase, 1.0).cell.foot[side].heel_m.y);
  }
  return heights_m;
}

Walk walk_on(const WalkModel& model, IkMode mode) {
  WalkCase what;
  what.model = &model;
  what.ik = mode;
  what.end_s = 7.0;
  return walked(what);
}

// Toe positions over a stride if the source's angles are played on the character's bones and the
// root's motion is scaled by `root_scale`.
std::vector<vec3> raw_toes(const GaitCycle& source, const GaitCycle& build, Side side,
                           double root_scale, int samples) {
  std::vector<vec3> track;
  Pose pose;
  JointFrames frames;
  for (int i = 0; i < samples; ++i) {
    const double own = static_cast<double>(i) / samples;
    sample_local(source, own + source.strike[side], pose);
    pose.root_m = sample_at(source, own + source.strike[side]).pelvis_m;
    pose.root_m.z += own * source.stride_m;
    pose.root_m.z *= root_scale;
    forward_kinematics(build.skeleton, pose, frames);
    track.push_back(frames.position_m[build.leg[side].joints.toe]);
  }
  return track;
}

// Distance that the played toe moves while the source's own toe stands (below 15 % of its top
// speed).
double raw_slide_mm(const GaitCycle& source, const GaitCycle& build, double root_scale) {
  constexpr int kSamples = 256;
  constexpr double kStands = 0.15;
  double most = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    const auto own = raw_toes(source, source, side, 1.0, kSamples),
               played = raw_toes(source, build, side, root_scale, kSamples);
    double fastest = 0.0;
    const auto speed = [&own](std::size_t i) { return std::fabs(own[i].z - own[i - 1].z); };
    for (std::size_t i = 1; i < own.size(); ++i) fastest = std::max(fastest, speed(i));
    std::size_t begin = 0;
    for (std::size_t i = 1; i < own.size(); ++i) {
      if (speed(i) > kStands * fastest) begin = i + 1;
      if (begin < i) most = std::max(most, std::fabs(played[i].z - played[begin].z));
    }
  }
  return 1e3 * most;
}

}  // namespace

std::vector<Claim> flight_claims(const PaperSource& source, IkMode mode) {
  ClaimList list(kSection, mode);
  for (const Wanted& wanted : kWanted) target_claims(source, wanted, mode, list);
  band_claims(source, mode, list);
  file_claims(source, mode, list);
  threshold_claims(source, mode, list);
  ambiguity_claims(source, mode, list);
  completeness_claims(source, mode, list);
  return list.take_claims();
}

std::vector<Claim> scaling_claims(const Study& study) {
  ClaimList list("3.2", IkMode::robust);
  const GaitLimits own = gait_limits(study.model());
  double peak = 0.0, stride = 0.0, walked_step = 0.0, ends = 0.0, outside = 0.0;
  for (const double ratio : kRatios) {
    const auto model = study.model_with_legs(ratio);
    if (!model) continue;
    for (const Side side : {kLeftSide, kRightSide}) {
      const std::vector<double> mine = flight_heights_m(*model, side),
                                source = flight_heights_m(study.model(), side);
      const double highest = std::ranges::max(source);
      peak = std::max(peak, std::fabs(std::ranges::max(mine) / highest / ratio - 1.0));
      for (const double h : source) outside = std::max({outside, -h, h / highest - 1.0});
      ends = std::max(ends, source.back() / highest);
    }
    stride =
        std::max(stride, std::fabs(gait_limits(*model).max_step_m / own.max_step_m / ratio - 1));
    const Walk walk = walk_on(*model, IkMode::robust);
    const double step = walk.samples.back().frame.stride_m[kRightSide] / own.step_share[kRightSide];
    walked_step = std::max(walked_step,
                           std::fabs(step / own.max_step_m / std::sqrt(kPaperStick) / ratio - 1.0));
  }
  list.add("6 flight's peak over the legs' ratio off 1, %", 100.0 * peak, at_most(0.1),
           "legs x 0.6, 1, 1.6");
  list.add("6 longest step over the legs' ratio off 1, %", 100.0 * stride, at_most(0.1));
  list.add("6 walked step over the legs' ratio off 1, %", 100.0 * walked_step, at_most(0.1));
  list.add("6 normalised height outside 0 .. 1 by", outside, at_most(0.0));
  list.add("6 normalised height at the landing", ends, at_most(0.1),
           "the flight begins at the toe's lift, with the heel at 60 to 80 % of its peak: what "
           "comes before belongs to the standing foot");
  return list.take_claims();
}

std::vector<Claim> sliding_claims(const Study& study, IkMode mode) {
  ClaimList list("1 and 5", mode);
  double ours = 0.0, raw = 1e9;
  std::string text;
  for (const double ratio : kRatios) {
    const auto model = study.model_with_legs(ratio);
    if (!model) continue;
    ours = std::max(ours, planted_slide_mm(walk_on(*model, mode)));
    if (ratio == 1.0) continue;
    const GaitCycle& source = study.source().cycle;
    const double slide = raw_slide_mm(source, model->cycle, 1.0);
    text += fmt::format("{}legs x {}: {:.0f} mm, with the root's way scaled too {:.0f} mm",
                        text.empty() ? "" : "; ", ratio, slide,
                        raw_slide_mm(source, model->cycle, ratio));
    raw = std::min(raw, slide);
  }
  list.add("29 planted feet slide on legs x 0.6 to 1.6 by, mm", ours, at_most(0.1));
  if (mode == IkMode::robust) {
    list.add("29 feet slide when the same angles are played, mm", raw, more_than(20.0), text);
  }
  return list.take_claims();
}

}  // namespace gaitpad
