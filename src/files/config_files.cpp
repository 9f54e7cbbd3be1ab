#include "gaitpad/config_files.h"

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
#include <map>

#include "drivers/posix.h"

namespace gaitpad {

namespace fs = std::filesystem;
namespace {

constexpr int kMaxLinks = 40;  // as the kernel follows

Error failure(const std::string& path, int number) {
  return Error{fmt::format("{}: cannot be written: {}", path, std::strerror(number))};
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

std::string user_config_folder() {
  const auto is_absolute = [](const char* path) { return path != nullptr && *path == '/'; };
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (is_absolute(config)) return std::string(config) + "/gaitpad";
  return is_absolute(home) ? std::string(home) + "/.config/gaitpad" : "";
}

std::optional<Error> saving_problem(const std::string& path) {
  const auto place = behind_links(path);
  if (!place) return place.error();
  std::error_code error;
  const fs::file_status status = fs::status(*place, error);
  if (fs::is_directory(status)) return failure(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return Error{path + ": this is no file, none can take its place"};
  fs::path folder = fs::absolute(*place, error).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error)) return failure(path, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return failure(path, errno);
  return std::nullopt;
}

std::optional<Error> save_text(const std::string& path, const std::string& text) {
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

namespace fs = std::filesystem;

std::vector<std::string> config_folders(const std::string& built_in) {
  std::vector<fs::path> candidates;
  if (const char* own = std::getenv("GAITPAD_CONFIG"); own != nullptr && *own != '\0') {
    candidates.emplace_back(own);
  }
  if (const std::string user = user_config_folder(); !user.empty()) candidates.emplace_back(user);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) {
    const fs::path beside = program.parent_path().parent_path();
    candidates.push_back(beside / "share" / "gaitpad");
    candidates.push_back(beside / "config");
  }
  if (!built_in.empty()) candidates.emplace_back(built_in);

  std::vector<std::string> folders;
  for (const fs::path& candidate : candidates) {
    if (fs::is_directory(candidate, ignored)) folders.push_back(candidate.string());
  }
  return folders;
}

std::vector<std::string> config_files(const std::vector<std::string>& folders,
                                      const std::string& kind) {
  std::map<std::string, std::string> by_name;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator it(fs::path(folder) / kind, error), end; !error && it != end;
         it.increment(error)) {
      if (it->path().extension() == ".toml") {
        by_name.emplace(config_name(it->path().string()), it->path().string());
      }
    }
  }
  std::vector<std::string> files;
  for (auto& [name, path] : by_name) files.push_back(std::move(path));
  return files;
}

Result<std::string> config_file(const std::vector<std::string>& folders, const std::string& kind,
                                const std::string& file_or_name) {
  if (file_or_name.find('/') != std::string::npos || file_or_name.ends_with(".toml")) {
    return file_or_name;
  }
  std::string known;
  for (const std::string& path : config_files(folders, kind)) {
    if (config_name(path) == file_or_name) return path;
    known += (known.empty() ? "" : ", ") + config_name(path);
  }
  if (known.empty()) known = "none found; set GAITPAD_CONFIG to the config folder";
  return Error{
      fmt::format("there is no \"{}\" in config/{} (known: {})", file_or_name, kind, known)};
}

std::string config_name(const std::string& path) { return fs::path(path).stem().string(); }

namespace {

constexpr std::size_t kMaxNameBytes = 48;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

Result<std::string> file_name(std::string name) {
  while (!name.empty() && name.back() == ' ') name.pop_back();
  name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
  std::ranges::replace(name, ' ', '_');
  if (name.empty()) return Error{"a style needs a name"};
  if (name.size() > kMaxNameBytes || !std::ranges::all_of(name, is_plain)) {
    return Error{
        fmt::format("a style's name is of at most {} letters, digits, _ and -", kMaxNameBytes)};
  }
  return name;
}

}  // namespace

Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values) {
  const auto plain = file_name(name);
  if (!plain) return plain.error();
  const std::string user = user_config_folder();
  if (user.empty())
    return Error{"neither XDG_CONFIG_HOME nor HOME names a folder for styles of your own"};
  std::vector<std::string> others = config_folders;
  std::erase(others, user);
  for (const std::string& path : config_files(others, "styles")) {
    if (config_name(path) != *plain) continue;
    return Error{
        fmt::format("there is a style \"{}\" already ({}): choose another name", *plain, path)};
  }
  Style style;
  static_cast<StyleValues&>(style) = values;
  style.name = *plain;
  const std::string path = fmt::format("{}/styles/{}.toml", user, *plain);
  if (auto problem = save_text(path, style_text(style))) return *problem;
  return path;
}

}  // namespace gaitpad
