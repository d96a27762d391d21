#include "runtime/store/video_place.h"

#include <filesystem>

#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/store/store.h"

namespace probe::store {

Result<std::string> place_for_video(const std::string& dir, const EpisodeKey& key) {
  const std::filesystem::path file = video_path(dir, key);
  PROBE_ASSIGN(std::string place, file_inside(dir, file.lexically_relative(dir).string()));
  PROBE_TRY(make_lasting_folders(file.parent_path().string()));
  return place;
}

}  // namespace probe::store
