#include "runtime/show/phrase_sheet.h"

#include <algorithm>
#include <optional>

#include "runtime/base/asset_root.h"
#include "runtime/scene/image.h"
#include "runtime/show/lettering.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/stage.h"

namespace probe::show {
namespace {

constexpr int kCrop = 144, kMargin = 8, kWordsWidth = 640;
constexpr int kLeastSide = 72;  // pixels of the frame that a crop shows at least
constexpr std::array<std::uint8_t, 3> kGround = {24, 24, 28}, kWords = {240, 240, 240},
                                      kNote = {160, 160, 170};

// A square of pixels; it may reach over the frame's edge.
struct Square {
  int x = 0, y = 0, side = 0;
};

// Round the pixels of one body, with as much around it as it is wide; none when it is hidden.
std::optional<Square> square_round(const render::FrameView& frame, std::uint16_t id) {
  int left = frame.width, right = -1, top = frame.height, bottom = -1;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                      static_cast<std::size_t>(x);
      if (frame.segmentation[at] != id) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  if (right < 0) return std::nullopt;
  const int side = std::max(2 * std::max(right - left + 1, bottom - top + 1), kLeastSide);
  return Square{(left + right - side) / 2, (top + bottom - side) / 2, side};
}

// Enlarged or reduced to kCrop by taking the nearest pixel.
Picture crop(const render::FrameView& frame, const Square& square) {
  Picture picture = make_picture(kCrop, kCrop, kGround);
  for (int y = 0; y < kCrop; ++y) {
    for (int x = 0; x < kCrop; ++x) {
      const int from_x = square.x + x * square.side / kCrop;
      const int from_y = square.y + y * square.side / kCrop;
      if (from_x < 0 || from_y < 0 || from_x >= frame.width || from_y >= frame.height) continue;
      const auto at = static_cast<std::size_t>(3 * (from_y * frame.width + from_x));
      std::copy_n(frame.rgb.data() + at, 3,
                  picture.rgb.data() + static_cast<std::size_t>(3 * (y * kCrop + x)));
    }
  }
  return picture;
}

std::optional<std::uint16_t> body_of(const plan::Plan& plan, std::uint32_t task,
                                     const std::string& object) {
  const auto bodies = plan.bodies(plan.tasks()[task]);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (plan.text(bodies[i].name) == object) return static_cast<std::uint16_t>(i);
  }
  return std::nullopt;
}

}  // namespace

Status write_phrases(const plan::Plan& plan, std::span<const PhraseRow> rows,
                     const std::string& png_path, const AssetRoot& asset_root) {
  if (rows.empty()) return Failure{Fault::kUsage, "no phrase refers to an object", ""};
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(asset_root));
  PROBE_ASSIGN(Lettering* const lettering, Lettering::shared());
  const int step = kCrop + kMargin;
  Picture sheet = make_picture(kCrop + kWordsWidth + 3 * kMargin,
                               static_cast<int>(rows.size()) * step + kMargin, kGround);
  std::optional<std::uint32_t> shown;
  std::unique_ptr<stage::Stage> stage;
  int y = kMargin;
  for (const PhraseRow& row : rows) {
    if (row.task != shown) {
      stage.reset();  // frees the old before the new is made
      const std::uint32_t tasks[] = {row.task};
      PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, root, tasks));
      PROBE_ASSIGN(stage, stage::Stage::create(plan, row.task, assets));
      PROBE_TRY(stage->reset(0));
      PROBE_TRY(stage->observe());
      shown = row.task;
    }
    const auto body = body_of(plan, row.task, row.object);
    if (!body) {
      return Failure{Fault::kUsage,
                     "`" + row.object + "` is not in the scene of `" +
                         std::string(plan.text(plan.tasks()[row.task].name)) + "`",
                     ""};
    }
    // In the first camera's picture that shows it.
    const auto frames = stage->frames();
    std::optional<Square> square;
    for (std::size_t i = 0; i < frames.size() && !square; ++i) {
      square = square_round(frames[i].frame, static_cast<std::uint16_t>(*body + 1));
      if (square) paste(sheet, crop(frames[i].frame, *square), kMargin, y);
    }
    const int x = kCrop + 2 * kMargin;
    const auto write = [&](int top, const std::string& words,
                           const std::array<std::uint8_t, 3>& color, int size) {
      lettering->draw(sheet, x, top, lettering->fit(words, kWordsWidth, size), color, size);
    };
    write(y + kCrop / 2 - 24, row.words, kWords, 2 * kSmallText);
    write(y + kCrop / 2 + 6, row.note + (square ? "" : "  (hidden in this picture)"), kNote,
          kSmallText);
    y += step;
  }
  return scene::write_png(png_path, sheet.width, sheet.height, sheet.rgb);
}

}  // namespace probe::show
