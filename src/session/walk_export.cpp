#include "session/walk_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace fs = std::filesystem;

Result<OutputFolder> OutputFolder::open(const std::string& folder) {
  OutputFolder opened(folder);
  std::error_code error;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, error); path = path.parent_path())
    opened.made_.push_back(path.string());
  fs::create_directories(folder, error);
  if (error) return Error{fmt::format("{}: cannot be made: {}", folder, error.message())};
  if (!fs::is_directory(folder, error)) return write_error(folder, ENOTDIR);
  return opened;
}

OutputFolder::~OutputFolder() {
  std::error_code is_not_empty;
  for (const std::string& path : made_) fs::remove(path, is_not_empty);
}

std::string OutputFolder::path_of(const std::string& name) const {
  return (fs::path(folder_) / name).string();
}

Result<OutputFiles> OutputFiles::open(const std::string& folder) {
  auto opened = OutputFolder::open(folder);
  if (!opened) return opened.error();
  return OutputFiles(std::move(*opened));
}

Result<std::ostream*> OutputFiles::add(const std::string& name) {
  auto file = NewFile::create(path_of(name));
  if (!file) return file.error();
  errno = 0;
  // A system call for 64 KB instead of 8 KB: a file of several MB takes half the time.
  constexpr std::size_t kBufferBytes = 1 << 16;
  std::unique_ptr<char[]> buffer(new char[kBufferBytes]);
  auto stream = std::make_unique<std::ofstream>();
  stream->rdbuf()->pubsetbuf(buffer.get(), kBufferBytes);
  stream->open(file->name_for_streams(), std::ios::binary);
  if (!*stream) return write_error(file->path(), errno);
  files_.push_back({std::move(*file), std::move(buffer), std::move(stream)});
  return files_.back().stream.get();
}

Result<std::fstream> OutputFiles::scratch() const {
  auto file = NewFile::create(path_of("scratch"));
  if (!file) return file.error();
  errno = 0;
  std::fstream stream(file->name_for_streams(),
                      std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc);
  if (!stream) return write_error(file->path(), errno);
  return stream;  // the stream keeps the file open although its name is deleted now
}

std::optional<Error> OutputFiles::publish() {
  for (const File& file : files_) {
    errno = 0;
    file.stream->close();
    if (file.stream->fail()) return write_error(file.file.path(), errno != 0 ? errno : EIO);
  }
  for (File& file : files_) {
    if (auto problem = file.file.publish()) return problem;
  }
  return std::nullopt;
}

