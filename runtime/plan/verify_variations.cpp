// Stage 2: what varies without a new mesh: textures, sensors, what moves by itself, and where arms
// begin.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/plan/limits.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/shakes.h"
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

Status RecordCheck::check(const MoveRecord& m) const {
  if (m.way > static_cast<std::uint32_t>(Way::kRound))
    return fail(Rule::kMoveWay, &m.way, fmt::format("way {} is not known", m.way));
  PROBE_TRY(check_magnitude(m.to, Magnitude::kPlace));
  if (m.speed >= kMinMoveSpeed && m.speed <= kMaxMoveSpeed) return {};
  return fail(
      Rule::kMoveWay, &m.speed,
      fmt::format("things move at {} to {} m/s, not {}", kMinMoveSpeed, kMaxMoveSpeed, m.speed));
}

namespace {

class VariationCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() {
    std::vector<bool> sensors(t.sensors.size()), covers(t.covers.size()), masses(t.masses.size()),
        dampings(t.dampings.size());
    for (const CameraRecord& c : t.cameras) PROBE_TRY(own(c.sensor, 1, sensors));
    for (const ObjectRecord& o : t.objects) {
      PROBE_TRY(own(o.mass, 1, masses));
      PROBE_TRY(own(o.damping, 1, dampings));
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
    for (std::size_t i = 0; i < masses.size(); ++i) {
      if (!masses[i]) return fail(Rule::kMass, &t.masses[i], "a mass belongs to nobody");
    }
    for (std::size_t i = 0; i < dampings.size(); ++i) {
      if (!dampings[i]) return fail(Rule::kDamping, &t.dampings[i], "a damping belongs to nobody");
    }
    PROBE_TRY(moves());
    PROBE_TRY(shakes());
    return arms();
  }

 private:
  Status moves() const {
    std::uint32_t next = 0;
    for (const TaskRecord& k : t.tasks) {
      if (k.moves.count == 0) continue;
      if (k.moves.first != next)
        return fail(Rule::kMoveOwned, &k.moves, "legs of tasks follow one another");
      next += k.moves.count;
      std::uint32_t least = 0;
      for (const std::span<const MoveRecord> legs : moves_of(t, k)) {
        const MoveRecord& first = legs.front();
        if (first.body < least || first.body >= roles_of(t, k).objects)
          return fail(
              Rule::kMoveOwned, &first.body,
              fmt::format("body {} is no object, or stands behind a later one", first.body));
        least = first.body + 1;
        PROBE_TRY(one_way(legs));
      }
    }
    if (next == t.moves.size()) return {};
    return fail(Rule::kMoveOwned, &t.moves[next], "a leg belongs to no task");
  }

  // Its legs are alike, and none ends where it begins.
  Status one_way(std::span<const MoveRecord> legs) const {
    const bool is_round = legs.front().way == static_cast<std::uint32_t>(Way::kRound);
    if (legs.size() > (is_round ? 1 : kMaxLegs))
      return fail(Rule::kMoveWay, &legs.front(),
                  fmt::format("a circle has one leg, any other way at most {}", kMaxLegs));
    std::array<double, 2> at{};
    for (const MoveRecord& leg : legs) {
      if (leg.way != legs.front().way || leg.speed != legs.front().speed)
        return fail(Rule::kMoveOwned, &leg, "legs of a body are alike");
      const double x = leg.to[0] - at[0], y = leg.to[1] - at[1];
      if (!(x * x + y * y >= kMinLeg * kMinLeg))
        return fail(Rule::kMoveWay, &leg.to, "a leg ends where it begins");
      at = leg.to;
    }
    return {};
  }

  Status own(const Slice& slice, std::uint32_t most, std::vector<bool>& owned) const {
    if (slice.count > most)
      return fail(Rule::kCoverOwned, &slice, fmt::format("at most {}, not {}", most, slice.count));
    for (std::uint32_t i = slice.first; i < slice.first + slice.count; ++i) {
      if (owned[i]) return fail(Rule::kCoverOwned, &slice, "a sensor or texture of two records");
      owned[i] = true;
    }
    return {};
  }

  Status shakes() const {
    for (const TaskRecord& k : t.tasks) {
      const std::size_t views = std::max<std::size_t>(1, k.views.count);
      for (const EpisodeRecord& e : slice_of(t.episodes, k.episodes)) {
        if (e.shaken.count == 0) continue;
        if (e.shaken.count != kShakeReals * views)
          return fail(Rule::kCameraShake, &e.shaken,
                      fmt::format("an episode shakes its cameras by {} numbers, of its {} views "
                                  "each has {}",
                                  e.shaken.count, views, kShakeReals));
        const auto numbers = shakes_of(t, e);
        for (std::size_t view = 0; view < views; ++view) {
          PROBE_TRY(check_magnitude(numbers.subspan(view * kShakeReals, 3), Magnitude::kPlace));
          PROBE_TRY(check_unit(numbers.subspan(view * kShakeReals + 3, 4), "the turn of a camera"));
        }
      }
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
