// Stage 2, the records of fixtures with joints: what acts in these, what can be touched, and
// regions.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/regions.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

Status RecordCheck::check(const FixtureRecord& f) const {
  PROBE_TRY(check_word(f.name, "the name of a fixture"));
  PROBE_TRY(check_asset(f.urdf, AssetKind::kUrdf, false));
  PROBE_TRY(check_zero(f.zero));
  PROBE_TRY(check_magnitude(f.position, Magnitude::kPlace));
  PROBE_TRY(check_unit(f.rotation, "the rotation of a fixture"));
  PROBE_TRY(check_friction(f.friction));
  PROBE_TRY(check_slice(f.joints, t.fixture_joints.size(), "FJNT"));
  PROBE_TRY(check_slice(f.parts, t.parts.size(), "PART"));
  PROBE_TRY(check_slice(f.meshes, t.list.size(), "LIST"));
  if (f.meshes.count > kMaxMeshes) {
    return fail(
        Rule::kMeshCount, &f.meshes,
        fmt::format("a fixture names at most {} meshes, not {}", kMaxMeshes, f.meshes.count));
  }
  for (const std::uint32_t& mesh : slice_of(t.list, f.meshes)) {
    PROBE_TRY(check_index(mesh, t.assets.size(), "ASST"));
  }
  PROBE_TRY(check_slice(f.armatures, t.reals.size(), "REAL"));
  if (f.armatures.count != 0 && f.armatures.count != f.joints.count)
    return fail(Rule::kFixtureArmature, &f.armatures,
                fmt::format("a fixture has an armature for each of its {} joints or none, not {}",
                            f.joints.count, f.armatures.count));
  for (const double& armature : slice_of(t.reals, f.armatures)) {
    PROBE_TRY(check_not_negative(armature, "an armature"));
    PROBE_TRY(check_magnitude(armature, Magnitude::kArmature));
  }
  PROBE_TRY(check_slice(f.shown, t.shown.size(), "SHOW"));
  return check_zero(f.zero2);
}

Status RecordCheck::check(const FixtureJointRecord& j) const {
  PROBE_TRY(check_name(j.joint, "the joint of a fixture"));
  if (j.motion != static_cast<std::uint32_t>(JointMotion::kTurns) &&
      j.motion != static_cast<std::uint32_t>(JointMotion::kSlides)) {
    return fail(Rule::kJointMotion, &j.motion,
                fmt::format("a joint turns (1) or slides (2), not {}", j.motion));
  }
  PROBE_TRY(check_zero(j.zero));
  for (const double* position : {&j.lower, &j.upper, &j.rest, &j.start})
    PROBE_TRY(check_magnitude(*position, Magnitude::kJointPosition));
  PROBE_TRY(check_not_negative(j.friction, "a friction"));
  PROBE_TRY(check_magnitude(j.friction, Magnitude::kJointFriction));
  for (const double* gain : {&j.damping, &j.stiffness}) {
    PROBE_TRY(check_not_negative(*gain, "a gain"));
    PROBE_TRY(check_magnitude(*gain, Magnitude::kGain));
  }
  if (is_endless(j) ? j.motion == static_cast<std::uint32_t>(JointMotion::kSlides)
                    : j.lower >= j.upper) {
    return fail(Rule::kJointLimits, &j.lower, "the lower limit of a joint lies below the upper");
  }
  if (is_within(j, j.start)) return {};
  return fail(
      Rule::kJointLimits, &j.start,
      fmt::format("a joint begins at {}, its limits are {} and {}", j.start, j.lower, j.upper));
}

Status RecordCheck::check(const PartRecord& p) const {
  PROBE_TRY(check_name(p.name, "the name of a part"));
  PROBE_TRY(check_name(p.link, "the link of a part"));
  PROBE_TRY(check_text(p.text));
  if (p.declared > 1) return fail(Rule::kZero, &p.declared, "a part is declared (1) or not (0)");
  return {};
}

Status RecordCheck::check(const ShownRecord& s) const {
  PROBE_TRY(check_name(s.link, "the link that is shown"));
  if (s.side != static_cast<std::uint32_t>(ShownSide::kAbove) &&
      s.side != static_cast<std::uint32_t>(ShownSide::kBelow)) {
    return fail(Rule::kShownSide, &s.side,
                fmt::format("a link is shown above (1) or below (2), not {}", s.side));
  }
  return check_magnitude(s.at, Magnitude::kJointPosition);
}

Status RecordCheck::check(const RegionRecord& r) const {
  PROBE_TRY(check_name(r.name, "the name of a region"));
  switch (static_cast<BodyKind>(r.kind)) {
    case BodyKind::kObject:
      PROBE_TRY(check_index(r.index, t.objects.size(), "OBJT"));
      break;
    case BodyKind::kSurface:
    case BodyKind::kFixture:
      PROBE_TRY(check_index(r.index, t.scenes.size(), "SCNE"));
      break;
    case BodyKind::kPart:
      PROBE_TRY(check_index(r.index, t.parts.size(), "PART"));
      break;
    case BodyKind::kLink:
    default:
      return fail(Rule::kRegionOwner, &r.kind,
                  fmt::format("a region belongs to body kind 1, 2, 3 or 5, not {}", r.kind));
  }
  PROBE_TRY(check_magnitude(r.low, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(r.high, Magnitude::kPlace));
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(r.low[i] < r.high[i]))
      return fail(Rule::kBox, &r.low[i], "a region has a positive extent on each axis");
  }
  return {};
}

