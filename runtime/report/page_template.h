// The page without results, bundled at build time by page/build.mjs: what stands before the results
// and what after, in pieces.
#pragma once

#include <span>
#include <string_view>

namespace probe::report {

std::span<const std::string_view> page_before();
std::span<const std::string_view> page_after();
// What stands in its style element, and what the page of searches has behind that.
std::span<const std::string_view> page_style();
std::span<const std::string_view> searches_style();

}  // namespace probe::report
