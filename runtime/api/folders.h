// What calls that fill a folder, and those that tell of one, read and give alike.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/base/asset_root.h"
#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/run/run.h"

namespace probe::api {

// "" of NULL.
std::string text_of(const char* text);

// Of a text with one folder a line.
AssetRoot folders_of(const char* text);

// Copies for the caller, who may want none (`out` NULL). Throw std::bad_alloc.
Status give_text(std::string_view text, char** out);
Status give(const Json& json, char** out);

// Fail (kUsage) on what cannot be.
Result<std::pair<int, int>> read_episodes(std::int32_t first, std::int32_t last);
// 0 is 1. `what`: of which there are so many at a time.
Result<int> read_jobs(std::int32_t jobs, std::string_view what);
Result<run::IfChanged> read_if_changed(std::int32_t if_changed);

}  // namespace probe::api
