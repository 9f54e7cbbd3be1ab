// Feeds bad values to every public function of the C++ library: none crashes, none reaches a pose,
// each is refused by a sentence that names the field and its range, or counted. The C API has its
// own test (c_api/bad_values_test).
#include "tests/bad_values.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <tuple>

#include "control/params_range.h"
#include "files/bvh_text.h"
#include "gaitpad/anatomy.h"
#include "gaitpad/bvh.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/config_files.h"
#include "gaitpad/flight.h"
#include "gaitpad/gltf.h"
#include "gaitpad/keyboard.h"
#include "gaitpad/live.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/replay.h"
#include "gaitpad/walk_output.h"
#include "tests/finite_pose.h"
#include "tests/made_pad.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

// The sentence of the refusal; none: the value was accepted.
using Said = std::optional<std::string>;

template <class T>
Said said_by(const Result<T>& result) {
  return result ? Said() : Said(result.error().message);
}
Said said_by(const std::optional<Error>& problem) {
  return problem ? Said(problem->message) : Said();
}

int fed = 0;  // number of values fed so far

// Sets one field after the other to each of its bad values. `call` must refuse it and name the
// field and its range.
template <class T, class Call>
void feed(const char* function, const T& good, const std::vector<FedField<T>>& fields,
          const Call& call) {
  for (const FedField<T>& field : fields) {
    for (const double value : field.bad) {
      T bad = good;
      field.set(bad, value);
      const Said said = call(bad);
      ++fed;
      ASSERT_TRUE(said) << function << " takes " << field.name << " = " << value;
      EXPECT_NE(said->find(field.name), std::string::npos) << function << ": " << *said;
      EXPECT_NE(said->find("outside ["), std::string::npos) << function << ": " << *said;
    }
  }
}

// A bad value without a range: a text, a list or a pointer. Each must be refused, with these words.
struct BadCall {
  const char* says;
  std::function<Said()> call;
};
void feed(const std::vector<BadCall>& calls) {
  for (const BadCall& bad : calls) {
    const Said said = bad.call();
    ++fed;
    ASSERT_TRUE(said) << bad.says;
    EXPECT_NE(said->find(bad.says), std::string::npos) << *said;
  }
}

#define FIELD(T, member, range)                           \
  FedField<T> {                                           \
#member, [](T & t, double v) { t.member = v; }, range \
  }
#define COUNT(T, member, range)                                             \
  FedField<T> {                                                             \
#member, [](T & t, double v) { t.member = static_cast<int>(v); }, range \
  }
// A field that is an enumeration with values 0 .. last.
#define CHOICE(T, member, E, last)                                                               \
  FedField<T> {                                                                                  \
#member, [](T & t, double v) { t.member = static_cast<E>(static_cast<std::uint8_t>(v)); }, { \
      last + 1.0, 200.0                                                                          \
    }                                                                                            \
  }

const GaitCycle& good_cycle() {
  static const GaitCycle cycle = clean_cycle(procedural_gait());
  return cycle;
}
const WalkModel& good_model() {
  static const WalkModel model = value_of(walk_model(good_cycle(), Character{}));
  return model;
}

// --- Set-up: everything that returns a Result, and check() ---------------------------------------

void feed_motions() {
  using M = Motion;
  Motion good = procedural_motion();
  good.frames.resize(2);
  const double last = double(good.skeleton.joints.size()) - 1.0;
  const std::vector<FedField<M>> fields = {
      FIELD(M, frame_time_s, bad_numbers(1e-5, 10.0)),
      COUNT(M, pelvis, bad_counts(0, last)),
      COUNT(M, legs[1].knee, bad_counts(-1, last)),
      {"joints[3].parent", [](M& m, double v) { m.skeleton.joints[3].parent = int(v); },
       bad_counts(0, 2)}};
  feed("find_legs()", good, fields, [](const M& m) { return said_by(find_legs(m)); });
  feed("gait_cycle()", good, fields, [](const M& m) { return said_by(gait_cycle(m)); });
  feed("cycle_on_skeleton()", good, fields,
       [](const M& m) { return said_by(cycle_on_skeleton(good_cycle(), m)); });
  // For functions without a Result, which find nothing instead of an error.
  for (const FedField<M>& field : fields) {
    for (const double value : field.bad) {
      M bad = good;
      field.set(bad, value);
      EXPECT_TRUE(swings(bad, kLeftSide).empty());
      EXPECT_FALSE(robust_flight(bad, kRightSide));
      EXPECT_FALSE(paper_flight(bad, kLeftSide));
      fed += 3;
    }
  }
  EXPECT_EQ(leg_length_m(Motion{}), 0.0);
  const std::array<int, 3> joints = {-1, 1'000'000, 0};
  EXPECT_TRUE(joint_tracks_m(good, joints)[0].empty());
  EXPECT_TRUE(joint_tracks_m(good, joints)[1].empty());
  EXPECT_FALSE(paper_flight(std::vector<double>{kNaN, kNaN, kNaN, kInfinity}));
  const auto spoilt = [&good](const auto& spoil) {
    Motion bad = good;
    spoil(bad);
    return said_by(find_legs(bad));
  };
  feed({{"has no frames", [&] { return spoilt([](M& m) { m.frames.clear(); }); }},
        {"joints is 0, outside", [&] { return spoilt([](M& m) { m.skeleton.joints.clear(); }); }},
        {"is no rotation", [&] { return spoilt([](M& m) { m.frames[1].local[2].w = kNaN; }); }},
        {"is no rotation",
         [&] { return spoilt([](M& m) { m.frames[1].local[2] = quat(1e-310, 0.0, 0.0, 0.0); }); }},
        {"is not finite", [&] { return spoilt([](M& m) { m.frames[1].root_m.x = kInfinity; }); }}});
  fed += 4;
}

