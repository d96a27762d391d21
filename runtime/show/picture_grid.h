// Pictures of one size in rows and columns, with a line of words under each cell and, where there is
// something to say of all of them, words above.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/show/picture.h"
#include "runtime/stage/scene_view.h"

namespace probe::show {

struct GridCell {
  std::vector<Picture> pictures;  // side by side; as many in every cell, all of one size
  std::string caption;
  std::array<std::uint8_t, 3> color{200, 200, 200};
};

// `cells` is not empty; `heading` takes as many lines as it needs, or none. Fails (kVideo) without a
// font.
Result<Picture> lay_out_grid(const std::vector<GridCell>& cells, int columns,
                             std::string_view heading = {});

// A picture as wide as a cell's.
Picture shrink_to(const Picture& picture, int cell_width);

// What people are shown of the cameras of a task: their pictures side by side, or the one called
// `camera` if that is not empty.
Picture join_frames(std::span<const stage::CameraFrame> frames);
Result<Picture> show_frames(std::span<const stage::CameraFrame> frames, const std::string& camera);

}  // namespace probe::show
