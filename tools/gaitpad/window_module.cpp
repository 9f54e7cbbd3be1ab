#include "tools/gaitpad/window_module.h"

#ifdef GAITPAD_HAS_WINDOW
#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "base/text.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModuleFile = "gaitpad-window.so";

Result<const WindowModule*> loaded() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  fs::path file = folder / kModuleFile;
  if (!fs::exists(file, error)) file = folder / GAITPAD_MODULE_FOLDER / kModuleFile;
  // Never unloaded: threads of its libraries may still run at exit.
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) {
    const char* cause = ::dlerror();
    return Error{fmt::format("the window cannot be loaded: {}", printable(cause ? cause : ""))};
  }
  const auto* functions =
      static_cast<const WindowModule*>(::dlsym(module, "gaitpad_window_module"));
  if (functions == nullptr || std::string_view(functions->version) != GAITPAD_VERSION) {
    return Error{fmt::format("{}: is not the window of gaitpad {}", printable(file.string()),
                             GAITPAD_VERSION)};
  }
  return functions;
}

}  // namespace

Result<const WindowModule*> window_module() {
  static const Result<const WindowModule*> module = loaded();
  return module;
}

}  // namespace gaitpad
#endif
