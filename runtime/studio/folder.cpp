#include "runtime/studio/folder.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/base/utf8.h"

namespace probe::studio {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".probe";
constexpr std::size_t kMostTexts = 1000, kMostLooked = 50000;

Sha256 hash_of(const Result<std::string>& text) { return text ? sha256(*text) : Sha256{}; }

}  // namespace

Result<std::unique_ptr<Folder>> Folder::of(const std::string& file) {
  if (!file.ends_with(kEnding))
    return Failure{Fault::kUsage, "a text of the studio ends in `.probe`", file};
  std::error_code error;
  const fs::path path = fs::absolute(file, error).lexically_normal();
  if (fs::is_directory(path, error)) return Failure{Fault::kUsage, "is a folder", file};
  const fs::path root = fs::canonical(path.parent_path(), error);
  if (error) return Failure{Fault::kUsage, "its folder is not there", file};
  const std::string whole = (root / path.filename()).string();
  auto folder = std::unique_ptr<Folder>(new Folder(root.string(), whole));
  if (!folder->has(whole))
    return Failure{Fault::kUsage, "is a link to a file of another folder", file};
  return folder;
}

std::vector<std::string> Folder::texts() const {
  std::vector<std::string> out;
  std::error_code error;
  std::size_t looked = 0;
  fs::recursive_directory_iterator at(root_, fs::directory_options::skip_permission_denied, error);
  for (const fs::recursive_directory_iterator end; !error && at != end; at.increment(error)) {
    if (++looked > kMostLooked || out.size() >= kMostTexts) break;
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (at->is_directory(ignored) && (name.starts_with('.') || name == "node_modules"))
      at.disable_recursion_pending();
    if (name.ends_with(kEnding) && at->is_regular_file(ignored)) out.push_back(at->path().string());
  }
  std::ranges::sort(out);
  return out;
}

bool Folder::has(const std::string& path) const {
  if (!path.starts_with('/') || !path.ends_with(kEnding) || path.find('\0') != path.npos)
    return false;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path, error);
  if (error) return false;
  const std::string prefix = root_.ends_with('/') ? root_ : root_ + "/";
  return whole.string().starts_with(prefix) && whole.string().ends_with(kEnding);
}

Status Folder::check(const std::string& path) const {
  if (has(path)) return {};
  return Failure{Fault::kUsage, "is no text of the folder " + root_, path};
}

Result<Folder::Text> Folder::open(const std::string& path) {
  PROBE_TRY(check(path));
  const std::lock_guard lock(mutex_);
  if (!is_there(path)) {
    known_[path] = Sha256{};
    return Text{"", true};
  }
  PROBE_ASSIGN(std::string text, read_file(path, {.most = kLargest}));
  if (find_bad_utf8(text) != text.size())
    return Failure{Fault::kIo, "is no UTF-8, and an editor would alter it", path};
  known_[path] = sha256(text);
  return Text{std::move(text), false};
}

Status Folder::save(const std::string& path, const std::string& text, bool over) {
  PROBE_TRY(check(path));
  if (text.size() > kLargest) {
    return Failure{Fault::kUsage,
                   "is larger than the " + std::to_string(kLargest >> 20) + " MB of a text", path};
  }
  const std::lock_guard lock(mutex_);
  const Sha256 now = is_there(path) ? hash_of(read_file(path, {.most = kLargest})) : Sha256{};
  const auto known = known_.find(path);
  if (!over && now != (known == known_.end() ? Sha256{} : known->second))
    return Failure{Fault::kUsage, "was changed on the disk meanwhile", path};
  PROBE_TRY(write_file(path, std::as_bytes(std::span(text))));
  known_[path] = sha256(text);
  return {};
}

std::string Folder::table_name(int number) const {
  return fs::path(file_).stem().string() + "_kept_" + std::to_string(number) + ".csv";
}

Result<int> Folder::keep_table(const std::string& table) {
  const std::lock_guard lock(mutex_);
  int number = 1;
  while (is_there(root_ + "/" + table_name(number))) ++number;
  PROBE_ASSIGN(const std::string file, file_inside(root_, table_name(number)));
  PROBE_TRY(write_file(file, std::as_bytes(std::span(table))));
  return number;
}

Folder::News Folder::news(const std::string& path) {
  const std::lock_guard lock(mutex_);
  const auto known = known_.find(path);
  if (known == known_.end() || !has(path)) return News::kNone;
  if (!is_there(path)) return known->second == Sha256{} ? News::kNone : News::kGone;
  return hash_of(read_file(path, {.most = kLargest})) == known->second ? News::kNone
                                                                       : News::kChanged;
}

}  // namespace probe::studio
