// Contact sheets: what stands above and below their cells.
#include "runtime/show/picture_grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace probe::show {
namespace {

std::vector<GridCell> cells() {
  std::vector<GridCell> all(4);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].pictures.push_back(make_picture(90, 60, {static_cast<std::uint8_t>(40 * i), 80, 90}));
    all[i].caption = std::to_string(i);
  }
  return all;
}

TEST_CASE("a heading is whole, in as many lines as it needs, and leaves the cells as they are") {
  const auto bare = lay_out_grid(cells(), 2);
  REQUIRE(bare.ok());
  const auto height_with = [&](const std::string& heading) {
    const auto sheet = lay_out_grid(cells(), 2, heading);
    REQUIRE(sheet.ok());
    CHECK(sheet->width == bare->width);
    // Below it all is as it is without one, but for the gap above.
    const auto below = static_cast<std::ptrdiff_t>(bare->rgb.size()) - bare->width * 3 * 4;
    CHECK(std::equal(bare->rgb.end() - below, bare->rgb.end(), sheet->rgb.end() - below));
    return sheet->height - bare->height;
  };
  CHECK(height_with("") == 0);
  const int line = height_with("put it there");
  CHECK(line > 8);
  CHECK(height_with("pick up the carrot and drop it elsewhere on the table, not on the plate") >= 2 * line);
  CHECK(height_with("not on the plate not on the plate not on the plate not on the plate") % line == 0);
}

}  // namespace
}  // namespace probe::show
