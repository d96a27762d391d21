// The first pictures that a policy gets, against the benchmark's own renderer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/libero/fidelity.h"
#include "runtime/scene/image.h"

namespace probe::libero {

Result<FidelityRow> pictures_row(Imported& imported, const Records& records) {
  constexpr double kEach = 6, kMedian = 3;  // of 255, root of the mean square
  FidelityRow row{
      "pictures", "6 levels each, 3 in the median",
      "",         "both cameras behind the waiting steps, fixtures where the import has them",
      Held::kNo,  {}};
  std::vector<double> levels;
  for (const RecordedTask& task : records.tasks()) {
    if (!records.has("reference/" + task.key() + "_t10_agentview.png")) continue;
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), true));
    PROBE_TRY(stage->reset(0));
    PROBE_ASSIGN(const policy::Observation seen, stage->observe());
    for (const policy::CameraImage& view : seen.cameras) {
      const std::string file = fmt::format("reference/{}_t10_{}.png", task.key(), view.camera);
      if (!records.has(file)) continue;
      PROBE_ASSIGN(const scene::Texture wanted, scene::load_image(records.folder() + "/" + file));
      if (wanted.width != view.image.width || wanted.height != view.image.height)
        return Failure{Fault::kUsage, "its size is not the camera's", file};
      double squares = 0;
      const std::size_t pixels = wanted.rgba.size() / 4;
      for (std::size_t i = 0; i < pixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double off =
              static_cast<double>(view.image.rgb[3 * i + c]) - wanted.rgba[4 * i + c];
          squares += off * off;
        }
      }
      levels.push_back(std::sqrt(squares / static_cast<double>(3 * pixels)));
      if (levels.back() > kEach)
        row.others.push_back(fmt::format("{} {}: {:.1f}", task.key(), view.camera, levels.back()));
    }
  }
  if (levels.empty()) {
    row.held = Held::kNotMeasured;
    row.how = "the import's cameras have no recorded pictures";
    return row;
  }
  std::ranges::sort(levels);
  row.figure =
      fmt::format("{} pictures: {:.1f} in the median, at most {:.1f}; {} within 6", levels.size(),
                  levels[levels.size() / 2], levels.back(), levels.size() - row.others.size());
  row.held = row.others.empty() && levels[levels.size() / 2] <= kMedian ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
