#include "runtime/assets/output_folder.h"

#include <signal.h>
#include <unistd.h>

#include <array>
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
// In a folder that is being made: the machine of that process, whose number is another's elsewhere.
constexpr const char* kMarker = ".vlaprobe_writes";

std::string this_machine() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : "";
}

bool is_written_here(const fs::path& folder) {
  std::ifstream file(folder / kMarker, std::ios::binary);
  std::string said;
  return file && std::getline(file, said) && !said.empty() && said == this_machine();
}

// What processes of this machine left that were ended before they were done. A number that is
// another process's by now keeps its folder, and so does what another machine that sees the same
// disk may still write.
void remove_left_over(const fs::path& named) {
  const std::string stem = named.filename().string() + std::string(kTemporary);
  std::error_code error, unknown;
  std::vector<fs::path> left;
  for (fs::directory_iterator at(named.parent_path(), error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(stem) || !fs::is_directory(at->path(), unknown)) continue;
    const std::string_view digits = std::string_view(name).substr(stem.size());
    ::pid_t process = 0;
    const auto [stop, wrong] =
        std::from_chars(digits.data(), digits.data() + digits.size(), process);
    if (wrong != std::errc() || stop != digits.data() + digits.size() || process <= 0) continue;
    if (is_written_here(at->path()) && ::kill(process, 0) != 0 && errno == ESRCH)
      left.push_back(at->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, error);
}

}  // namespace

Result<OutputFolder> OutputFolder::create(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::absolute(path).lexically_normal();
  if (fs::exists(target, error) &&
      (!fs::is_directory(target, error) || !fs::is_empty(target, error))) {
    return Failure{
        Fault::kIo,
        "is there already; assets are written to a new folder: remove it, or name another with -o",
        path};
  }
  // A name with a slash at its end has no last part.
  const fs::path named = target.has_filename() ? target : target.parent_path();
  remove_left_over(named);
  const std::string temporary =
      named.string() + std::string(kTemporary) + std::to_string(::getpid());
  fs::create_directories(temporary, error);
  if (error) return Failure{Fault::kIo, "cannot make the folder: " + error.message(), temporary};
  OutputFolder made(named.string(), temporary);
  const std::string marker = (fs::path(temporary) / kMarker).string();
  std::ofstream out(marker, std::ios::binary);
  out << this_machine() << '\n';
  out.close();
  if (!out) return Failure{Fault::kIo, "cannot write the file", marker};
  return made;
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
  fs::remove(fs::path(temporary_) / kMarker, error);
  if (error) return Failure{Fault::kIo, "cannot finish the folder: " + error.message(), temporary_};
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
