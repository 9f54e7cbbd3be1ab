#include "session/calibration_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "base/hash.h"
#include "base/toml_scan.h"
#include "drivers/posix.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxKeyBytes = 48;           // of a file's name, between ids and ending
constexpr std::uint16_t kKernelArranged = 0x8000;  // of the version on evdev: config/README.md
constexpr int kMaxLinks = 40;                      // as the kernel follows

Error failure(const std::string& path, int number) {
  return Error{fmt::format("{}: cannot be written: {}", path, std::strerror(number))};
}

// Cheap pads have a serial number of zeros or blanks, or one that no text can hold.
std::string usable_id(const std::string& unique_id) {
  const bool is_blank = unique_id.find_first_not_of("0:-. \t") == std::string::npos;
  return is_blank || line_of_invalid_utf8(unique_id) != 0 ? "" : unique_id;
}

std::string text_hash(std::string_view text) {
  WordHash hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  hash.add(static_cast<double>(text.size()));
  return fmt::format("{:08x}", static_cast<std::uint32_t>(hash.value()));
}

// Fit for a file's name, and never the same for two texts: what was changed, or could be taken for
// one of our own endings, is followed by a hash.
std::string file_key(std::string_view text) {
  std::string key(text.substr(0, kMaxKeyBytes));
  for (char& c : key) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (!is_plain) c = '-';
  }
  const bool is_ambiguous = text.starts_with("port-") || text.ends_with("-evdev");
  return key == text && !is_ambiguous ? key : key + "-" + text_hash(text);
}

// Where a write to `path` ends up: the files of dotfile managers are symbolic links, and stay.
Result<std::string> behind_links(const std::string& path) {
  fs::path place = path;
  std::error_code error;
  for (int i = 0; fs::is_symlink(fs::symlink_status(place, error)); ++i) {
    const fs::path target = fs::read_symlink(place, error);
    if (error || i == kMaxLinks) return failure(path, error ? error.value() : ELOOP);
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  return place.string();
}

// A new file with this text, on the disk; 0 or errno.
int write_new(const std::string& path, std::string_view text) {
  ::unlink(path.c_str());  // a killed process may have had this number
  const OwnedFd file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (file.get() < 0) return errno;
  while (!text.empty()) {
    const ssize_t count = ::write(file.get(), text.data(), text.size());
    if (count > 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      return count == 0 ? EIO : errno;
    }
  }
  // Whatever close() could tell of lost bytes, this tells.
  return ::fsync(file.get()) == 0 ? 0 : errno;
}

// What stands at `place` also as PLACE.old, which is whole at any moment; 0 or errno.
int keep_old(const std::string& place, const std::string& temporary) {
  ::unlink(temporary.c_str());
  if (::link(place.c_str(), temporary.c_str()) != 0) {
    if (errno == ENOENT) return 0;  // nothing to keep
    std::error_code error;          // no hard links here
    if (!fs::copy_file(place, temporary, error)) return error ? error.value() : EIO;
  }
  const int problem = std::rename(temporary.c_str(), (place + ".old").c_str()) == 0 ? 0 : errno;
  // rename() does nothing where both are one file already: a save was killed between its two.
  ::unlink(temporary.c_str());
  return problem;
}

// The file is whole before and after a rename; this makes the rename itself outlast a power cut.
// Not every file system can, and nothing is lost where it cannot.
void sync_folder(const fs::path& folder) {
  const OwnedFd opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() >= 0) static_cast<void>(!::fsync(opened.get()));
}

std::string commented(const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) {
    std::string line = comment;
    const bool is_utf8 = line_of_invalid_utf8(line) == 0;
    for (char& c : line) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || byte == 0x7f || (byte >= 0x80 && !is_utf8)) c = '?';
    }
    text += line.empty() ? "#\n" : "# " + line + "\n";
  }
  return text;
}

// Under a temporary name beside `place`, then at once in its place; 0 or errno.
int put_in_place(const std::string& place, const std::string& text, std::string& blamed) {
  const fs::path folder = fs::path(place).parent_path();
  const std::string name = fs::path(place).filename().string();
  const std::string temporary = (folder / fmt::format(".{}.{}", name, ::getpid())).string();
  blamed = place;
  int problem = write_new(temporary, text);
  if (problem == 0) {
    problem = keep_old(place, temporary + ".old");
    if (problem != 0) blamed = place + ".old";
  }
  if (problem == 0 && std::rename(temporary.c_str(), place.c_str()) != 0) problem = errno;
  if (problem != 0) {
    ::unlink(temporary.c_str());
  } else {
    sync_folder(folder.empty() ? "." : folder);
  }
  return problem;
}

}  // namespace

std::string user_calibration_folder() {
  const auto is_absolute = [](const char* path) { return path != nullptr && *path == '/'; };
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (is_absolute(config)) return std::string(config) + "/gaitpad/calibration";
  return is_absolute(home) ? std::string(home) + "/.config/gaitpad/calibration" : "";
}

CalibrationFile calibration_for(const DeviceInfo& device, bool has_factory_sticks) {
  CalibrationFile file;
  file.name = device.name;
  file.devices = {{device.vendor, device.product}};
  file.unique_id = usable_id(device.unique_id);
  if (file.unique_id.empty() && line_of_invalid_utf8(device.physical_path) == 0)
    file.port = device.physical_path;
  const bool is_arranged = device.driver == "evdev" || device.driver == "sdl";
  if (is_arranged && (device.version & kKernelArranged) != 0) {
    file.drivers = {"evdev", "sdl"};
  } else if (!is_arranged && has_factory_sticks) {
    file.drivers = {"hidraw", "usb"};
  }
  return file;
}

std::string calibration_path(const std::string& folder, const CalibrationFile& file) {
  const auto id = [](int number) { return number < 0 ? "any" : fmt::format("{:04x}", number); };
  const DevicePattern device = file.devices.empty() ? DevicePattern() : file.devices.front();
  std::string name = id(device.vendor) + "_" + id(device.product);
  if (!file.unique_id.empty()) {
    name += "-" + file_key(file.unique_id);
  } else if (!file.port.empty()) {
    name += "-port-" + file_key(file.port);
  }
  const bool is_for_evdev = std::ranges::count(file.drivers, "evdev") > 0;
  return folder + "/" + name + (is_for_evdev ? "-evdev" : "") + ".toml";
}

std::optional<Error> saving_problem(const std::string& path) {
  const auto place = behind_links(path);
  if (!place) return place.error();
  std::error_code error;
  const fs::file_status status = fs::status(*place, error);
  if (fs::is_directory(status)) return failure(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return Error{path + ": this is no file, a calibration cannot take its place"};
  fs::path folder = fs::absolute(*place, error).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error)) return failure(path, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return failure(path, errno);
  return std::nullopt;
}

std::optional<Error> save_calibration(const std::string& path, const CalibrationFile& file,
                                      const std::vector<std::string>& comments) {
  const std::string text =
      commented(comments) + (comments.empty() ? "" : "\n") + calibration_text(file);
  // A file that could not be read back would be lost work, and told only at the next game.
  if (auto again = parse_calibration(text, path); !again)
    return Error{"was not saved, since it could not be read back: " + again.error().message};
  if (auto problem = saving_problem(path)) return problem;
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) return Error{fmt::format("{}: cannot be made: {}", folder.string(), error.message())};
  const auto place = behind_links(path);
  if (!place) return place.error();
  std::string blamed;
  if (const int problem = put_in_place(*place, text, blamed)) return failure(blamed, problem);
  return std::nullopt;
}

}  // namespace gaitpad
