#include "draw/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files.h"

namespace gaitpad {
namespace {

constexpr int kLargestVideo_px = 8192, kFastest_hz = 1000;

void close_fd(int& fd) noexcept {
  if (fd >= 0) ::close(std::exchange(fd, -1));
}

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

// ffmpeg gets its own process group, so that Ctrl-C reaches only this program, which then finishes
// the file. No signal is blocked in ffmpeg.
int spawn(std::vector<std::string> words, int input, int log, int& process) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, log, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, log, STDERR_FILENO);
  sigset_t none, defaults;
  ::sigemptyset(&none);
  ::sigemptyset(&defaults);
  ::sigaddset(&defaults, SIGPIPE);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &defaults);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int cause = ::posix_spawnp(&process, argv[0], &files, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return cause;
}

// The last line that ffmpeg printed, which names the cause; empty if it printed nothing.
std::string last_words(int log) {
  constexpr off_t kEnough = 400;
  const off_t size = ::lseek(log, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, kEnough)), '\0');
  const ssize_t count = ::pread(log, text.data(), text.size(), std::max<off_t>(size - kEnough, 0));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  text.erase(0, text.find_last_of("\r\n") + 1);
  return drawable(text);
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

bool is_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path != nullptr ? path : "";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    const std::string file = fmt::format("{}/{}", folder.empty() ? "." : folder, program);
    if (::access(file.c_str(), X_OK) == 0) return true;
    folders.remove_prefix(std::min(folder.size() + 1, folders.size()));
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
  int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) return problem(path_, std::strerror(errno));
  close_fd(file);
  part_ = part;
  // Use a socket instead of a pipe: send() accepts MSG_NOSIGNAL, so that ffmpeg's end does not kill
  // this program.
  int ends[2] = {-1, -1};
  log_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  if (log_ < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return problem(path_, std::strerror(errno));
  }
  link_ = ends[0];
  const int cause =
      spawn(arguments(part_, width_, height_, frames_per_second), ends[1], log_, process_);
  close_fd(ends[1]);
  if (cause == 0) return std::nullopt;
  process_ = -1;
  return problem(path_, fmt::format("ffmpeg does not start: {}", std::strerror(cause)));
}

VideoWriter::~VideoWriter() {
  close_fd(link_);
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  close_fd(log_);
  std::error_code ignored;
  if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

bool VideoWriter::has_ended_well() {
  close_fd(link_);
  while (process_ > 0 && ::waitpid(process_, &exit_status_, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  return WIFEXITED(exit_status_) && WEXITSTATUS(exit_status_) == 0 && is_whole(part_);
}

// The error after ffmpeg has stopped reading or failed.
Error VideoWriter::failure() {
  has_ended_well();
  const std::string words = last_words(log_);
  if (!words.empty()) return problem(path_, "ffmpeg says: " + words);
  if (WIFSIGNALED(exit_status_)) {
    return problem(path_, fmt::format("ffmpeg was ended by signal {}", WTERMSIG(exit_status_)));
  }
  if (WEXITSTATUS(exit_status_) == 0) return problem(path_, "the disk took only a part of it");
  return problem(path_, fmt::format("ffmpeg ended with status {}", WEXITSTATUS(exit_status_)));
}

std::optional<Error> VideoWriter::add(const Pixels& pixels) {
  if (link_ < 0) return problem(path_, "the video is finished already");
  if (pixels.width != width_ || pixels.height != height_ ||
      pixels.rgba.size() != std::size_t{4} * width_ * height_) {
    return problem(path_, fmt::format("a picture of {} x {} pixels in a video of {} x {}",
                                      pixels.width, pixels.height, width_, height_));
  }
  std::size_t sent = 0;
  while (sent < pixels.rgba.size()) {
    const ssize_t count =
        ::send(link_, pixels.rgba.data() + sent, pixels.rgba.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return failure();
    sent += static_cast<std::size_t>(count);
  }
  return std::nullopt;
}

std::optional<Error> VideoWriter::finish() {
  if (link_ < 0) return problem(path_, "the video is finished already");
  if (!has_ended_well()) return failure();
  if (std::rename(part_.c_str(), path_.c_str()) != 0) return problem(path_, std::strerror(errno));
  part_.clear();
  return std::nullopt;
}

}  // namespace gaitpad
