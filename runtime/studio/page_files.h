// The page's files as build.mjs bundled them: the definition is generated.
#pragma once

#include <span>
#include <string_view>

namespace probe::studio {

struct PageFile {
  std::string_view name;                   // "index.html"
  std::string_view type;                   // as HTTP says it
  std::span<const std::string_view> gzip;  // its bytes, compressed, in pieces
};

std::span<const PageFile> page_files();

}  // namespace probe::studio
