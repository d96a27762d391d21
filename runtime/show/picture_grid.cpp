// Arithmetic of a contact sheet.
#include "runtime/show/picture_grid.h"

#include <algorithm>

#include "runtime/base/check.h"
#include "runtime/show/lettering.h"

namespace probe::show {
namespace {

constexpr int kGap = 4, kCaption = line_height(kSmallText) + 2;

// Broken at blanks; a word that is too long has a line of its own, and is cut where that ends.
std::vector<std::string> lines_of(Lettering& lettering, std::string_view text, int room) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool fits =
        !lines.empty() && lettering.width(lines.back() + " " + word, kSmallText) <= room;
    if (fits) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

}  // namespace

Result<Picture> lay_out_grid(const std::vector<GridCell>& cells, int columns,
                             std::string_view heading) {
  PROBE_CHECK(!cells.empty() && !cells[0].pictures.empty(), "a grid has pictures");
  PROBE_ASSIGN(Lettering* const lettering, Lettering::shared());
  columns = std::max(1, std::min(columns, static_cast<int>(cells.size())));
  const int rows = (static_cast<int>(cells.size()) + columns - 1) / columns;
  const int width = cells[0].pictures[0].width, height = cells[0].pictures[0].height;
  const int strip = static_cast<int>(cells[0].pictures.size()) * (width + 1) - 1;
  const int step_x = strip + kGap, step_y = height + kCaption + kGap;
  const int room = columns * step_x - kGap;
  const std::vector<std::string> above = lines_of(*lettering, heading, room);
  const int top = static_cast<int>(above.size()) * kCaption;
  Picture sheet = make_picture(columns * step_x + kGap, top + rows * step_y + kGap, {24, 24, 28});
  for (std::size_t i = 0; i < above.size(); ++i)
    lettering->draw(sheet, kGap, kGap + static_cast<int>(i) * kCaption,
                    lettering->fit(above[i], room, kSmallText), {235, 235, 235}, kSmallText);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    int x = kGap + static_cast<int>(i) % columns * step_x;
    const int y = top + kGap + static_cast<int>(i) / columns * step_y;
    lettering->draw(sheet, x, y + height + 1, lettering->fit(cells[i].caption, strip, kSmallText),
                    cells[i].color, kSmallText);
    for (const Picture& picture : cells[i].pictures) {
      paste(sheet, picture, x, y);
      x += width + 1;
    }
  }
  return sheet;
}

Picture shrink_to(const Picture& picture, int cell_width) {
  cell_width = std::clamp(cell_width, 1, picture.width);
  return shrink(picture, cell_width, std::max(1, cell_width * picture.height / picture.width));
}

Picture join_frames(std::span<const stage::CameraFrame> frames) {
  PROBE_CHECK(!frames.empty(), "a task has a camera");
  constexpr int kGap = 2;
  int width = -kGap, height = 0;
  for (const stage::CameraFrame& seen : frames) {
    width += kGap + seen.frame.width;
    height = std::max(height, seen.frame.height);
  }
  Picture all = make_picture(width, height, {0, 0, 0});
  int x = 0;
  for (const stage::CameraFrame& seen : frames) {
    // A small one in the middle of the height: there no strip of words lies over it.
    paste(all, copy_picture(seen.frame.width, seen.frame.height, seen.frame.rgb), x,
          (height - seen.frame.height) / 2);
    x += seen.frame.width + kGap;
  }
  return all;
}

Result<Picture> show_frames(std::span<const stage::CameraFrame> frames, const std::string& camera) {
  if (camera.empty()) return join_frames(frames);
  std::string names;
  for (const stage::CameraFrame& seen : frames) {
    if (seen.camera == camera)
      return copy_picture(seen.frame.width, seen.frame.height, seen.frame.rgb);
    names.append(names.empty() ? "`" : ", `").append(seen.camera).append("`");
  }
  return Failure{Fault::kUsage, "the task has no camera `" + camera + "`, it has " + names,
                 "--camera"};
}

}  // namespace probe::show