void feed_cycles() {
  using C = GaitCycle;
  const double last = double(good_cycle().skeleton.joints.size()) - 1.0;
  const std::vector<FedField<C>> fields = {
      FIELD(C, duration_s, bad_numbers(0.05, 60.0)),
      FIELD(C, stride_m, bad_numbers(1e-3, 1e3)),
      FIELD(C, leg[1].thigh_m, bad_numbers(1e-3, 1e3)),
      FIELD(C, leg[0].shank_m, bad_numbers(1e-3, 1e3)),
      COUNT(C, pelvis, bad_counts(0, last)),
      {"leg[0].hip", [](C& c, double v) { c.leg[0].joints.hip = int(v); }, bad_counts(0, last)}};
  feed("walk_model()", good_cycle(), fields,
       [](const C& c) { return said_by(walk_model(c, Character{})); });
  feed("with_clean_strides()", good_cycle(), fields,
       [](const C& c) { return said_by(with_clean_strides(c)); });
  feed("stride_family()", good_cycle(), fields,
       [](const C& c) { return said_by(stride_family(c)); });
  feed("cycle_on_skeleton()", good_cycle(), fields,
       [](const C& c) { return said_by(cycle_on_skeleton(c, procedural_motion())); });
  using B = Character;
  feed("walk_model()", B{},
       {FIELD(B, scale, bad_numbers(0.05, 20.0)), FIELD(B, leg_ratio, bad_numbers(0.05, 20.0))},
       [](const B& b) { return said_by(walk_model(good_cycle(), b)); });
}

