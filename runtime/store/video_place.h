// Where the video of an episode is written.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/store/episode_key.h"

namespace probe::store {

// video_path(), its folder made, whatever links are in the run's folder. Fails (kIo, where = the
// path at fault).
Result<std::string> place_for_video(const std::string& dir, const EpisodeKey& key);

}  // namespace probe::store
