// Writes frames as a video, H.264 in MP4, with the program ffmpeg if it is installed.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "draw/picture.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Writes to a file beside `path`, which finish() renames. Until then, and on error, the old file is
// unchanged. Errors end with ffmpeg's own message.
class VideoWriter {
 public:
  // The reason why no video can be written to `path`, if it is known before the start.
  static std::optional<Error> problem_of(const std::string& path);
  static Result<std::unique_ptr<VideoWriter>> open(const std::string& path, int width, int height,
                                                   int frames_per_second);
  ~VideoWriter();                                  // Removes the file unless finish() succeeded.
  std::optional<Error> add(const Pixels& pixels);  // Adds a frame; waits while ffmpeg is behind.
  std::optional<Error> finish();                   // Ends the file; waits for ffmpeg's end.

 private:
  VideoWriter() = default;
  std::optional<Error> start(int frames_per_second);
  Error failure();
  bool has_ended_well();

  std::string path_, part_;
  int link_ = -1;     // socket to ffmpeg's standard input; -1: closed
  int log_ = -1;      // file that receives ffmpeg's standard error; -1: none
  int process_ = -1;  // ffmpeg; -1: not started, or already waited for
  int exit_status_ = -1;
  int width_ = 0, height_ = 0;
};

}  // namespace gaitpad
