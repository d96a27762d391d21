// Stage 2: what varies without a new mesh: textures, sensors, and where arms begin.
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "runtime/plan/limits.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

Status RecordCheck::check(const SensorRecord& s) const {
  const auto within = [&](const double& value, double most) -> bool {
    return value >= 0 && value <= most;  // and a number
  };
  bool good = within(s.noise, 1) && within(s.blur, kMaxBlur) && within(s.exposure, kMaxExposure) &&
              within(s.dropped, 1) && s.mirrored <= 1;
  for (const double& edge : s.patch) good = good && within(edge, 1);
  const bool has_patch = s.patch != std::array<double, 4>{};
  PROBE_TRY(check_zero(s.zero));
  good = good && (!has_patch || (s.patch[0] < s.patch[2] && s.patch[1] < s.patch[3]));
  if (good) return {};
  return fail(
      Rule::kSensor, &s,
      fmt::format("noise and dropped are up to 1, blur up to {} pixels, exposure up to {}, and a "
                  "patch lies inside the picture",
                  kMaxBlur, kMaxExposure));
}

Status RecordCheck::check(const CoverRecord& c) const {
  if (c.what < static_cast<std::uint32_t>(CoverOf::kSurface) ||
      c.what > static_cast<std::uint32_t>(CoverOf::kObject))
    return fail(Rule::kCoverKind, &c.what, fmt::format("a texture on {} is not known", c.what));
  PROBE_TRY(check_asset(c.texture, AssetKind::kPhoto, false));
  PROBE_TRY(check_positive(c.side, "the side of a texture"));
  return check_magnitude(c.side, Magnitude::kExtent);
}

namespace {

class VariationCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() {
    std::vector<bool> sensors(t.sensors.size()), covers(t.covers.size());
    for (const CameraRecord& c : t.cameras) PROBE_TRY(own(c.sensor, 1, sensors));
    for (const ObjectRecord& o : t.objects) {
      PROBE_TRY(own(o.cover, 1, covers));
      for (const CoverRecord& cover : slice_of(t.covers, o.cover)) {
        if (cover.what != static_cast<std::uint32_t>(CoverOf::kObject))
          return fail(Rule::kCoverKind, &cover.what, "the texture of an object covers all of it");
      }
    }
    for (const SceneRecord& s : t.scenes) {
      PROBE_TRY(own(s.covers, 3, covers));
      std::uint32_t last = 0;
      for (const CoverRecord& cover : slice_of(t.covers, s.covers)) {
        if (cover.what <= last || cover.what == static_cast<std::uint32_t>(CoverOf::kObject))
          return fail(Rule::kCoverKind, &cover.what,
                      "textures cover surface, walls and floor of a scene, each once");
        last = cover.what;
      }
    }
    for (const std::vector<bool>* owned : {&sensors, &covers}) {
      for (std::size_t i = 0; i < owned->size(); ++i) {
        if ((*owned)[i]) continue;
        const void* const at = owned == &sensors ? static_cast<const void*>(&t.sensors[i])
                                                 : static_cast<const void*>(&t.covers[i]);
        return fail(Rule::kCoverOwned, at, "a sensor or texture belongs to nobody");
      }
    }
    return arms();
  }

 private:
  Status own(const Slice& slice, std::uint32_t most, std::vector<bool>& owned) const {
    if (slice.count > most)
      return fail(Rule::kCoverOwned, &slice, fmt::format("at most {}, not {}", most, slice.count));
    for (std::uint32_t i = slice.first; i < slice.first + slice.count; ++i) {
      if (owned[i]) return fail(Rule::kCoverOwned, &slice, "a sensor or texture of two records");
      owned[i] = true;
    }
    return {};
  }

  Status arms() const {
    for (const TaskRecord& k : t.tasks) {
      const std::size_t drives = t.robots[t.scenes[k.scene].robot].drives.count;
      for (const EpisodeRecord& e : slice_of(t.episodes, k.episodes)) {
        if (e.arm.count == 0) continue;
        if (e.arm.count != drives)
          return fail(Rule::kArmStart, &e.arm,
                      fmt::format("an episode gives {} positions, its robot has {} drives",
                                  e.arm.count, drives));
        PROBE_TRY(check_magnitude(slice_of(t.reals, e.arm), Magnitude::kJointPosition));
      }
    }
    return {};
  }
};

}  // namespace

Status verify_variations(std::span<const std::byte> bytes, const Tables& tables) {
  return VariationCheck(bytes, tables).run();
}

}  // namespace probe::plan
