// Which pixels show which thing where an episode begins, against the geoms that the benchmark's own
// renderer named there.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "runtime/libero/fidelity.h"
#include "runtime/libero/recorded_view.h"
#include "runtime/libero/zip.h"
#include "runtime/wire/npy.h"

namespace probe::libero {
namespace {

// reference/TASK_t0_geometry.npz
class Geometry {
 public:
  static Result<Geometry> open(const Records& records, const std::string& file) {
    Geometry made;
    made.file_ = file;
    PROBE_ASSIGN(made.bytes_, records.text(file));
    PROBE_ASSIGN(const wire::Bytes bodies, made.member("geom_body"));
    auto names = wire::texts_from_npy(bodies);
    if (!names) return Failure{Fault::kUsage, names.failure().message, file + ": geom_body"};
    made.bodies_ = std::move(names).value();
    return made;
  }

  // The body that each pixel of a square picture shows. Empty where no geom is named: behind
  // everything, and where a site is in the way, which is named there and drawn in no picture.
  Result<std::vector<std::string_view>> shown(const std::string& camera, int width, int height) {
    PROBE_ASSIGN(const wire::Array geoms, array(camera + "_geom"));
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (geoms.dtype != "<i2" || geoms.shape.size() != 2 || geoms.shape[0] != height ||
        geoms.shape[1] != width || geoms.bytes.size() != 2 * pixels)
      return Failure{Fault::kUsage,
                     fmt::format("`{}_geom` is not {} x {} of int16", camera, width, height),
                     file_};
    std::vector<std::string_view> out(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::int16_t geom = 0;
      std::memcpy(&geom, &geoms.bytes[2 * i], 2);
      if (geom < 0) continue;
      if (static_cast<std::size_t>(geom) >= bodies_.size())
        return Failure{Fault::kUsage, fmt::format("geom {} has no body", geom), file_};
      out[i] = bodies_[static_cast<std::size_t>(geom)];
    }
    return out;
  }

 private:
  Result<wire::Bytes> member(const std::string& name) const {
    const std::span<const std::uint8_t> archive(
        reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
    PROBE_ASSIGN(const std::string found,
                 read_zip_member(archive, name + ".npy", std::size_t{1} << 24, file_));
    return wire::Bytes(found.begin(), found.end());
  }
  Result<wire::Array> array(const std::string& name) const {
    PROBE_ASSIGN(const wire::Bytes bytes, member(name));
    auto read = wire::from_npy(bytes);
    if (!read) return Failure{Fault::kUsage, read.failure().message, file_ + ": " + name};
    return std::move(read).value();
  }

  std::string bytes_, file_;
  std::vector<std::string> bodies_;
};

// Their names of what a policy knows as these.
std::string camera_of(std::string_view ours) {
  return ours == "wrist" ? "robot0_eye_in_hand" : std::string(ours);
}

struct Overlap {
  std::size_t both = 0, either = 0, theirs = 0;
};

}  // namespace

Result<FidelityRow> masks_row(Imported& imported, const Records& records) {
  constexpr double kBar = 0.97;
  // A pixel of its edge is more than the bar leaves to what is smaller.
  constexpr std::size_t kLeast = 400;
  // Geoms were named in the middle of each pixel, without antialiasing.
  const stage::StageOptions kAsRecorded{.image = {.is_single = true}};
  FidelityRow row{
      "masks of objects",
      "intersection over union 0.97",
      "",
      fmt::format("both cameras where an episode begins, in the middle of each pixel where a "
                  "geom is named, what shows at least {} pixels",
                  kLeast),
      Held::kNo,
      {}};
  std::vector<double> found;
  std::size_t smaller = 0, unnamed = 0;  // masks; pixels of ours where no geom is named
  for (const RecordedTask& task : records.tasks()) {
    const std::string file = "reference/" + task.key() + "_t0_geometry.npz";
    if (!records.has(file)) continue;
    PROBE_ASSIGN(Geometry geometry, Geometry::open(records, file));
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
    PROBE_ASSIGN(const auto stage, imported.stage(task.suite, task.name(), kAsRecorded));
    PROBE_TRY(stage->reset(0));
    PROBE_ASSIGN(const auto frames, first_frames(*plan, *stage));
    for (const stage::CameraFrame& view : frames) {
      const render::FrameView& frame = view.frame;
      PROBE_ASSIGN(const std::vector<std::string_view> theirs,
                   geometry.shown(camera_of(view.camera), frame.width, frame.height));
      for (const auto& [name, object] : task.said["objects"].items()) {
        const auto at = std::ranges::find(stage->body_names(), name) - stage->body_names().begin();
        Overlap overlap;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
          const bool ours = frame.segmentation[i] == at + 1;
          if (theirs[i].empty()) {
            unnamed += ours ? 1 : 0;
            continue;
          }
          const bool is_theirs = theirs[i].starts_with(name + "_");
          overlap.both += ours && is_theirs ? 1 : 0;
          overlap.either += ours || is_theirs ? 1 : 0;
          overlap.theirs += is_theirs ? 1 : 0;
        }
        if (overlap.either == 0) continue;
        if (overlap.theirs < kLeast) {
          ++smaller;
          continue;
        }
        const double share =
            static_cast<double>(overlap.both) / static_cast<double>(overlap.either);
        found.push_back(share);
        if (share >= kBar) continue;
        row.others.push_back(fmt::format("{} {}: {} {:.3f} of {} pixels", task.key(), view.camera,
                                         name, share, overlap.theirs));
      }
    }
  }
  if (found.empty()) {
    row.held = Held::kNotMeasured;
    row.how = "no object of the records' pictures is large enough";
    return row;
  }
  std::ranges::sort(found);
  row.figure = fmt::format(
      "{} of {} masks; {:.3f} in the median, least {:.3f}; {} smaller ones not counted, nor {} "
      "pixels of ours where no geom is named",
      found.size() - row.others.size(), found.size(), found[found.size() / 2], found.front(),
      smaller, unnamed);
  row.held = row.others.empty() ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