Status RecordCheck::check(const TurnedRecord& r) const {
  PROBE_TRY(check_index(r.region, t.regions.size(), "REGN"));
  PROBE_TRY(check_zero(r.zero));
  PROBE_TRY(check_magnitude(r.middle, Magnitude::kPlace));
  PROBE_TRY(check_magnitude(r.half, Magnitude::kPlace));
  PROBE_TRY(check_unit(r.rotation, "the rotation of a region"));
  for (const double& half : r.half) {
    if (!(half > 0)) return fail(Rule::kBox, &half, "a region has a positive extent on each axis");
  }
  if (&r != t.turned.data() && !((&r)[-1].region < r.region))
    return fail(Rule::kTurnedBox, &r.region, "turned regions ascend");
  std::array<double, 3> low{}, high{};
  box_around(r.box(), low, high);
  const RegionRecord& region = t.regions[r.region];
  if (low == region.low && high == region.high) return {};
  return fail(Rule::kTurnedBox, &r.region,
              fmt::format("region {} is not the box around its turned one", r.region));
}

namespace {

class FixtureCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() const {
    PROBE_TRY(owners());
    for (const FixtureRecord& fixture : t.fixtures) PROBE_TRY(part_names(fixture));
    for (const SceneRecord& scene : t.scenes) PROBE_TRY(fixtures_of(scene));
    for (const TaskRecord& task : t.tasks) {
      for (const EpisodeRecord& episode : slice_of(t.episodes, task.episodes))
        PROBE_TRY(start(t.scenes[task.scene], episode));
    }
    return {};
  }

 private:
  Status owners() const {
    std::uint64_t joints = 0, parts = 0, shown = 0;
    for (const FixtureRecord& f : t.fixtures) {
      if (f.shown.count > 0 && f.shown.first != shown)
        return fail(Rule::kShownOwned, &f.shown,
                    fmt::format("what it shows begins at record {} of SHOW", shown));
      shown += f.shown.count;
      std::unordered_set<std::string_view> links;
      for (const ShownRecord& one : slice_of(t.shown, f.shown)) {
        PROBE_TRY(check_index(one.joint, f.joints.count, "FJNT"));
        if (links.insert(t.text(one.link)).second) continue;
        return fail(Rule::kShownOwned, &one.link,
                    fmt::format("link `{}` is shown twice", t.text(one.link)));
      }
      if ((f.joints.count > 0 && f.joints.first != joints) ||
          (f.parts.count > 0 && f.parts.first != parts)) {
        return fail(Rule::kFixtureOwned, &f.joints,
                    fmt::format("its joints begin at record {} of FJNT, its parts at {} of PART",
                                joints, parts));
      }
      joints += f.joints.count;
      parts += f.parts.count;
      for (const PartRecord& part : slice_of(t.parts, f.parts)) {
        if (part.joint != kNone) PROBE_TRY(check_index(part.joint, f.joints.count, "FJNT"));
      }
    }
    if (joints != t.fixture_joints.size())
      return fail(Rule::kFixtureOwned, &t.fixture_joints[joints], "a joint belongs to a fixture");
    if (parts != t.parts.size())
      return fail(Rule::kFixtureOwned, &t.parts[parts], "a part belongs to a fixture");
    if (shown != t.shown.size())
      return fail(Rule::kShownOwned, &t.shown[shown], "what is shown belongs to a fixture");
    return {};
  }

  Status part_names(const FixtureRecord& fixture) const {
    std::unordered_set<std::string_view> seen;
    for (const PartRecord& part : slice_of(t.parts, fixture.parts)) {
      if (!seen.insert(t.text(part.name)).second) {
        return fail(Rule::kPartName, &part.name,
                    fmt::format("two parts are called `{}`", t.text(part.name)));
      }
    }
    return {};
  }

  // By name: one that stands on surfaces of two heights has a record for each.
  Status fixtures_of(const SceneRecord& scene) const {
    std::unordered_set<std::string_view> seen;
    for (const std::uint32_t& fixture : slice_of(t.list, scene.fixtures)) {
      if (seen.insert(t.text(t.fixtures[fixture].name)).second) continue;
      return fail(Rule::kFixtureTwice, &fixture,
                  fmt::format("fixture `{}` stands twice in scene `{}`",
                              t.text(t.fixtures[fixture].name), t.text(scene.name)));
    }
    return {};
  }

  Status start(const SceneRecord& scene, const EpisodeRecord& episode) const {
    if (episode.joints.count == 0) return {};
    const auto joints = joints_of(t, scene);
    const auto positions = slice_of(t.reals, episode.joints);
    if (joints.size() != positions.size()) {
      return fail(Rule::kFixtureStart, &episode.joints,
                  fmt::format("an episode begins with {} joints, its fixtures have {}",
                              positions.size(), joints.size()));
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      PROBE_TRY(check_magnitude(positions[i], Magnitude::kJointPosition));
      if (is_within(*joints[i], positions[i])) continue;
      return fail(
          Rule::kFixtureStart, &episode.joints,
          fmt::format("joint `{}` begins at {}, its limits are {} and {}", t.text(joints[i]->joint),
                      positions[i], joints[i]->lower, joints[i]->upper));
    }
    return {};
  }
};

}  // namespace

Status verify_fixtures(std::span<const std::byte> bytes, const Tables& tables) {
  return FixtureCheck(bytes, tables).run();
}

}  // namespace probe::plan