namespace {

// Each value is written with a comma behind it; that of the last becomes the end of the line. They
// return the end.
char* put(double value, char* out) {
  out = put_fixed(out, value + 0.0, 9);  // adding 0.0 avoids "-0"
  *out++ = ',';
  return out;
}
char* put(const vec3& place_m, char* out) {
  return put(place_m.z, put(place_m.y, put(place_m.x, out)));
}
char* put(std::string_view word, char* out) {
  out = std::copy(word.begin(), word.end(), out);
  *out++ = ',';
  return out;
}
char* put(std::int64_t count, char* out) {
  out = std::to_chars(out, out + kMostFixedBytes, count).ptr;
  *out++ = ',';
  return out;
}
char* put(int count, char* out) { return put(std::int64_t{count}, out); }
char* put(bool yes, char* out) { return put(std::string_view(yes ? "1" : "0"), out); }

struct FramesRow {
  std::int64_t tick;
  int rate_hz;
  const Stick& stick;
  const WalkFrame& frame;
};

constexpr std::string_view kStageNames[] = {"idle", "flight", "roll"};

std::string_view swing_name(const WalkFrame& frame) {
  if (frame.stage == Stage::idle) return "none";
  return kSideNames[frame.swing];
}

// One number or word of a row, or the three of a place.
struct FramesColumn {
  std::string_view names;
  char* (*put_value)(const FramesRow& row, char* out);
};

template <auto member>
constexpr FramesColumn whole(std::string_view names) {
  return {names, [](const FramesRow& row, char* out) { return put(row.frame.*member, out); }};
}
template <auto member>
constexpr FramesColumn left(std::string_view names) {
  return {names,
          [](const FramesRow& row, char* out) { return put((row.frame.*member)[kLeftSide], out); }};
}
template <auto member>
constexpr FramesColumn right(std::string_view names) {
  return {names, [](const FramesRow& row, char* out) {
            return put((row.frame.*member)[kRightSide], out);
          }};
}

constexpr FramesColumn kFramesColumns[] = {
    {"tick", [](const FramesRow& row, char* out) { return put(row.tick, out); }},
    {"time_s", [](const FramesRow& row,
                  char* out) { return put(static_cast<double>(row.tick) / row.rate_hz, out); }},
    {"stick_x", [](const FramesRow& row, char* out) { return put(row.stick.left.x, out); }},
    {"stick_y", [](const FramesRow& row, char* out) { return put(row.stick.left.y, out); }},
    left<&WalkFrame::stride_m>("stride_left_m"),
    right<&WalkFrame::stride_m>("stride_right_m"),
    whole<&WalkFrame::speed_m_s>("speed_m_s"),
    whole<&WalkFrame::turn_rate_rad_s>("turn_rate_rad_s"),
    whole<&WalkFrame::heading_rad>("heading_rad"),
    whole<&WalkFrame::pelvis_m>("root_x_m,root_y_m,root_z_m"),
    {"stage", [](const FramesRow& row,
                 char* out) { return put(kStageNames[static_cast<int>(row.frame.stage)], out); }},
    {"swing", [](const FramesRow& row, char* out) { return put(swing_name(row.frame), out); }},
    left<&WalkFrame::heel_planted>("left_heel_planted"),
    left<&WalkFrame::toe_planted>("left_toe_planted"),
    right<&WalkFrame::heel_planted>("right_heel_planted"),
    right<&WalkFrame::toe_planted>("right_toe_planted"),
    left<&WalkFrame::heel_m>("left_heel_x_m,left_heel_y_m,left_heel_z_m"),
    left<&WalkFrame::toe_m>("left_toe_x_m,left_toe_y_m,left_toe_z_m"),
    right<&WalkFrame::heel_m>("right_heel_x_m,right_heel_y_m,right_heel_z_m"),
    right<&WalkFrame::toe_m>("right_toe_x_m,right_toe_y_m,right_toe_z_m"),
    left<&WalkFrame::ik_iterations>("left_ik_iterations"),
    right<&WalkFrame::ik_iterations>("right_ik_iterations"),
    left<&WalkFrame::ik_error_m>("left_ik_error_m"),
    right<&WalkFrame::ik_error_m>("right_ik_error_m"),
    left<&WalkFrame::heel_ground_m>("left_heel_ground_m"),
    left<&WalkFrame::toe_ground_m>("left_toe_ground_m"),
    right<&WalkFrame::heel_ground_m>("right_heel_ground_m"),
    right<&WalkFrame::toe_ground_m>("right_toe_ground_m"),
};

}  // namespace

void append_frames_header(std::string& out) {
  for (const FramesColumn& column : kFramesColumns) {
    out += column.names;
    out += ',';
  }
  out.back() = '\n';
}

void append_frames_row(std::int64_t tick, int rate_hz, const Stick& stick, const WalkFrame& frame,
                       std::string& out) {
  constexpr std::size_t kMostNumbers = 3 * std::size(kFramesColumns);
  std::array<char, kMostNumbers*(kMostFixedBytes + 1)> text;
  const FramesRow row = {tick, rate_hz, stick, frame};
  char* end = text.data();
  for (const FramesColumn& column : kFramesColumns) end = column.put_value(row, end);
  end[-1] = '\n';
  out.append(text.data(), end);
}

