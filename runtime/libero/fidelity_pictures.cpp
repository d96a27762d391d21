// What cameras show, against the benchmark's own renderer: in the states that it drew, which is of
// pictures alone, and where our own worlds come to rest, which is what a policy gets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>

#include "runtime/base/file.h"
#include "runtime/libero/fidelity.h"
#include "runtime/libero/recorded_view.h"
#include "runtime/scene/image.h"

namespace probe::libero {

namespace {

// Beside one another: theirs, ours, and four times what differs about grey.
Status write_sheet(const std::string& path, const scene::Texture& theirs,
                   std::span<const std::uint8_t> ours) {
  constexpr int kTimes = 4;
  const auto w = static_cast<std::size_t>(theirs.width), h = static_cast<std::size_t>(theirs.height);
  std::vector<std::uint8_t> rgb(3 * 3 * w * h);
  for (std::size_t y = 0; y < h; ++y) {
    for (std::size_t x = 0; x < w; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = theirs.rgba[4 * (y * w + x) + c], b = ours[3 * (y * w + x) + c];
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

// What one row compares, picture by picture.
class Compared {
 public:
  Compared(const Records& records, std::string sheets, std::string ending)
      : records_(records), sheets_(std::move(sheets)), ending_(std::move(ending)) {}

  // `rgb`: what camera `camera` of the task shows; nothing happens where that was not recorded.
  Status add(const RecordedTask& task, std::string_view camera, int width, int height,
             std::span<const std::uint8_t> rgb) {
    const std::string file = fmt::format("reference/{}_t10_{}.png", task.key(), camera);
    if (!records_.has(file)) return {};
    PROBE_ASSIGN(const scene::Texture theirs, scene::load_image(records_.folder() + "/" + file));
    if (theirs.width != width || theirs.height != height)
      return Failure{Fault::kUsage, "its size is not the camera's", file};
    double squares = 0;
    const std::size_t pixels = theirs.rgba.size() / 4;
    for (std::size_t i = 0; i < pixels; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double off = static_cast<double>(rgb[3 * i + c]) - theirs.rgba[4 * i + c];
        squares += off * off;
      }
    }
    if (!sheets_.empty()) {
      const std::string sheet = fmt::format("{}/{}_{}{}.png", sheets_, task.key(), camera, ending_);
      PROBE_TRY(write_sheet(sheet, theirs, rgb));
    }
    levels_.push_back(std::sqrt(squares / static_cast<double>(3 * pixels)));
    if (levels_.back() > kEach)
      others_.push_back(fmt::format("{} {}: {:.1f}", task.key(), camera, levels_.back()));
    return {};
  }

  FidelityRow row(std::string what, std::string how) && {
    FidelityRow row{
        std::move(what),   "6 levels each, 3 in the median", "", std::move(how), Held::kNo,
        std::move(others_)};
    if (levels_.empty()) {
      row.held = Held::kNotMeasured;
      row.how = "the import's cameras have no recorded pictures, or the records no state of them";
      return row;
    }
    std::ranges::sort(levels_);
    const double median = levels_[levels_.size() / 2];
    row.figure =
        fmt::format("{} pictures: {:.1f} in the median, at most {:.1f}; {} within 6",
                    levels_.size(), median, levels_.back(), levels_.size() - row.others.size());
    row.held = row.others.empty() && median <= kMedian ? Held::kYes : Held::kNo;
    return row;
  }

 private:
  static constexpr double kEach = 6, kMedian = 3;  // of 255, root of the mean square

  const Records& records_;
  std::string sheets_, ending_;
  std::vector<double> levels_;
  std::vector<std::string> others_;
};

}  // namespace

Result<std::vector<FidelityRow>> pictures_rows(Imported& imported, const Records& records,
                                               const std::string& sheets) {
  std::error_code error;
  if (!sheets.empty()) std::filesystem::create_directories(sheets, error);
  if (error) return Failure{Fault::kIo, "cannot make this folder: " + error.message(), sheets};
  Compared recorded(records, sheets, ""), first(records, sheets, "_first");
  for (const RecordedTask& task : records.tasks()) {
    if (!records.has("reference/" + task.key() + "_t10_agentview.png")) continue;
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), {}));
    PROBE_TRY(stage->reset(0));
    PROBE_ASSIGN(const policy::Observation seen, stage->observe());
    for (const policy::CameraImage& view : seen.cameras)
      PROBE_TRY(first.add(task, view.camera, view.image.width, view.image.height, view.image.rgb));
    PROBE_ASSIGN(const std::optional<RecordedState> state, records.behind_waiting(task));
    if (!state) continue;
    PROBE_ASSIGN(const auto frames, recorded_frames(*plan, *stage, task, *state));
    for (const stage::CameraFrame& view : frames)
      PROBE_TRY(
          recorded.add(task, view.camera, view.frame.width, view.frame.height, view.frame.rgb));
  }
  return std::vector{
      std::move(recorded).row("pictures of recorded states",
                              "both cameras, arm and things where the records have them"),
      std::move(first).row("first pictures of a policy",
                           "both cameras behind our own waiting steps")};
}

}  // namespace probe::libero
