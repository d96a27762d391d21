// Where the program keeps what it can make again.
#pragma once

#include <string>

namespace probe {

// $VLAPROBE_CACHE, else $XDG_CACHE_HOME/vlaprobe, else ~/.cache/vlaprobe, and in it `kind`. Empty
// (no cache) if VLAPROBE_CACHE is set to nothing or there is no home.
std::string cache_folder(const std::string& kind);

}  // namespace probe