namespace {

BvhLayout layout_of(const WalkModel& model, int fps) {
  const GaitCycle& cycle = model.cycle;
  BvhLayout layout;
  layout.metres_per_unit = cycle.metres_per_unit;
  layout.frame_time_s = 1.0 / fps;
  for (const LegBuild& leg : model.leg) {
    const int toe = leg.model.joints.toe;
    if (cycle.skeleton.joints[toe].is_end_site) layout.end_sites_as_joints.push_back(toe);
  }
  layout.orders = euler_orders(cycle.skeleton, cycle.local);
  return layout;
}

// The bind pose is the character standing at the origin.
GltfLayout gltf_layout(const Walker& walker, int fps) {
  const WalkModel& model = *walker.model;
  return {.name = walker.model->cycle.name,
          .fps = static_cast<double>(fps),
          .rest_local = model.cycle.standing_local,
          .rest_root_m = vec3(0.0, model.stand_m, 0.0)};
}

// True if a frame of the file shows this tick, that is, if a frame's time j / fps lies in (tick -
// 1, tick] ticks. The first frame shows tick 0.
bool is_shown(std::int64_t tick, int rate_hz, int fps) {
  const auto frames_until = [=](std::int64_t t) { return (t * fps + rate_hz) / rate_hz; };
  return tick == 0 || frames_until(tick) != frames_until(tick - 1);
}

// The heel in the frame of the ankle joint, as the files have it.
vec3 heel_offset_m(const LegModel& leg) { return glm::conjugate(leg.standing[2]) * leg.heel_m; }

WalkerSummary walker_summary(const Simulation& simulation, const Walker& walker) {
  const WalkModel& model = *walker.model;
  WalkerSummary s;
  s.motion = model.cycle.name;
  s.metres_per_unit = model.cycle.metres_per_unit;
  s.leg_length_m = model.leg_length_m;
  s.source_leg_length_m = model.source_leg_length_m;
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegModel& leg = model.leg[side].model;
    s.toe_joint[side] = model.cycle.skeleton.joints[leg.joints.toe].name;
    s.ankle_joint[side] = model.cycle.skeleton.joints[leg.joints.ankle].name;
    s.heel_offset_m[side] = heel_offset_m(leg);
    s.toe_rest_m[side] = leg.toe_rest_m;
    s.steps[side] = walk_steps(walker.state).steps[side];
  }
  s.style = simulation.styles()[walker.style].name;
  s.fatigue = walker.in_force.fatigue;
  s.ik_failures = walker.ik_failures;
  s.distance_m = walker.walked_m;
  return s;
}

}  // namespace

std::string numbered_name(const std::string& stem, const std::string& extension,
                          std::size_t walker) {
  if (walker == 0) return stem + extension;
  return fmt::format("{}-{}{}", stem, walker + 1, extension);
}

Result<WalkExport> WalkExport::open(OutputFiles& files, const Walker& walker, std::size_t index,
                                    const ExportFormat& format) {
  WalkExport e(walker, format);
  auto poses = files.add(numbered_name("pose", ".bvh", index));
  if (!poses) return poses.error();
  auto frames = files.add(numbered_name("frames", ".csv", index));
  if (!frames) return frames.error();
  auto summary = files.add(numbered_name("summary", ".json", index));
  if (!summary) return summary.error();
  e.frames_ = *frames;
  e.summary_ = *summary;
  e.poses_ = std::make_unique<BvhWriter>(**poses, walker.model->cycle.skeleton,
                                         layout_of(*walker.model, format.fps));
  if (format.with_gltf) {
    auto out = files.add(numbered_name("pose", ".glb", index));
    if (!out) return out.error();
    auto scratch = files.scratch();
    if (!scratch) return scratch.error();
    e.gltf_path_ = files.path_of(numbered_name("pose", ".glb", index));
    e.gltf_ = std::make_unique<GltfWriter>(**out, std::move(*scratch), walker.model->cycle.skeleton,
                                           gltf_layout(walker, format.fps));
  }
  append_frames_header(e.row_);
  return e;
}

void WalkExport::write(std::int64_t tick, const Stick& stick) {
  append_frames_row(tick, format_.rate_hz, stick, walk_frame(*walker_), row_);
  frames_->write(row_.data(), static_cast<std::streamsize>(row_.size()));
  row_.clear();
  if (!is_shown(tick, format_.rate_hz, format_.fps)) return;
  poses_->write(walker_->pose);
  if (gltf_) gltf_->write(walker_->pose);
}

std::optional<Error> WalkExport::finish(const nlohmann::ordered_json& summary) {
  // If the walk had no tick, the header is not written yet.
  frames_->write(row_.data(), static_cast<std::streamsize>(row_.size()));
  row_.clear();
  poses_->finish();
  // The motion's file name may be invalid UTF-8.
  *summary_ << summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << '\n';
  if (!gltf_) return std::nullopt;
  const auto problem = gltf_->finish();
  return problem ? std::optional(Error{gltf_path_ + ": " + *problem}) : std::nullopt;
}

