// Every start of the suite against the released one, compared to the last bit.
#include <doctest/doctest.h>

#include "runtime/base/trig.h"
#include "tests/parity/published.h"

using namespace probe;

namespace {

// A turn about x or about z: no published pose has more than one.
std::array<double, 4> rotation(const test::PublishedPose& pose) {
  REQUIRE(pose.pitch == 0);
  REQUIRE((pose.roll == 0 || pose.yaw == 0));
  const SinCos about_x = portable_sincos_deg(pose.roll / 2);
  const SinCos about_z = portable_sincos_deg(pose.yaw / 2);
  if (pose.roll != 0) return {about_x.cos, about_x.sin, 0, 0};
  return {about_z.cos, 0, 0, about_z.sin};
}

}  // namespace

TEST_CASE("every start equals the published one to the last bit, in the published order") {
  const test::Published* released = test::published();
  if (released == nullptr) return;
  const plan::Plan& plan = test::suite_plan();
  std::size_t poses = 0, starts = 0, tasks = 0;
  for (const plan::TaskRecord& task : plan.tasks()) {
    const std::string name(plan.text(task.name));
    CAPTURE(name);
    const auto found = released->starts.find("widowx_" + name);
    REQUIRE(found != released->starts.end());
    const std::vector<test::PublishedPose>& rows = found->second;
    CHECK(task.episodes.count == 24);
    std::size_t at = 0;
    for (std::uint32_t e = 0; e < task.episodes.count; ++e) {
      const plan::EpisodeRecord& episode = plan.episodes()[task.episodes.first + e];
      for (const plan::PlacementRecord& placement :
           plan::slice_of(plan.tables().placements, episode.placements)) {
        REQUIRE(at < rows.size());
        const test::PublishedPose& row = rows[at++];
        CAPTURE(e);
        CHECK(row.episode == static_cast<int>(e));
        CHECK(row.object == plan.text(plan.objects()[placement.object].name));
        CHECK(placement.position == std::array<double, 3>{row.x, row.y, 0.87 + 0.5});
        CHECK(placement.rotation == rotation(row));
        ++poses;
      }
      ++starts;
    }
    CHECK(at == rows.size());
    ++tasks;
  }
  MESSAGE(poses << " object poses of " << starts << " starts of " << tasks
                << " tasks are bit-equal to the published ones");
  CHECK(poses == 3168);
  CHECK(starts == 1224);
  CHECK(tasks == released->tasks.size());
}

TEST_CASE("boxes and densities are the published ones") {
  const test::Published* released = test::published();
  if (released == nullptr) return;
  const plan::Plan& plan = test::suite_plan();
  std::size_t objects = 0;
  for (const plan::ObjectRecord& object : plan.objects()) {
    const std::string name(plan.text(object.name));
    CAPTURE(name);
    REQUIRE(released->objects.contains(name));
    const auto& entry = released->objects[name];
    const double scale = entry["scale"].get<double>();
    for (std::size_t i = 0; i < 3; ++i) {
      // A scale of 1.25 is written out in the catalogue: a rounding apart.
      CHECK(std::abs(object.box_min[i] - entry["bbox_min"][i].get<double>() * scale) < 1e-15);
      CHECK(std::abs(object.box_max[i] - entry["bbox_max"][i].get<double>() * scale) < 1e-15);
    }
    CHECK(object.density == entry["density_kg_m3"].get<double>());
    ++objects;
  }
  MESSAGE(objects << " objects have the published box and density");
  CHECK(objects == released->objects.size());
}
