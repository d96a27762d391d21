// Drop, settle, one picture: for every start of a task.
#include "runtime/show/preview.h"

#include "runtime/base/asset_root.h"
#include "runtime/plan/later.h"
#include "runtime/scene/image.h"
#include "runtime/show/picture_grid.h"
#include "runtime/stage/stage.h"

namespace probe::show {

Status write_preview(const plan::Plan& plan, std::uint32_t task, const std::string& png_path,
                     const SheetOptions& options) {
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(options.assets));
  const std::uint32_t tasks[] = {task};
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan, task, assets));
  const plan::TaskRecord& record = plan.tasks()[task];
  std::vector<GridCell> cells;
  for (std::uint32_t index = 0; index < plan.episodes(record).size(); ++index) {
    PROBE_TRY(stage->reset(index));
    PROBE_TRY(stage->observe());
    PROBE_ASSIGN(const Picture shown, show_frames(stage->frames(), options.camera));
    GridCell cell;
    cell.pictures.push_back(shrink_to(shown, options.cell_width));
    cell.caption = std::to_string(index);
    cells.push_back(std::move(cell));
  }
  if (cells.empty()) {
    return Failure{Fault::kUsage,
                   "task `" + std::string(plan.text(record.name)) + "` has no starts", ""};
  }
  PROBE_ASSIGN(const Picture sheet, lay_out_grid(cells, options.columns,
                                                  std::string(plan.text(record.name)) + ": " +
                                                      plan::whole_instruction(plan.tables(), task)));
  return scene::write_png(png_path, sheet.width, sheet.height, sheet.rgb);
}

Status write_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t index,
                   const std::string& png_path, const AssetRoot& asset_root,
                   const std::string& camera) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const std::size_t count = plan.episodes(record).size();
  if (index >= count) {
    return Failure{Fault::kUsage,
                   "task `" + std::string(plan.text(record.name)) + "` has " +
                       std::to_string(count) + " starts, counted from 0",
                   ""};
  }
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(asset_root));
  const std::uint32_t tasks[] = {task};
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan, task, assets));
  PROBE_TRY(stage->reset(index));
  PROBE_TRY(stage->observe());
  PROBE_ASSIGN(const Picture shown, show_frames(stage->frames(), camera));
  return scene::write_png(png_path, shown.width, shown.height, shown.rgb);
}

}  // namespace probe::show
