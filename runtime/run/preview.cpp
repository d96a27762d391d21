#include "runtime/run/preview.h"

#include <algorithm>

#include "runtime/run/episode_world.h"
#include "runtime/run/overlay.h"
#include "runtime/run/scene_view.h"
#include "runtime/scene/image.h"

namespace probe::run {
namespace {

constexpr int kMargin = 4, kCaption = kGlyphHeight + 6;
constexpr std::array<std::uint8_t, 3> kBackground{24, 24, 28}, kText{230, 230, 230};

}  // namespace

Status write_preview(const plan::Plan& plan, std::uint32_t task, const std::string& png_path,
                     const SheetOptions& options) {
  PROBE_ASSIGN(const std::string root, find_asset_root(options.assets));
  const std::uint32_t tasks[] = {task};
  PROBE_ASSIGN(auto assets, SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(const auto world, EpisodeWorld::create(plan, task, assets));
  PROBE_ASSIGN(const auto view, SceneView::create(plan, task, assets));

  const plan::TaskRecord& record = plan.tasks()[task];
  const int starts = static_cast<int>(plan.episodes(record).size());
  const int columns = std::max(1, std::min(options.columns, starts));
  const int rows = (starts + columns - 1) / columns;
  Picture sheet;
  int height = 0;
  for (int i = 0; i < starts; ++i) {
    PROBE_TRY(world->reset(static_cast<std::uint32_t>(i)));
    PROBE_ASSIGN(const render::FrameView frame, view->render(world->q(), world->objects()));
    if (i == 0) {
      height = std::max(1, options.cell_width * frame.height / frame.width);
      sheet = make_picture(columns * (options.cell_width + kMargin) + kMargin,
                           rows * (height + kCaption) + 2 * kCaption, kBackground);
    }
    const int x = kMargin + i % columns * (options.cell_width + kMargin);
    const int y = kMargin + i / columns * (height + kCaption);
    paste(sheet,
          shrink(copy_picture(frame.width, frame.height, frame.rgb), options.cell_width, height), x,
          y);
    draw_text(sheet, x, y + height + 3, "start " + std::to_string(i), kText);
  }
  const std::string words =
      std::string(plan.text(record.name)) + ": " + std::string(plan.text(record.prompt));
  draw_text(sheet, kMargin, sheet.height - kCaption, fit_text(words, sheet.width - 2 * kMargin, 1),
            kText);
  return scene::write_png(png_path, sheet.width, sheet.height, sheet.rgb);
}

}  // namespace probe::run
