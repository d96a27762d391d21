#include "runtime/assets/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "runtime/assets/manifest.h"
#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/plan/format.h"
#include "runtime/base/folder_kind.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

std::string kind_of(const fs::path& path) {
  std::string kind = path.extension().string();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return kind;
}

// Kinds of files that people make and no verb writes.
bool is_only_read(const std::string& kind) {
  constexpr std::string_view kKinds[] = {".urdf", ".profile"};
  return std::ranges::find(kKinds, kind) != std::end(kKinds) ||
         std::ranges::find(kMeshExtensions, kind) != kMeshExtensions.end();
}

// Such as textures of a text that is built.
bool is_picture(const std::string& kind) {
  return std::ranges::find(kPhotoExtensions, kind) != kPhotoExtensions.end();
}

// Kinds of files that only their own kind takes the place of, by how they begin.
struct KindByHead {
  Writes kind;
  std::string_view head;
  const char* word;
};
const KindByHead kByHead[] = {
    {Writes::kPlan,
     {reinterpret_cast<const char*>(plan::kMagic.data()), plan::kMagic.size()},
     "plan"},
    {Writes::kTranscript, "vlaprobe transcript ", "transcript"},  // runtime/servers/transcript.h
};

bool begins_with(const std::string& path, std::string_view head) {
  const auto there = read_file(path, {.most = head.size(), .only_begin = true});
  return there && *there == head;
}

}  // namespace

Status check_output(const std::string& out, std::span<const std::string> inputs, Writes writes) {
  if (out.empty()) return {};
  const auto refuse = [&](std::string why) { return Failure{Fault::kUsage, std::move(why), out}; };
  for (const std::string& input : inputs) {
    if (out == input || is_same(out, input)) {
      return refuse("is read by this command and is not written over; give -o another name");
    }
  }
  std::error_code error;
  const fs::path path = fs::weakly_canonical(absolute_path(out), error);
  if (error) return {};  // writing will say what is wrong
  if (path.extension() == ".probe" && is_there(path.string())) {
    return refuse("is Probe text and is not written over; give -o another name");
  }
  const std::string kind = kind_of(path);
  if (writes == Writes::kPlan && is_picture(kind) && is_there(path.string())) {
    return refuse("is a picture and is not written over by a plan; give -o another name");
  }
  if (is_only_read(kind) && is_there(path.string())) {
    return refuse("is no file that a verb writes and is not written over; give -o another name");
  }
  for (fs::path dir = path.parent_path(); dir.has_relative_path(); dir = dir.parent_path()) {
    const std::string below = path.lexically_relative(dir).generic_string();
    if (is_there((dir / "manifest.json").string()) && is_there(path.string())) {
      const auto manifest = assets::read_manifest(dir.string());
      if (manifest && (below == "manifest.json" || manifest->find(below) != nullptr)) {
        return refuse(
            fmt::format("belongs to the assets in `{}` and is not written over; give -o another "
                        "name",
                        dir.string()));
      }
    }
    for (const FolderRow& row : folder_table()) {
      if (!is_own_name(row, below.substr(0, below.find('/'))) || !holds(dir.string(), row.kind))
        continue;
      return refuse(
          fmt::format("belongs to the {} in `{}` and is not written over; give -o another name",
                      row.word, dir.string()));
    }
  }
  for (const KindByHead& known : kByHead) {
    if (writes == known.kind || !begins_with(path.string(), known.head)) continue;
    return refuse(fmt::format(
        "is a {} and is not written over by anything else; give -o another name", known.word));
  }
  return {};
}

}  // namespace probe::assets
