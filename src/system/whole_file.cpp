#include "system/whole_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "base/text.h"
#include "system/descriptors.h"

namespace gaitpad {

namespace fs = std::filesystem;
namespace {

constexpr int kMaxLinks = 40;  // most links that the kernel follows

// The file that a write to `path` replaces: the target of its symbolic links, which dotfile
// managers use.
Result<std::string> target_of_links(const std::string& path) {
  fs::path place = path;
  std::error_code error;
  for (int i = 0; fs::is_symlink(fs::symlink_status(place, error)); ++i) {
    const fs::path target = fs::read_symlink(place, error);
    if (error || i == kMaxLinks) return write_error(path, error ? error.value() : ELOOP);
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  return place.string();
}

std::optional<Error> make_folder(const fs::path& folder) {
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (!error) return std::nullopt;
  return Error{folder.string() + ": cannot be created: " + error.message()};
}

const char* kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a FIFO";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "something else";
  }
}

int rename_file(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

// Keeps the previous version as PLACE.old; the swap is atomic. Returns 0 or errno.
int keep_old(const std::string& place) {
  const std::string temporary = temporary_beside(place);
  if (::link(place.c_str(), temporary.c_str()) != 0) {
    if (errno == ENOENT) return 0;  // nothing to keep
    std::error_code error;          // this file system has no hard links
    if (!fs::copy_file(place, temporary, error)) return error ? error.value() : EIO;
  }
  const int problem = rename_file(temporary, place + ".old");
  // If an earlier save was killed between its two renames, both names are the same file: rename()
  // then does nothing and leaves the temporary name.
  ::unlink(temporary.c_str());
  return problem;
}

// Makes a rename survive a power cut. Errors are ignored: some file systems cannot sync a folder,
// and the file is complete with or without the rename.
void sync_folder(const fs::path& folder) {
  const int opened =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return;
  static_cast<void>(!::fsync(opened));
  ::close(opened);
}

}  // namespace

std::optional<Error> no_file_problem(const std::string& path) {
  std::error_code code;
  const auto status = fs::status(path, code);
  if (!fs::exists(status)) return Error{printable(path) + ": no such file"};
  if (!fs::is_regular_file(status))
    return Error{printable(path) + ": not a regular file (" + kind_of(status.type()) + ")"};
  constexpr long kProc = 0x9fa0, kSys = 0x62656572, kDebug = 0x64626720, kTrace = 0x74726163;
  struct statfs system {};
  if (::statfs(path.c_str(), &system) != 0) return std::nullopt;
  for (const long kernel : {kProc, kSys, kDebug, kTrace}) {
    if (static_cast<long>(system.f_type) == kernel)
      return Error{printable(path) + ": not a regular file (the kernel makes it up)"};
  }
  return std::nullopt;
}

Result<std::string> file_text(const std::string& path, std::size_t max_bytes) {
  const auto failure = [&](const std::string& cause) { return Error{printable(path) + cause}; };
  std::error_code code;
  if (auto problem = no_file_problem(path)) return *problem;
  const std::string too_large = ": larger than " + std::to_string(max_bytes) + " bytes";
  const auto size = fs::file_size(path, code);
  if (!code && size > max_bytes) return failure(too_large);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return failure(": cannot be opened for reading");
  std::string text;
  if (!code) text.reserve(size);
  constexpr std::streamsize kBlock = 1 << 16;
  const auto block = std::make_unique_for_overwrite<char[]>(kBlock);
  while (stream && text.size() <= max_bytes) {
    stream.read(block.get(), kBlock);
    text.append(block.get(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) return failure(": reading failed");
  if (text.size() > max_bytes) return failure(too_large);  // the file grew while it was read
  return text;
}

namespace {

constexpr std::size_t kNumberDigits = 16;

// The process id in the end of a temporary name, after `.NAME.`: `PID.NUMBER`, or `PID` and
// `PID.old` of earlier versions. Empty for other names.
std::optional<pid_t> process_of(std::string_view end) {
  const std::string_view process = end.substr(0, end.find('.'));
  end.remove_prefix(process.size());
  const bool is_numbered = end.size() == 1 + kNumberDigits &&
                           end.find_first_not_of("0123456789abcdef", 1) == std::string_view::npos;
  if (!end.empty() && end != ".old" && !is_numbered) return std::nullopt;
  return parse_number<pid_t>(process);
}

}  // namespace

std::string temporary_beside(const std::string& path) {
  std::uint64_t number = 0;
  // Do not wait for randomness soon after a boot: O_EXCL prevents collisions anyway.
  constexpr unsigned kWithoutWaiting = 4;  // GRND_INSECURE, from Linux 5.6 on
  if (::getrandom(&number, sizeof number, kWithoutWaiting) != sizeof number)
    number = std::uint64_t(std::chrono::steady_clock::now().time_since_epoch().count());
  std::array<char, kNumberDigits + 1> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(number));
  const fs::path place(path);
  const std::string name = "." + place.filename().string() + "." + std::to_string(::getpid());
  return (place.parent_path() / (name + "." + digits.data())).string();
}

void remove_leftovers(const std::string& path) {
  const fs::path place(path);
  const std::string begin = "." + place.filename().string() + ".";
  std::error_code error;
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(begin)) continue;
    const auto process = process_of(std::string_view(name).substr(begin.size()));
    if (!process || *process <= 0 || ::kill(*process, 0) == 0 || errno != ESRCH) continue;
    ::unlink(it->path().c_str());
  }
}

