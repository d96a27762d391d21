#include "compiler/geometry/mesh_bounds.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "runtime/base/file.h"

namespace probe::sema {
namespace {

// The next number of a line; the rest of the line is left in `text`.
std::optional<double> take_number(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

std::optional<Bounds> bounds_of_obj(std::string_view text) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Bounds bounds{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  while (!text.empty()) {
    const std::size_t size = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, size);
    text.remove_prefix(std::min(size + 1, text.size()));
    if (!line.starts_with("v ") && !line.starts_with("v\t")) continue;
    line.remove_prefix(1);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = take_number(line);
      if (!value) return std::nullopt;
      bounds.low[i] = std::min(bounds.low[i], *value);
      bounds.high[i] = std::max(bounds.high[i], *value);
    }
  }
  if (bounds.low[0] > bounds.high[0]) return std::nullopt;
  return bounds;
}

std::optional<Bounds> bounds_of_mesh(const AssetRoot& asset_root, const std::string& mesh) {
  const auto text = read_file(asset_root.file("objects/" + mesh + "/collision.obj"));
  if (!text || text->empty()) return std::nullopt;
  return bounds_of_obj(*text);
}

}  // namespace probe::sema
