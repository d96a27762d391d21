// Pictures of one size in rows and columns, with a line of words under each cell.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "runtime/run/overlay.h"

namespace probe::run {

struct GridCell {
  std::vector<Picture> pictures;  // side by side; as many in every cell, all of one size
  std::string caption;
  std::array<std::uint8_t, 3> color{200, 200, 200};
};

// `cells` is not empty.
Picture lay_out_grid(const std::vector<GridCell>& cells, int columns);

// A frame as wide as a cell's picture.
Picture shrink_frame(int width, int height, std::span<const std::uint8_t> rgb, int cell_width);

}  // namespace probe::run