Error write_error(const std::string& path, int number) {
  return Error{path + ": cannot be written: " + std::strerror(number)};
}

Result<NewFile> NewFile::create(const std::string& path) {
  remove_leftovers(path);
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return write_error(path, EISDIR);
  // An unnamed file leaves nothing behind if the process is killed. Not every file system has them.
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  const int unnamed = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
  if (unnamed >= 0) return NewFile(path, "", unnamed);
  std::string temporary = temporary_beside(path);
  const int fd =
      ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (fd < 0) return write_error(path, errno);
  return NewFile(path, std::move(temporary), fd);
}

NewFile::NewFile(NewFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      fd_(std::exchange(other.fd_, -1)) {}

NewFile::~NewFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

std::optional<Error> NewFile::write(std::string_view bytes) {
  const int problem = write_all(fd_, bytes);
  return problem == 0 ? std::nullopt : std::optional(write_error(path_, problem));
}

// fsync() reports lost bytes that close() might not.
std::optional<Error> NewFile::write_to_disk() {
  return ::fsync(fd_) == 0 ? std::nullopt : std::optional(write_error(path_, errno));
}

std::optional<Error> NewFile::publish() {
  if (temporary_.empty()) {
    const std::string name = temporary_beside(path_);
    if (::linkat(AT_FDCWD, name_for_streams().c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) !=
        0)
      return write_error(path_, errno);
    temporary_ = name;
  }
  if (::close(std::exchange(fd_, -1)) != 0) return write_error(path_, errno);
  if (const int problem = rename_file(temporary_, path_); problem != 0)
    return write_error(path_, problem);
  temporary_.clear();
  return std::nullopt;
}

Result<FolderLock> FolderLock::wait(const std::string& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  if (auto problem = make_folder(folder)) return *problem;
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return write_error(path, errno);
  while (::flock(fd, LOCK_EX) != 0 && errno == EINTR) {
  }
  return FolderLock(fd);
}

FolderLock::~FolderLock() {
  if (fd_ >= 0) ::close(fd_);
}

std::optional<Error> write_file(const std::string& path, std::string_view bytes) {
  const fs::path place(path);
  if (!place.has_filename()) return Error{path + ": is not a file name"};
  if (auto problem = make_folder(place.parent_path())) return problem;
  auto file = NewFile::create(path);
  if (!file) return file.error();
  if (auto problem = file->write(bytes)) return problem;
  return file->publish();
}

std::optional<Error> saving_problem(const std::string& path) {
  const auto place = target_of_links(path);
  if (!place) return place.error();
  std::error_code error;
  const fs::file_status status = fs::status(*place, error);
  if (fs::is_directory(status)) return write_error(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return Error{path + ": not a regular file, so it cannot be replaced"};
  fs::path folder = fs::absolute(*place, error).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error)) return write_error(path, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return write_error(path, errno);
  return std::nullopt;
}

std::optional<Error> save_text(const std::string& path, std::string_view text) {
  if (auto problem = saving_problem(path)) return problem;
  if (auto problem = make_folder(fs::path(path).parent_path())) return problem;
  const auto place = target_of_links(path);
  if (!place) return place.error();
  auto file = NewFile::create(*place);
  if (!file) return file.error();
  if (auto problem = file->write(text)) return problem;
  if (auto problem = file->write_to_disk()) return problem;
  if (const int problem = keep_old(*place); problem != 0)
    return write_error(*place + ".old", problem);
  if (auto problem = file->publish()) return problem;
  sync_folder(fs::path(*place).parent_path());
  return std::nullopt;
}

}  // namespace gaitpad