RunSummary run_summary(const Simulation& simulation, const Cast& cast) {
  RunSummary run;
  run.motion = cast.motion;
  run.pace = cast.source->pace;
  run.rate_hz = cast.rate_hz;
  run.pose_hash = simulation.pose_hash();
  run.terrain = simulation.terrain()->name;
  run.terrain_scale = simulation.terrain_scale();
  const SimulationCounts& counts = simulation.counts();
  run.ticks = counts.ticks;
  run.crowd = simulation.followers().size();
  run.reports = counts.reports;
  run.bad_reports = counts.bad_reports;
  run.bad_commands = counts.bad_commands;
  for (std::size_t i = 0; i < simulation.walkers().size(); ++i) {
    run.walkers.push_back(walker_summary(simulation, simulation.walkers()[i]));
    run.walkers.back().character = cast.members[i].character;
  }
  return run;
}

ExportedFollower::ExportedFollower(const Simulation& simulation, int member)
    : member_(member), walker_(std::make_unique<Walker>()) {
  const Followers& followers = simulation.followers();
  walker_->model = followers.model(member);
  walker_->style = followers.style(member);
  walker_->state = followers.crowd().state(member);
  followers.crowd().copy_pose(member, walker_->pose);
}

void ExportedFollower::follow(const Simulation& simulation) noexcept {
  const Crowd& crowd = simulation.followers().crowd();
  const vec3 before_m = walker_->state.root.place_m;
  walker_->state = crowd.state(member_);
  crowd.copy_pose(member_, walker_->pose);
  const vec3 way_m = walker_->state.root.place_m - before_m;
  walker_->walked_m += glm::length(vec2(way_m.x, way_m.z));
  for (const float failed : walker_->state.walk.told.failed) walker_->ik_failures += failed != 0.0f;
}

WalkerSummary ExportedFollower::summary(const Simulation& simulation) const {
  WalkerSummary summary = walker_summary(simulation, *walker_);
  summary.character = fmt::format("crowd {}", member_ + 1);
  return summary;
}

nlohmann::ordered_json summary_json(const RunSummary& run, std::size_t walker) {
  return summary_json(run, run.walkers[walker]);
}

nlohmann::ordered_json summary_json(const RunSummary& run, const WalkerSummary& w) {
  const auto list = [](const vec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json s;
  s["ticks"] = run.ticks;
  s["rate_hz"] = run.rate_hz;
  s["pose_hash"] = fmt::format("{:016x}", run.pose_hash);
  s["motion"] = w.motion;
  s["metres_per_unit"] = w.metres_per_unit;
  s["leg_length_m"] = w.leg_length_m;
  s["source_leg_length_m"] = w.source_leg_length_m;
  s["left_toe_joint"] = w.toe_joint[kLeftSide];
  s["right_toe_joint"] = w.toe_joint[kRightSide];
  s["left_ankle_joint"] = w.ankle_joint[kLeftSide];
  s["right_ankle_joint"] = w.ankle_joint[kRightSide];
  s["left_heel_offset_m"] = list(w.heel_offset_m[kLeftSide]);
  s["right_heel_offset_m"] = list(w.heel_offset_m[kRightSide]);
  s["left_toe_rest_m"] = w.toe_rest_m[kLeftSide];
  s["right_toe_rest_m"] = w.toe_rest_m[kRightSide];
  s["steps_left"] = w.steps[kLeftSide];
  s["steps_right"] = w.steps[kRightSide];
  s["terrain"] = run.terrain;
  s["terrain_scale"] = run.terrain_scale;
  s["pace"] = name_of(run.pace);
  s["style"] = w.style;
  s["fatigue"] = w.fatigue;
  s["ik_failures"] = w.ik_failures;
  s["reports"] = run.reports;
  s["bad_reports"] = run.bad_reports;
  s["bad_commands"] = run.bad_commands;
  s["damaged_lines"] = run.damaged_lines;
  if (run.crowd > 0) s["crowd"] = run.crowd;
  if (run.recording_lost > 0) s["recording_lost"] = run.recording_lost;
  return s;
}

}  // namespace gaitpad
