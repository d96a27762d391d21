#include "runtime/assets/output_folder.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "runtime/base/sha256.h"

namespace probe::assets {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTemporary = ".tmp";  // and the process that writes it

// What processes left that were ended before they were done. A number that is another process's
// by now keeps its folder.
void remove_left_over(const fs::path& named) {
  const std::string stem = named.filename().string() + std::string(kTemporary);
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator at(named.parent_path(), error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(stem) || !at->is_directory()) continue;
    const std::string_view digits = std::string_view(name).substr(stem.size());
    ::pid_t process = 0;
    const auto [stop, wrong] =
        std::from_chars(digits.data(), digits.data() + digits.size(), process);
    if (wrong != std::errc() || stop != digits.data() + digits.size() || process <= 0) continue;
    if (::kill(process, 0) != 0 && errno == ESRCH) left.push_back(at->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, error);
}

}  // namespace

Result<OutputFolder> OutputFolder::create(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::absolute(path).lexically_normal();
  if (fs::exists(target, error) &&
      (!fs::is_directory(target, error) || !fs::is_empty(target, error))) {
    return Failure{Fault::kIo, "is there already; assets are written to a new folder", path};
  }
  // A name with a slash at its end has no last part.
  const fs::path named = target.has_filename() ? target : target.parent_path();
  remove_left_over(named);
  const std::string temporary =
      named.string() + std::string(kTemporary) + std::to_string(::getpid());
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
  if (error) {
    const bool is_taken = fs::exists(target_, error);
    return Failure{Fault::kIo,
                   is_taken ? "another process made this folder meanwhile"
                            : "cannot give the finished folder its name",
                   target_};
  }
  temporary_.clear();
  return {};
}

}  // namespace probe::assets
