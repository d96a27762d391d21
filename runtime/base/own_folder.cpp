#include "runtime/base/own_folder.h"

#include <dlfcn.h>
#include <link.h>

#include <system_error>

namespace probe {

namespace fs = std::filesystem;

fs::path folder_of_program() {
  std::error_code error;
  const fs::path file = fs::read_symlink("/proc/self/exe", error);
  // A bundle's launcher starts its program as an argument of the loader that lies in the bundle.
  if (file.filename().string().starts_with("ld-linux")) return file.parent_path().parent_path() / "bin";
  return file.parent_path();
}

fs::path folder_of_code() {
  Dl_info info{};
  link_map* object = nullptr;
  void* here = reinterpret_cast<void*>(&folder_of_code);
  const int found = ::dladdr1(here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP);
  // The loader has no name for the program itself.
  if (found == 0 || object == nullptr || object->l_name == nullptr || *object->l_name == '\0')
    return folder_of_program();
  std::error_code error;
  const fs::path file = fs::canonical(object->l_name, error);
  return error ? fs::path() : file.parent_path();
}

std::vector<fs::path> own_places(std::string_view what) {
  std::vector<fs::path> places;
  if (const fs::path beside = folder_of_code(); !beside.empty())
    places.push_back((beside / ".." / what).lexically_normal());
  constexpr std::string_view kBuiltFrom = VLAPROBE_BUILT_FROM;
  if (!kBuiltFrom.empty()) places.push_back(fs::path(kBuiltFrom) / what);
  return places;
}

}  // namespace probe
