#include "runtime/base/asset_path.h"

#include <algorithm>
#include <cctype>

namespace probe {
namespace {

namespace fs = std::filesystem;

bool is_inside(const fs::path& file, const fs::path& root) {
  const fs::path inside = file.lexically_relative(root);
  return !inside.empty() && *inside.begin() != "..";
}

}  // namespace

std::string lower_extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

AssetFolder::AssetFolder(const fs::path& root) {
  std::error_code error;
  root_ = fs::absolute(root, error).lexically_normal();  // an empty path has none
  real_ = fs::canonical(root_, error);
  if (error) real_.clear();
}

Result<std::string> AssetFolder::resolve(const fs::path& folder, const std::string& written) const {
  const auto refuse = [&](std::string message) {
    return Failure{Fault::kAsset, std::move(message), written};
  };
  std::string relative = written;
  std::replace(relative.begin(), relative.end(), '\\', '/');
  const bool has_drive = relative.size() > 1 && relative[1] == ':';
  if (relative.empty() || relative.find('\0') != std::string::npos) return refuse("names no file");
  if (fs::path(relative).is_absolute() || has_drive || relative.find("://") != std::string::npos) {
    return refuse("paths must be relative to the file that names them");
  }
  const fs::path file = (fs::absolute(folder) / relative).lexically_normal();
  if (!is_inside(file, root_)) {
    return refuse("lies outside the asset folder " + root_.string());
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return refuse("there is no such file");
  // The asset folder itself may be a link; a file in it may not lead elsewhere.
  const fs::path real = fs::canonical(file, error);
  if (error || real_.empty() || !is_inside(real, real_)) {
    return refuse("is a link that leads out of the asset folder " + root_.string());
  }
  return file.string();
}

Result<std::string> resolve_inside(const fs::path& folder, const std::string& written,
                                   const fs::path& root) {
  return AssetFolder(root).resolve(folder, written);
}

}  // namespace probe
