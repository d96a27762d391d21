// The first pictures that a policy gets, against the benchmark's own renderer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "runtime/base/file.h"
#include "runtime/libero/fidelity.h"
#include "runtime/scene/image.h"

namespace probe::libero {

namespace {

// Beside one another: theirs, ours, and four times what differs about grey.
Status write_sheet(const std::string& path, const scene::Texture& theirs,
                   const policy::Image& ours) {
  constexpr int kTimes = 4;
  const auto w = static_cast<std::size_t>(theirs.width), h = static_cast<std::size_t>(theirs.height);
  std::vector<std::uint8_t> rgb(3 * 3 * w * h);
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = theirs.rgba[4 * (y * w + x) + c], b = ours.rgb[3 * (y * w + x) + c];
        std::uint8_t* const to = &rgb[3 * (3 * y * w + x) + c];
        to[0] = static_cast<std::uint8_t>(a);
        to[3 * w] = static_cast<std::uint8_t>(b);
        to[6 * w] = static_cast<std::uint8_t>(std::clamp(128 + kTimes * (b - a), 0, 255));
      }
    }
  }
  PROBE_ASSIGN(const std::string png,
               scene::png_bytes(3 * theirs.width, theirs.height, rgb));
  return write_file(path, std::as_bytes(std::span(png)));
}

}  // namespace

Result<FidelityRow> pictures_row(Imported& imported, const Records& records,
                                 const std::string& sheets) {
  constexpr double kEach = 6, kMedian = 3;  // of 255, root of the mean square
  FidelityRow row{
      "pictures", "6 levels each, 3 in the median",
      "",         "both cameras behind the waiting steps, fixtures where the import has them",
      Held::kNo,  {}};
  std::vector<double> levels;
  std::error_code error;
  if (!sheets.empty()) std::filesystem::create_directories(sheets, error);
  if (error) return Failure{Fault::kIo, "cannot make this folder: " + error.message(), sheets};
  for (const RecordedTask& task : records.tasks()) {
    if (!records.has("reference/" + task.key() + "_t10_agentview.png")) continue;
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), {}));
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
      if (!sheets.empty()) {
        PROBE_TRY(write_sheet(fmt::format("{}/{}_{}.png", sheets, task.key(), view.camera), wanted,
                              view.image));
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
