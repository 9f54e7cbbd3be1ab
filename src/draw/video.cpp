#include "draw/video.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "system/whole_file.h"

namespace gaitpad {
namespace {

constexpr int kLargestVideo_px = 8192, kFastest_hz = 1000;

Error problem(const std::string& path, const std::string& cause) {
  return Error{fmt::format("{}: cannot be written: {}", path, cause)};
}

// H.264's usual pixel format needs even sizes, so odd edges are padded. Colours are those of HD
// video, which players assume at this size. `file:` keeps ffmpeg from reading a name as an address.
std::vector<std::string> arguments(const std::string& file, int width, int height,
                                   int frames_per_second) {
  return {"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
          // The options of the input.
          "-f", "rawvideo", "-pix_fmt", "rgba", "-video_size", fmt::format("{}x{}", width, height),
          "-framerate", std::to_string(frames_per_second), "-i", "pipe:0",
          // The options of the output.
          "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv", "-c:v",
          "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p", "-colorspace",
          "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-movflags", "+faststart",
          "-f", "mp4", "file:" + file};
}

// True if an MP4 is complete: its boxes fill it to the last byte, and one is `moov`, the index of
// its frames. On a full disk ffmpeg may write less and still exit with status 0.
bool is_whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t end = std::filesystem::file_size(path, error);
  bool has_index = false;
  for (std::uintmax_t at = 0; !error && file && at <= end;) {
    if (at == end) return has_index;
    std::array<unsigned char, 16> head{};  // size, name, and a 64-bit size if the first size is 1
    file.seekg(static_cast<std::streamoff>(at));
    file.read(reinterpret_cast<char*>(head.data()), head.size());
    file.clear();  // a read at the last box may end early: it may be shorter than 16 bytes
    const auto number = [&head](std::size_t first, std::size_t bytes) {
      std::uint64_t n = 0;
      for (std::size_t i = first; i < first + bytes; ++i) n = n << 8 | head[i];
      return n;
    };
    const std::uint64_t size = number(0, 4) == 1 ? number(8, 8) : number(0, 4);
    if (size < 8 || size > end - at) return false;
    has_index = has_index || std::memcmp(&head[4], "moov", 4) == 0;
    at += size;
  }
  return false;
}

}  // namespace

std::optional<Error> VideoWriter::problem_of(const std::string& path) {
  if (!is_in_path("ffmpeg"))
    return problem(path, "ffmpeg is not installed; run: sudo apt-get install ffmpeg");
  return saving_problem(path);
}

Result<std::unique_ptr<VideoWriter>> VideoWriter::open(const std::string& path, int width,
                                                       int height, int frames_per_second) {
  if (width < 1 || height < 1 || width > kLargestVideo_px || height > kLargestVideo_px ||
      frames_per_second < 1 || frames_per_second > kFastest_hz) {
    return problem(path, fmt::format("a video of {} x {} pixels, {} a second", width, height,
                                     frames_per_second));
  }
  if (auto error = problem_of(path)) return std::move(*error);
  std::unique_ptr<VideoWriter> writer(new VideoWriter);
  writer->path_ = path;
  writer->width_ = width;
  writer->height_ = height;
  if (auto error = writer->start(frames_per_second)) return std::move(*error);
  return writer;
}

std::optional<Error> VideoWriter::start(int frames_per_second) {
  // Create the file here first, so that a missing folder is reported at once, and not by ffmpeg.
  remove_leftovers(path_);
  const std::string part = temporary_beside(path_);
  std::FILE* file = std::fopen(part.c_str(), "wx");
  if (file == nullptr) return problem(path_, std::strerror(errno));
  std::fclose(file);
  part_ = part;
  if (auto error = ffmpeg_.start(arguments(part_, width_, height_, frames_per_second)))
    return problem(path_, error->message);
  return std::nullopt;
}

VideoWriter::~VideoWriter() {
  ffmpeg_.kill();  // first, for it might create the file again
  std::error_code ignored;
  if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

// The error after ffmpeg has stopped reading or failed.
Error VideoWriter::failure() {
  ffmpeg_.wait_for_end();
  const std::string words = drawable(ffmpeg_.last_line());
  if (!words.empty()) return problem(path_, "ffmpeg says: " + words);
  const auto status = ffmpeg_.exit_status();
  if (!status)
    return problem(path_, fmt::format("ffmpeg was ended by signal {}", ffmpeg_.ending_signal()));
  if (*status == 0) return problem(path_, "the disk took only a part of it");
  return problem(path_, fmt::format("ffmpeg ended with status {}", *status));
}

std::optional<Error> VideoWriter::add(const Pixels& pixels) {
  if (!ffmpeg_.has_input()) return problem(path_, "the video is finished already");
  if (pixels.width != width_ || pixels.height != height_ ||
      pixels.rgba.size() != std::size_t{4} * width_ * height_) {
    return problem(path_, fmt::format("a picture of {} x {} pixels in a video of {} x {}",
                                      pixels.width, pixels.height, width_, height_));
  }
  if (!ffmpeg_.write(pixels.rgba)) return failure();
  return std::nullopt;
}

std::optional<Error> VideoWriter::finish() {
  if (!ffmpeg_.has_input()) return problem(path_, "the video is finished already");
  ffmpeg_.wait_for_end();
  if (ffmpeg_.exit_status() != 0 || !is_whole(part_)) return failure();
  if (std::rename(part_.c_str(), path_.c_str()) != 0) return problem(path_, std::strerror(errno));
  part_.clear();
  return std::nullopt;
}

}  // namespace gaitpad