void feed_styles() {
  // A StyleValues consists of numbers only, and each has a key.
  constexpr std::size_t kNumbers = sizeof(StyleValues) / sizeof(double);
  OwnFolder home;
  SimulationConfig config = made_config(1);
  for (std::size_t k = 0; k < kNumbers; ++k) {
    for (const double value : {kNaN, kInfinity, -kInfinity, 1e300}) {
      Style bad;
      std::memcpy(reinterpret_cast<char*>(static_cast<StyleValues*>(&bad)) + k * sizeof(double),
                  &value, sizeof value);
      config.styles[0] = bad;
      for (const Said& said : {said_by(check(bad)), said_by(save_style({}, "bad", bad)),
                               said_by(Simulation::create(config))}) {
        ++fed;
        ASSERT_TRUE(said) << "number " << k << ", " << value;
        EXPECT_NE(said->find("outside ["), std::string::npos) << *said;
      }
    }
  }
  for (const StyleKey& key : style_keys()) {
    for (const double value : bad_numbers(key.min, key.max)) {
      StyleValues style;
      EXPECT_FALSE(set_value(style, key.name, value)) << key.name << " " << value;
      EXPECT_EQ(style, StyleValues{});
      ++fed;
    }
  }
  StyleValues style;
  EXPECT_FALSE(set_value(style, "", 1.0));
  EXPECT_FALSE(value_of(style, std::string(10'000, 'x')));
  using L = GaitLimits;
  feed("check()", L{},
       {FIELD(L, max_speed_m_s, bad_numbers(1e-3, 50.0)),
        FIELD(L, max_step_m, bad_numbers(1e-3, 50.0)),
        FIELD(L, step_share[1], bad_numbers(0.0, 50.0)),
        FIELD(L, max_step_time_s, bad_numbers(0.05, 50.0)),
        FIELD(L, max_turning_step_time_s, bad_numbers(0.05, 50.0)),
        FIELD(L, turn_step_time_s, bad_numbers(0.05, 50.0)),
        FIELD(L, max_turn_rate_rad_s, bad_numbers(0.0, 50.0))},
       [](const L& limits) { return said_by(check(limits)); });
}

void feed_sessions() {
  using C = SimulationConfig;
  feed(
      "Simulation::create()", made_config(2),
      {COUNT(C, rate_hz, bad_counts(kLeastRateHz, kMaxRateHz)),
       COUNT(C, crowd_threads, bad_counts(1, kMaxCrowdThreads)),
       COUNT(C, walkers[1].style, bad_counts(0, 1)),
       {"scale", [](C& c, double v) { c.walkers[0].character.scale = v; }, bad_numbers(0.05, 20.0)},
       {"left.inner", [](C& c, double v) { c.pads[0].calibration.left.inner = v; },
        bad_numbers(0.0, 0.9)},
       {"factory_gyro.zero[1]",
        [](C& c, double v) {
          c.pads[0].factory_gyro.emplace();
          c.pads[0].factory_gyro->zero[1] = v;
        },
        bad_numbers(-65536.0, 65536.0)},
       CHOICE(C, ik, IkMode, 1),
       CHOICE(C, stick, StickMeans, 1),
       CHOICE(C, pad_rules, PadRules, 1),
       CHOICE(C, pace, Pace, 1)},
      [](const C& c) { return said_by(Simulation::create(c)); });
  const auto spoilt = [](const auto& spoil) {
    C bad = made_config(1);
    spoil(bad);
    return said_by(Simulation::create(bad));
  };
  feed({{"styles is empty", [&] { return spoilt([](C& c) { c.styles.clear(); }); }},
        {"terrain is null", [&] { return spoilt([](C& c) { c.terrain = nullptr; }); }},
        {"0 characters", [&] { return spoilt([](C& c) { c.walkers.clear(); }); }},
        {"a crowd of -1", [&] { return spoilt([](C& c) { c.crowd = -1; }); }},
        {"a crowd of 100001", [&] { return spoilt([](C& c) { c.crowd = 100'001; }); }},
        {"number of joints", [&] { return spoilt([](C& c) { c.cycle = {}; }); }},
        {"prepared is null",
         [] { return said_by(LiveSession::start(std::shared_ptr<LiveSession::Prepared>())); }}});

  using S = SessionSpec;
  SessionSpec recorded;
  recorded.replay.trace = "none.hid";
  const std::vector<FedField<S>> fields = {
      COUNT(S, rate_hz, bad_counts(kLeastRateHz, kMaxRateHz)),
      COUNT(S, walk.crowd, bad_counts(0, kMaxFollowers)),
      COUNT(S, live.frame_ticks, bad_counts(0, kMaxRateHz)),
      COUNT(S, live.stream_fps, bad_counts(1, kMaxRateHz)),
      FIELD(S, replay.max_hours, bad_numbers(0.0, 1e6)),
      COUNT(S, replay.fps, bad_counts(1, kMaxRateHz)),
      COUNT(S, replay.crowd_files, bad_counts(0, kMaxFollowers)),
      CHOICE(S, walk.ik, IkMode, 1),
      CHOICE(S, walk.stick, StickMeans, 1),
      CHOICE(S, walk.pace, Pace, 1),
      CHOICE(S, live.clock, S::Live::Clock, 1),
      CHOICE(S, replay.damage, Damage, 1)};
  feed("LiveSession::prepare()", SessionSpec{}, fields,
       [](const S& s) { return said_by(LiveSession::prepare(s)); });
  feed("LiveSession::start()", SessionSpec{}, fields,
       [](const S& s) { return said_by(LiveSession::start(s)); });
  feed("replay()", recorded, fields, [](const S& s) { return said_by(replay(s)); });
  feed("simulation_config()", SessionSpec{}, fields,
       [](const S& s) { return said_by(simulation_config(s, 240)); });

  using O = Followers::Options;
  const std::vector<std::shared_ptr<const WalkModel>> builds = {
      std::make_shared<const WalkModel>(good_model())};
  const std::vector<Style> styles(1);
  feed("Followers::create()", O{.count = 2},
       {COUNT(O, count, bad_counts(0, kMaxFollowers)),
        COUNT(O, threads, bad_counts(1, kMaxCrowdThreads)),
        COUNT(O, shown, bad_counts(0, kMaxFollowers)), CHOICE(O, ik, IkMode, 1),
        FIELD(O, first_m.x, bad_numbers(-kFarthest_m, kFarthest_m)),
        FIELD(O, middle_m.z, bad_numbers(-kFarthest_m, kFarthest_m))},
       [&](const O& o) { return said_by(Followers::create(o, builds, styles)); });
  feed({{"builds is empty", [&] { return said_by(Followers::create({}, {}, styles)); }},
        {"builds[0] is null", [&] { return said_by(Followers::create({}, {nullptr}, styles)); }},
        {"styles is empty", [&] { return said_by(Followers::create({}, builds, {})); }}});
  using M = std::vector<CrowdMember>;
  feed("Crowd::create()", M(2, CrowdMember{builds[0], vec3(0.0)}),
       {FIELD(M, at(1).place_m.x, bad_numbers(-kFarthest_m, kFarthest_m))}, [](const M& m) {
         const Said said = said_by(Crowd::create(m));
         return said ? Said("at(1).place_m.x " + *said) : said;
       });
  feed({{"members[0].model is null", [] { return said_by(Crowd::create(M(1))); }}});
}

void feed_pads() {
  using F = CalibrationFile;
  const std::vector<FedField<F>> fields = {
      {"left.x.min", [](F& f, double v) { f.calibration.left.x.min = v; }, bad_numbers(-1.0, 1.0)},
      {"left.inner", [](F& f, double v) { f.calibration.left.inner = v; }, bad_numbers(0.0, 0.9)},
      {"right.outer", [](F& f, double v) { f.calibration.right.outer = v; }, bad_numbers(0.1, 1.0)},
      {"right.sideways", [](F& f, double v) { f.calibration.right.sideways = v; },
       bad_numbers(0.0, 0.5)},
      {"left.curve", [](F& f, double v) { f.calibration.left.curve = v; }, bad_numbers(0.0, 1.0)},
      {"left_trigger.pressed",
       [](F& f, double v) { f.calibration.left_trigger.pressed = v; },
       {kNaN, kInfinity, -1.0, 1.5, -1e-310}},
      {"gyro_bias_rad_s[2]",
       [](F& f, double v) {
         f.gyro_bias_rad_s = TurnRates{0.0, 0.0, v};
       },
       bad_numbers(-1.0, 1.0)}};
  feed("pad_config()", F{}, fields,
       [](const F& f) { return said_by(pad_config(PadFiles{}, made_pad(), f, "pad")); });
  feed("PadStream::start()", F{}, fields, [](const F& f) {
    PadStreamOptions options;
    options.files.calibration = f;
    return said_by(PadStream::start(std::move(options)));
  });
  using O = PadStreamOptions;
  const auto spoilt = [](const auto& spoil) {
    O bad;
    spoil(bad);
    return said_by(PadStream::start(std::move(bad)));
  };
  feed({{"changes_fd is -2, outside [-1", [&] { return spoilt([](O& o) { o.changes_fd = -2; }); }},
        {"ring_reports is 0, not a power of two in [1, 1048576]",
         [&] { return spoilt([](O& o) { o.ring_reports = 0; }); }},
        {"ring_reports is 3", [&] { return spoilt([](O& o) { o.ring_reports = 3; }); }},
        {"ring_reports is 2097152", [&] { return spoilt([](O& o) { o.ring_reports = 1 << 21; }); }},
        {"stick is null", [] { return said_by(open_keyboard(nullptr)); }}});
  for (const int rate_hz : {0, -1, -60, std::numeric_limits<int>::min(), 2'000'000'000}) {
    Pads pads({made_pad_config()}, rate_hz);
    for (const std::uint16_t device : {1, 0xfffe, 0xffff}) {
      PadConfig config;
      pads.add_pad(device);
      pads.remove_pad(device);
      pads.set_pad(device, config);
      EXPECT_FALSE(pads.take_report(made_report(0x80, 0, device)));
    }
    Report longer = made_report(0x80, 0);
    longer.size = 0xffff;
    EXPECT_FALSE(pads.take_report(longer));
    EXPECT_LE(text_of(longer).size(), kMaxReportBytes);
    EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
    fed += 5;
  }
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1e300, 1e-310}) {
    for (const vec2& raw : {vec2(bad, 0.0), vec2(0.0, bad), vec2(bad)}) {
      const vec2 at = stick_position(StickCalibration{}, raw);
      EXPECT_LE(glm::length(at), 1.0 + 1e-12) << bad;
      KeyboardStick keys;
      keys.steer(raw);
      EXPECT_LE(glm::length(keys.wanted()), 1.0 + 1e-4) << bad;
      UntouchedWatch watch;
      EXPECT_FALSE(watch.take(std::numeric_limits<std::int64_t>::max(), {}, raw, at));
      fed += 3;
    }
    const double pressed = trigger_position(TriggerCalibration{}, bad);
    EXPECT_TRUE(pressed >= 0.0 && pressed <= 1.0) << bad;
    ++fed;
  }
}

Trace made_trace() {
  Trace trace;
  trace.path = "made.hid";
  trace.devices.emplace_back().info = made_pad();
  add_event(trace, 0, made_report(0x80, 0));
  add_event(trace, 1000, made_report(0x80, 0));
  return trace;
}

void feed_files() {
  OwnFolder folder;
  const Motion good = procedural_motion();
  using O = LoadOptions;
  const std::vector<FedField<O>> options = {
      FIELD(O, metres_per_unit, bad_numbers(0.0, 1e3)),
      {"frame_rate_hz", [](O& o, double v) { o.frame_rate_hz = v == 0.0 ? 0.5 : v; },
       bad_numbers(1.0, 1e4)}};
  feed("load_motion()", O{}, options,
       [](const O& o) { return said_by(load_motion("none.bvh", o)); });
  feed("load_motion_source()", O{}, options,
       [](const O& o) { return said_by(load_motion_source("none.toml", o)); });
  feed("motion_from_bvh()", O{}, options,
       [](const O& o) { return said_by(motion_from_bvh("", "none", o)); });
  feed("motion_from_acclaim()", O{}, options, [](const O& o) {
    return said_by(motion_from_acclaim({"none", ""}, {}, o));
  });
  using B = BvhLayout;
  feed("BvhWriter", B{},
       {FIELD(B, metres_per_unit, bad_numbers(1e-9, 1e6)),
        FIELD(B, frame_time_s, bad_numbers(1e-5, 10.0)),
        {"end_sites_as_joints",
         [](B& b, double v) { b.end_sites_as_joints = {static_cast<int>(v)}; },
         bad_counts(0, double(good.skeleton.joints.size()) - 1.0)}},
       [&good](const B& layout) {
         std::stringstream out;
         BvhWriter writer(out, good.skeleton, layout);
         writer.write(Pose{});
         EXPECT_FALSE(writer.finish());
         EXPECT_EQ(out.str(), "");
         return said_by(check(layout, good.skeleton));
       });
  using G = GltfLayout;
  G layout;
  layout.rest_local.assign(good.skeleton.joints.size(), kIdentity);
  feed("GltfWriter", layout,
       {FIELD(G, fps, bad_numbers(1e-3, 1e4)), FIELD(G, rest_root_m.y, bad_numbers(-1e6, 1e6))},
       [&good](const G& bad) {
         std::stringstream out;
         GltfWriter writer(out, std::fstream(), good.skeleton, bad);
         writer.write(Pose{});
         const auto problem = writer.finish();
         EXPECT_EQ(out.str(), "");
         return problem ? Said(*problem) : Said();
       });
  const auto trace_with = [](const auto& spoil) {
    Trace bad = made_trace();
    spoil(bad);
    const Said said = said_by(assign_ticks(bad, 240));
    EXPECT_EQ(said_by(write_trace(bad, "/none/at/all.hid")), said);
    return said;
  };
  feed({{"events[1].device is 7",
         [&] { return trace_with([](Trace& t) { t.events[1].device = 7; }); }},
        {"events[1].size is 2000, outside [0, 1024]",
         [&] { return trace_with([](Trace& t) { t.events[1].size = 2000; }); }},
        {"events[0].first_byte is 4294967295",
         [&] { return trace_with([](Trace& t) { t.events[0].first_byte = 0xffffffff; }); }},
        {"rate_hz is -60, outside [10",
         [&] { return trace_with([](Trace& t) { t.rate_hz = -60; }); }},
        {"events[1].time_us is ",
         [&] { return trace_with([](Trace& t) { t.events[1].time_us = std::int64_t{1} << 60; }); }},
        {"layout",
         [&] { return said_by(check(GltfLayout{}, Skeleton{})) ? Said("layout") : Said(); }},
        {"has no joints", [] { return said_by(check(BvhLayout{}, Skeleton{})); }}});
  // Texts and paths that are empty, and a path with a zero byte.
  for (const std::string& none : {std::string(), folder.at("none"), std::string("a\0b", 3)}) {
    for (const Said& said :
         {said_by(load_motion(none)), said_by(load_motion_source(none)), said_by(read_bvh(none)),
          said_by(read_trace(none)), said_by(load_style(none)), said_by(load_character(none)),
          said_by(load_terrain(none)), said_by(load_calibration_file(none)),
          said_by(load_pad_file(none)), said_by(save_style({}, none, StyleValues{})),
          said_by(parse_bvh(none, "x")), said_by(motion_from_bvh(none, "x")),
          said_by(parse_pad_file(none + "=", "x")), said_by(parse_calibration(none + "=", "x")),
          said_by(parsed_terrain(none + "=", "x")), said_by(parse_sources(none + "|"))}) {
      ++fed;
      EXPECT_TRUE(said && !said->empty()) << none;
    }
    EXPECT_EQ(find_driver(none), nullptr);
    EXPECT_FALSE(gait_key(none));
    EXPECT_EQ(good.skeleton.find(none), -1);
    fed += 3;
  }
  EXPECT_FALSE(config_file({}, "styles", ""));
  EXPECT_FALSE(motion_path({}, ""));
  EXPECT_EQ(named_joint("").part, NamedPart::none);
  fed += 3;
}

void feed_terrains() {
  const auto added = [](const SectionShape& shape) {
    Terrain terrain;
    const Said said = said_by(add_section(terrain, shape));
    EXPECT_TRUE(terrain.sections.empty());
    return said;
  };
  RoughSection rough = rough_section(6.0, 0.03, 2.0, 1.0, 7);
  const auto field = std::make_shared<const HeightField>(
      HeightField{2, 2, {0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}});
  std::vector<SectionShape> bad;
  for (const double v : {kNaN, kInfinity, -kInfinity, 1e300, -1.0, 0.0, 1e-310}) {
    bad.insert(bad.end(),
               {FlatSection{v}, SlopeSection{v}, SlopeSection{4.0, 0.1, v}, StairsSection{v},
                StairsSection{0.17, v}, FieldSection{v, 1.0, 0.1, 1.0, nullptr}});
    RoughSection spoilt = rough;
    spoilt.length_m = v;
    bad.emplace_back(spoilt);
    spoilt = rough;
    spoilt.fade_m = v;
    bad.emplace_back(spoilt);
    if (std::abs(v) <= 1.0) continue;
    bad.emplace_back(SlopeSection{4.0, v, 0.5});
    for (double Wave::*member : {&Wave::x_rad_m, &Wave::z_rad_m, &Wave::height_m}) {
      spoilt = rough;
      spoilt.wave[2].*member = v;
      bad.emplace_back(spoilt);
    }
    if (std::isfinite(v)) continue;
    spoilt = rough;
    spoilt.wave[2].phase_rad = v;
    bad.emplace_back(spoilt);
  }
  for (const int count : {0, -1, std::numeric_limits<int>::max()})
    bad.emplace_back(StairsSection{0.17, 0.28, count});
  bad.emplace_back(FieldSection{10.0, 0.05, 0.1, 1.0, nullptr});
  bad.emplace_back(FieldSection{10.0, 0.05, 0.1, 1.0, field});
  for (const SectionShape& shape : bad) {
    ++fed;
    EXPECT_TRUE(added(shape)) << "shape " << shape.index() << ", row " << &shape - bad.data();
  }
  using G = GroundGrid;
  const G grid{.columns = 2, .rows = 2, .height_m = {0.0f, 0.0f, 0.0f, 0.0f}};
  feed("check()", grid, {FIELD(G, spacing_m, bad_numbers(0.01, 100.0))},
       [](const G& g) { return said_by(check(g)); });
  const auto ask = [](const void* game, double, double) noexcept {
    return Ground{*static_cast<const double*>(game), vec3(kNaN), -7};
  };
  for (const double v : {kNaN, kInfinity, -kInfinity}) {
    G bad_grid = grid;
    bad_grid.x_m = v;
    EXPECT_TRUE(check(bad_grid));
    bad_grid = grid;
    bad_grid.height_m[3] = static_cast<float>(v);
    EXPECT_TRUE(check(bad_grid));
    Terrain terrain;
    terrain.asked = {ask, &v, nullptr};
    EXPECT_EQ(ground_at(terrain, v, v).height_m, 0.0);
    WalkModel model = good_model();
    model.terrain = std::make_shared<const Terrain>(terrain);
    Pose pose;
    WalkState state = standing(model, vec3(0.0), pose);
    for (int tick = 0; tick < 90; ++tick)
      advance(model, gait_params({.left = vec2(0.0, 1.0)}, {}, gait_limits(model)), IkMode::robust,
              1.0 / 60.0, state, pose);
    EXPECT_TRUE(is_finite(pose)) << v;
    EXPECT_TRUE(std::isfinite(ground_at(*flat_terrain(), v, v).height_m));
    fed += 4;
  }
}

void feed_solvers() {
  using Case = std::tuple<IkChain, std::vector<IkRow>, PaperOptions, RobustOptions>;
  IkChain chain;
  chain.dofs = 3;
  for (int i = 0; i < 3; ++i) chain.dof[i] = {vec3(1.0, 0.0, 0.0), vec3(0.0, -0.4, 0.0)};
  const auto rows = point_goal(vec3(0.0), vec3(0.0, -0.9, 0.3));
  const Case good = {chain, {rows.begin(), rows.end()}, {}, {}};
  const auto solved = [](const Case& c, bool is_paper) {
    const auto& [chain, rows, paper, robust] = c;
    IkAngles angles{};
    const IkResult result = is_paper ? solve_paper(chain, rows, paper, angles)
                                     : solve_robust(chain, rows, robust, angles);
    EXPECT_EQ(angles, IkAngles{});
    if (result.status != IkStatus::not_finite) return Said();
    for (const auto& problem : {check(chain), check(rows), check(paper), check(robust)}) {
      if (problem) return said_by(problem);
    }
    return Said("no check() says why");
  };
  using C = Case;
  const std::vector<FedField<C>> both = {
      {"dofs", [](C& c, double v) { std::get<0>(c).dofs = int(v); }, {-1, 17, 1e9, -2e9}},
      {"dof[1].weight",
       [](C& c, double v) { std::get<0>(c).dof[1].weight = v; },
       {kNaN, kInfinity, -kInfinity}},
      {"dof[2].link_m.y",
       [](C& c, double v) { std::get<0>(c).dof[2].link_m.y = v; },
       {kNaN, kInfinity, -kInfinity, 1e300}},
      {"goal_m",
       [](C& c, double v) { std::get<1>(c)[1].goal_m = v; },
       {kNaN, kInfinity, -kInfinity, 1e300}}};
  std::vector<FedField<C>> paper = both, robust = both;
  const auto number = [](auto member) {
    return [member](C& c, double v) {
      auto& options =
          std::get<std::conditional_t<std::is_invocable_v<decltype(member), PaperOptions&>,
                                      PaperOptions, RobustOptions>>(c);
      member(options) = static_cast<std::remove_reference_t<decltype(member(options))>>(v);
    };
  };
  const std::vector<double> counts = bad_counts(0, kMostIkIterations);
  paper.push_back({"tolerance_m", number([](PaperOptions& o) -> double& { return o.tolerance_m; }),
                   bad_numbers(0.0, 1e6)});
  paper.push_back({"epsilon_m", number([](PaperOptions& o) -> double& { return o.epsilon_m; }),
                   bad_numbers(0.0, 1e6)});
  paper.push_back(
      {"max_iterations", number([](PaperOptions& o) -> int& { return o.max_iterations; }), counts});
  paper.push_back(
      {"max_halvings", number([](PaperOptions& o) -> int& { return o.max_halvings; }), counts});
  robust.push_back({"damping", number([](RobustOptions& o) -> double& { return o.damping; }),
                    bad_numbers(0.0, 1e6)});
  robust.push_back({"max_step_rad",
                    number([](RobustOptions& o) -> double& { return o.max_step_rad; }),
                    bad_numbers(1e-6, 3.14)});
  robust.push_back({"max_iterations",
                    number([](RobustOptions& o) -> int& { return o.max_iterations; }), counts});
  robust.push_back({"max_tries", number([](RobustOptions& o) -> int& { return o.max_tries; }),
                    bad_counts(1, kMostIkIterations)});
  feed("solve_paper()", good, paper, [&](const C& c) { return solved(c, true); });
  feed("solve_robust()", good, robust, [&](const C& c) { return solved(c, false); });
}

// --- Run time: functions that cannot fail --------------------------------------------------------

// A walk in the middle of a step, which gets a bad value and then walks on.
struct Walking {
  const WalkModel& model = good_model();
  GaitLimits limits = gait_limits(model);
  GaitParams usual = gait_params({.left = vec2(0.1, 0.8)}, {}, limits);
  Pose pose;
  WalkState state = standing(model, vec3(0.0), pose);
  Walking() { walk(usual, 100); }
  void walk(const GaitParams& params, int ticks, double dt_s = 1.0 / 60.0) {
    for (int i = 0; i < ticks; ++i) advance(model, params, IkMode::robust, dt_s, state, pose);
  }
};

// Feeds each bad value to a copy of one walk. The pose stays finite, the value is counted, and the
// walk goes on: after half a second it is where it would be without the value.
struct Feed {
  const char* name;
  std::function<void(Walking&, double)> give;
  std::vector<double> bad;
};
void feed_walks() {
  const Walking begun;
  Walking unfed = begun;
  unfed.walk(unfed.usual, 31);
  const std::vector<double> numbers = {kNaN, kInfinity, -kInfinity};
  const std::vector<double> places = bad_numbers(-kFarthest_m, kFarthest_m);
  // Moves the walk by `by`, then walks for a tick.
  const auto move = [](auto by) {
    return [by](Walking& w, double v) {
      move_walk(by(v), w.state, w.pose);
      w.walk(w.usual, 1);
    };
  };
  const auto put = [](auto at) {
    return [at](Walking& w, double v) {
      put_walk(at(v).place_m, at(v).heading_rad, w.state, w.pose);
      w.walk(w.usual, 1);
    };
  };
  // Walks for a tick, by a stick or towards a capsule.
  const auto steer = [](auto stick) {
    return [stick](Walking& w, double v) { w.walk(gait_params(stick(v, w), {}, w.limits), 1); };
  };
  const auto follow = [](auto capsule) {
    return [capsule](Walking& w, double v) {
      w.walk(following(capsule(v), w.state, {}, w.limits), 1);
    };
  };
  using P = Placement;
  using W = Walking;
  using C = CapsuleMotion;
  const auto across = [](double v) { return P{vec3(v, 0.0, 0.0), 0.0}; };
  const auto up = [](double v) { return P{vec3(0.0, v, 0.0), 0.0}; };
  const auto round = [](double v) { return P{vec3(0.0), v}; };
  const std::vector<Feed> feeds = {
      {"dt_s", [](W& w, double v) { w.walk(w.usual, 1, v); },
       bad_numbers(kLeastTick_s, kMostTick_s)},
      {"move_walk() place_m.x", move(across), places},
      {"move_walk() place_m.y", move(up), places},
      {"move_walk() heading_rad", move(round), places},
      {"put_walk() place_m.x", put(across), places},
      {"put_walk() place_m.y", put(up), places},
      {"put_walk() heading_rad", put(round), places},
      {"left.x", steer([](double v, W&) { return Stick{.left = vec2(v, 0.8)}; }), numbers},
      {"left.y", steer([](double v, W&) { return Stick{.left = vec2(0.1, v)}; }), numbers},
      {"pointed_stick()", steer([](double v, W& w) {
         return pointed_stick({.left = vec2(v, 0.5)}, 0.0, 0.0, w.limits);
       }),
       numbers},
      {"place_m", follow([](double v) { return C{.place_m = vec3(v)}; }), numbers},
      {"velocity_m_s", follow([](double v) { return C{.velocity_m_s = vec3(v)}; }), numbers},
      {"heading_rad", follow([](double v) { return C{.heading_rad = v}; }), numbers},
      {"turn_rate_rad_s", follow([](double v) { return C{.turn_rate_rad_s = v}; }), numbers}};
  for (const Feed& feed : feeds) {
    for (const double value : feed.bad) {
      Walking fed_walk = begun;
      feed.give(fed_walk, value);
      ++fed;
      EXPECT_GT(fed_walk.state.bad_inputs, 0) << feed.name << " " << value;
      EXPECT_TRUE(is_finite(fed_walk.pose)) << feed.name << " " << value;
      fed_walk.walk(fed_walk.usual, 30);
      EXPECT_TRUE(is_finite(fed_walk.pose)) << feed.name << " " << value;
      EXPECT_LT(glm::distance(fed_walk.state.root.place_m, unfed.state.root.place_m), 0.02)
          << feed.name << " " << value;
    }
  }
  // Feed all numbers of the parameters to a single walk and to a crowd.
  auto crowd = value_of(Crowd::create(
      std::vector<CrowdMember>(5, {std::make_shared<const WalkModel>(good_model()), vec3(0.0)})));
  for (std::size_t k = 0; k < kParamsNumbers; ++k) {
    const double least = numbers_of(params_range().least)[k],
                 most = numbers_of(params_range().most)[k];
    for (const double value : bad_numbers(least, most)) {
      const int before = crowd.state(2).bad_inputs;
      for (GaitParams& params : crowd.params()) params = begun.usual;
      numbers_of(crowd.params()[2])[k] = value;
      EXPECT_TRUE(check(crowd.params()[2])) << k << " " << value;
      crowd.advance(1.0 / 60.0);
      ++fed;
      EXPECT_EQ(crowd.state(2).bad_inputs, before + 1) << k << " " << value;
      ASSERT_TRUE(is_finite(crowd.root_m(2), crowd.local(2))) << k << " " << value;
    }
  }
  for (const int member :
       {-1, 5, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    Pose pose;
    crowd.restart(member, vec3(0.0));
    crowd.move(member, {});
    crowd.put(member, vec3(0.0), 0.0);
    crowd.copy_pose(member, pose);
    crowd.advance_block(member, 0.01);
    fed += 5;
  }
  for (const double value : places) {
    Pose pose;
    for (const WalkState& state : {standing(good_model(), vec3(value, 0.0, 0.0), pose),
                                   standing(good_model(), vec3(0.0), value, pose)}) {
      ++fed;
      EXPECT_EQ(state.bad_inputs, 1) << value;
      EXPECT_TRUE(is_finite(pose)) << value;
    }
    const int before = crowd.state(1).bad_inputs;
    crowd.move(1, {vec3(0.0, value, 0.0), 0.0});
    crowd.put(1, vec3(0.0), value);
    crowd.restart(0, vec3(0.0, 0.0, value));
    fed += 3;
    EXPECT_EQ(crowd.state(1).bad_inputs, before + 2) << value;
    EXPECT_EQ(crowd.state(0).bad_inputs, 1) << value;
  }
}

// Functions that only compute accept bad values; the walk that gets the result counts it.
void feed_values() {
  const GaitLimits limits = gait_limits(good_model());
  for (const double v : {kNaN, kInfinity, -kInfinity, 1e300, -1e300, 1e-310, 0.0, -1.0}) {
    StyleValues style;
    StyleBlend blend = begun_blend(style, style, style);
    blend.length_s = v;
    GaitLimits spoilt = limits;
    spoilt.max_speed_m_s = v;
    OwnGait own;
    own.stick = v;
    GaitOverrides overrides;
    overrides.value.fill(v);
    overrides.is_set.fill(true);
    StyleValues swaying, tiring;
    swaying.hip_sway = 2.0;
    tiring.fatigue_per_100_m = 1.0;
    const Stick stick{.left = vec2(0.1, 0.8)};
    const std::vector<GaitParams> all = {
        gait_params(stick, mixed(style, swaying, v), limits),
        gait_params(stick, advance(blend, style, v), limits),
        gait_params(stick, with_fatigue(tiring, v), limits),
        gait_params(stick, with_fatigue(tiring, tired(v, tiring, v, false, v)), limits),
        gait_params(stick, style, spoilt),
        gait_params(stick, style, gait_limits(v)),
        gait_params(stick, style, gait_limits(0.84, own)),
        gait_params(stick, style, overrides, limits),
        gait_params(pointed_stick(stick, v, v, limits), style, limits)};
    for (std::size_t i = 0; i < all.size(); ++i) {
      Walking walk;
      walk.walk(all[i], 20);
      ++fed;
      EXPECT_TRUE(is_finite(walk.pose)) << "function " << i << ", " << v;
      if (check(all[i])) {
        EXPECT_GT(walk.state.bad_inputs, 0) << i;
      }
    }
  }
  Walking walk;
  const std::vector<int> joints = {-1, 0, 1'000'000, std::numeric_limits<int>::min()};
  for (const double v : {kNaN, kInfinity, -kInfinity}) {
    std::vector<float> out(64, 7.0f);
    std::array<float, 3> root_m{7.0f, 7.0f, 7.0f};
    const auto& skeleton = good_model().cycle.skeleton;
    EXPECT_EQ(write_rotations(walk.pose, {vec3(v), 0.0}, joints, out, root_m), 0);
    EXPECT_EQ(write_matrices(skeleton, walk.pose, {vec3(0.0), v}, joints, out), 0);
    EXPECT_EQ(out, std::vector<float>(64, 7.0f));
    Pose own = walk.pose;
    mix_pose(std::vector<float>(1000, static_cast<float>(v)), walk.pose, own);
    EXPECT_TRUE(is_finite(own)) << v;
    fed += 3;
  }
  std::vector<float> out(64);
  EXPECT_EQ(write_matrices(good_model().cycle.skeleton, walk.pose, {}, joints, out), 4);
  Simulation simulation = made_simulation(made_config(1));
  const char* const commands[] = {"",
                                  "set hip_sway nan",
                                  "set hip_sway inf",
                                  "set hip_sway 1e300",
                                  "gait",
                                  "set hip_sway -1",
                                  "gait speed_m_s nan",
                                  "gait turn_rate_rad_s 1e300",
                                  "style none",
                                  "style",
                                  "3 style even",
                                  "-1 style even",
                                  "points nan",
                                  "points 1e300",
                                  "ik best",
                                  "\x01\xff"};
  for (const char* command : commands) simulation.step(std::vector{made_command(command)});
  EXPECT_EQ(simulation.counts().bad_commands, std::int64_t(std::size(commands)));
  fed += static_cast<int>(std::size(commands));
  for (const std::uint16_t device : {1, 99, 0xffff}) {
    PadConfig config;
    simulation.set_pad(device, std::move(config));
    simulation.step(std::vector{made_report(0, 0, device)});
    fed += 2;
  }
  EXPECT_EQ(simulation.counts().bad_reports, 3);
  EXPECT_TRUE(is_finite(simulation.walkers()[0].pose));
}

TEST(BadValues, AreRefusedOrCountedByEveryFunction) {
  const struct {
    const char* name;
    void (*feed)();
  } parts[] = {{"motions", feed_motions},   {"cycles", feed_cycles},   {"styles", feed_styles},
               {"sessions", feed_sessions}, {"pads", feed_pads},       {"files", feed_files},
               {"terrains", feed_terrains}, {"solvers", feed_solvers}, {"walks", feed_walks},
               {"values", feed_values}};
  for (const auto& part : parts) {
    const int before = fed;
    part.feed();
    std::cout << part.name << ": " << fed - before << " bad values\n";
  }
  std::cout << "all: " << fed << " bad values\n";
  EXPECT_GE(fed, 300);
}

}  // namespace
}  // namespace gaitpad
