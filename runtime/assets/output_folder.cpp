#include "runtime/assets/output_folder.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/sha256.h"

namespace probe::assets {

namespace fs = std::filesystem;

Result<OutputFolder> OutputFolder::create(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::absolute(path).lexically_normal();
  if (fs::exists(target, error) &&
      (!fs::is_directory(target, error) || !fs::is_empty(target, error))) {
    return Failure{Fault::kIo, "is there already; assets are written to a new folder", path};
  }
  // A name with a slash at its end has no last part.
  const fs::path named = target.has_filename() ? target : target.parent_path();
  const std::string temporary = named.string() + ".tmp" + std::to_string(::getpid());
  fs::create_directories(temporary, error);
  if (error) return Failure{Fault::kIo, "cannot make the folder: " + error.message(), temporary};
  return OutputFolder(named.string(), temporary);
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, std::string())),
      manifest_(std::move(other.manifest_)) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

Status OutputFolder::write(const std::string& path, std::string_view bytes,
                           const std::string& source) {
  const fs::path file = fs::path(temporary_) / path;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) return Failure{Fault::kIo, "cannot write the file", file.string()};
  manifest_.files[path] = {bytes.size(), to_hex(sha256(bytes)), source};
  return {};
}

std::uint64_t OutputFolder::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [path, entry] : manifest_.files) sum += entry.bytes;
  return sum;
}

Status OutputFolder::finish(bool with_manifest) {
  if (with_manifest) {
    std::ofstream out(fs::path(temporary_) / "manifest.json", std::ios::binary);
    out << manifest_.to_json();
    out.close();
    if (!out) return Failure{Fault::kIo, "cannot write the manifest", temporary_};
  }
  std::error_code error;
  fs::remove(target_, error);  // an empty folder of that name
  fs::rename(temporary_, target_, error);
  if (error)
    return Failure{Fault::kIo, "cannot rename the finished folder: " + error.message(), target_};
  temporary_.clear();
  return {};
}

}  // namespace probe::assets
