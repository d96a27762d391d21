// First and last pictures of stored episodes, drawn again from the poses in their traces: no
// physics, no policy.
#include "runtime/show/contact_sheet.h"

#include <algorithm>

#include "runtime/base/glob.h"
#include "runtime/plan/roles.h"
#include "runtime/scene/image.h"
#include "runtime/show/picture_grid.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/scene_view.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"
#include "runtime/store/stored_trace.h"

namespace probe::show {
namespace {

constexpr std::array<std::uint8_t, 3> kGood = {110, 230, 120}, kBad = {255, 150, 110};

// What the policy saw after `step` steps of the trace.
Result<Picture> draw(stage::SceneView& view, const store::Trace& trace, const Sha256& start_id,
                     int step, std::size_t objects, const SheetOptions& options) {
  std::vector<Pose> poses;
  const auto at = [&](int then) -> stage::SceneView::Placed {
    const bool is_start = then == 0;
    const auto index = static_cast<std::size_t>(then) - (is_start ? 0u : 1u);
    const vm::StepSample& sample = is_start ? trace.start->sample : trace.steps[index].sample;
    poses.clear();
    for (std::size_t i = 0; i < std::min(objects, sample.bodies.size()); ++i)
      poses.push_back({sample.bodies[i].origin, sample.bodies[i].rotation});
    return {is_start ? trace.start->q : trace.steps[index].q, poses};
  };
  PROBE_ASSIGN(const auto frames, view.render_seen({start_id, step}, at));
  PROBE_ASSIGN(const Picture shown, show_frames(frames, options.camera));
  return shrink_to(shown, options.cell_width);
}

std::string caption(const store::ResultRow& row) {
  std::string text =
      row.task + " " + std::to_string(row.episode) + "/" + std::to_string(row.seed) + ":";
  if (row.invalid) return text + " invalid";
  for (const store::MetricValue& metric : row.metrics) {
    if (metric.is_bool && metric.value != 0) text += " " + metric.name;
  }
  return text;
}

bool succeeded(const store::ResultRow& row) {
  return !row.invalid &&
         std::any_of(row.metrics.begin(), row.metrics.end(), [](const store::MetricValue& m) {
           return m.name == "success" && m.value != 0;
         });
}

}  // namespace

Status write_contact_sheet(const std::string& dir, const std::string& png_path,
                           const SheetOptions& options) {
  PROBE_ASSIGN(auto proven, store::read_proven_results(dir));
  std::vector<store::ResultRow>& rows = proven.rows;
  std::erase_if(
      rows, [&](const store::ResultRow& row) { return !matches_glob(options.tasks, row.task); });
  if (rows.empty())
    return Failure{Fault::kUsage, "no stored episode of `" + options.tasks + "`", dir};
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(dir));
  PROBE_ASSIGN(const AssetRoot root, store::find_run_assets(dir, options.assets));

  // Rows are ordered by task: one view at a time is enough.
  std::string task_name;
  std::unique_ptr<stage::SceneView> view;
  std::size_t objects = 0;
  std::vector<GridCell> cells;
  for (const store::ResultRow& row : rows) {
    if (row.task != task_name) {
      const auto task = plan.find_task(row.task);
      if (!task)
        return Failure{Fault::kStore, "its plan has no task `" + row.task + "`",
                       store::plan_path(dir)};
      const std::uint32_t tasks[] = {*task};
      PROBE_ASSIGN(auto assets, stage::SharedAssets::load(plan, root, tasks));
      PROBE_ASSIGN(view, stage::SceneView::create(plan, *task, std::move(assets)));
      objects = plan::roles_of(plan.tables(), plan.tasks()[*task]).objects;
      task_name = row.task;
    }
    PROBE_ASSIGN(const store::Trace trace, store::read_stored_trace(row));
    // An episode may have ended before its start: then there is nothing to draw.
    if (!trace.start) continue;
    const auto episodes = plan.episodes(plan.tasks()[*plan.find_task(row.task)]);
    const auto index = static_cast<std::size_t>(row.episode);
    if (index >= episodes.size())
      return Failure{Fault::kStore, "its plan has no such episode of `" + row.task + "`",
                     store::plan_path(dir)};
    const Sha256 start_id{episodes[index].start_id};
    GridCell cell;
    cell.caption = caption(row);
    cell.color = succeeded(row) ? kGood : kBad;
    PROBE_ASSIGN(Picture first, draw(*view, trace, start_id, 0, objects, options));
    cell.pictures.assign(2, std::move(first));
    if (!trace.steps.empty()) {
      const int last = static_cast<int>(trace.steps.size());
      PROBE_ASSIGN(cell.pictures[1], draw(*view, trace, start_id, last, objects, options));
    }
    cells.push_back(std::move(cell));
  }
  if (cells.empty())
    return Failure{Fault::kUsage, "no stored episode got as far as its start", dir};
  PROBE_ASSIGN(const Picture sheet, lay_out_grid(cells, options.columns));
  PROBE_TRY(scene::write_png(png_path, sheet.width, sheet.height, sheet.rgb));
  if (proven.refused.empty()) return {};
  return Failure{Fault::kTrace,
                 "the sheet lacks " + std::to_string(proven.refused.size()) +
                     " episodes that their traces do not bear: " + proven.refused.front(),
                 dir};
}

}  // namespace probe::show
