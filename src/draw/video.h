// Writes frames as a video, H.264 in MP4, with the program ffmpeg if it is installed.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "draw/picture.h"
#include "gaitpad/result.h"
#include "system/child_process.h"

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

  std::string path_, part_;
  ChildProcess ffmpeg_;
  int width_ = 0, height_ = 0;
};

}  // namespace gaitpad
