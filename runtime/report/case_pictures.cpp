#include "runtime/report/case_pictures.h"

#include <filesystem>
#include <map>
#include <span>

#include "runtime/plan/later.h"
#include "runtime/plan/plan.h"
#include "runtime/report/left_out.h"
#include "runtime/scene/image.h"
#include "runtime/show/picture_grid.h"
#include "runtime/stage/stage.h"

namespace probe::report {
namespace {

Result<CasePicture> draw_case(const plan::Plan& plan, const std::string& name,
                              const AssetRoot& root, int width) {
  const auto task = plan.find_task(name);
  if (!task) return Failure{Fault::kPlan, "its plan has no task `" + name + "`", ""};
  if (plan.episodes(plan.tasks()[*task]).empty())
    return Failure{Fault::kPlan, "`" + name + "` has no starts", ""};
  const std::uint32_t tasks[] = {*task};
  PROBE_ASSIGN(const auto assets, stage::SharedAssets::load(plan, root, tasks));
  PROBE_ASSIGN(auto stage, stage::Stage::create(plan, *task, assets));
  PROBE_TRY(stage->reset(0));
  PROBE_TRY(stage->observe());
  PROBE_ASSIGN(const show::Picture shown, show::show_frames(stage->frames(), ""));
  const show::Picture small = shown.width > width ? show::shrink_to(shown, width) : shown;
  CasePicture out;
  out.instruction = plan::whole_instruction(plan.tables(), *task);
  PROBE_ASSIGN(out.png, scene::png_bytes(small.width, small.height, small.rgb));
  return out;
}

Result<CasePictures> draw_cases(const SearchFindings& found, const AssetRoot& assets, int width) {
  PROBE_ASSIGN(const AssetRoot chosen, find_asset_root(assets));
  const AssetRoot root = found.file.empty() ? chosen : chosen.beside(std::span(&found.file, 1));
  CasePictures out;
  out.cases.resize(found.cases.size());
  std::map<std::string, plan::Plan> plans;  // by round
  for (std::size_t i = 0; i < found.cases.size(); ++i) {
    const WorstCase& one = found.cases[i];
    if (!one.confirmed) continue;
    const std::string round = round_with(found.folder, one.name);
    if (round.empty())
      return Failure{Fault::kStore, "no round has the point `" + one.name + "`", found.folder};
    auto at = plans.find(round);
    if (at == plans.end()) {
      PROBE_ASSIGN(
          plan::Plan plan,
          plan::Plan::open((std::filesystem::path(round) / "policy" / "suite.plan").string()));
      at = plans.emplace(round, std::move(plan)).first;
    }
    if (out.base.png.empty()) {
      PROBE_ASSIGN(out.base, draw_case(at->second, found.task, root, width));
    }
    PROBE_ASSIGN(out.cases[i], draw_case(at->second, one.name, root, width));
    const auto starts = [&](const std::string& task) {
      return at->second.episodes(at->second.tasks()[*at->second.find_task(task)]).size();
    };
    out.cases[i].is_first = starts(one.name) == starts(found.task);
  }
  return out;
}

}  // namespace

CasePictures pictures_of(const SearchFindings& found, const AssetRoot& assets, int width) {
  auto drawn = draw_cases(found, assets, width);
  if (drawn) return std::move(drawn).value();
  CasePictures none;
  none.cases.resize(found.cases.size());
  none.note = "no pictures: " + to_text(drawn.failure());
  return none;
}

}  // namespace probe::report
