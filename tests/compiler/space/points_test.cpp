// Points of a space as text: each compiles, and moves what it says and nothing else.
#include "compiler/space/points.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "runtime/plan/axes.h"
#include "tests/compiler/space/space_text.h"

namespace probe::space {
namespace {

const char* const kEverything = R"(
space around of carrot_on_plate {
  light ambient 0.05 .. 0.6, power 0.2 .. 3, direction within 60deg
  camera third_view within (5cm, 5cm, 5cm), 8deg
  place source in disc 2cm
  clutter 0 .. 6 from (nut, rabbit)
  words templates of put, phrases of source
  sensor noise 0 .. 0.1, blur 0px .. 3px, exposure 0.2 .. 2
  delay 0ms .. 600ms
}
)";

std::size_t axis_called(const sema::Space& space, const std::string& name) {
  const auto found = std::ranges::find(space.axes, name, &sema::SpaceAxis::name);
  REQUIRE_MESSAGE(found != space.axes.end(), name);
  return static_cast<std::size_t>(found - space.axes.begin());
}

// The point's variant, compiled beside the text.
const sema::Task& compiled(const SpaceText& base, const WrittenPoint& written, AnalyzedText& to,
                           const std::string& name) {
  const std::string file = base.folder / (name + ".probe");
  std::ofstream(file) << "use \"mine.probe\"\n" << written.text;
  if (written.table) std::ofstream(base.folder / written.table->file) << written.table->text;
  to = analyzed(file);
  return *std::ranges::find(to.model.tasks, name, &sema::Task::name);
}

TEST_CASE("every axis of a space alone moves the axis of plans that it stands for") {
  const auto base = space_text(kEverything);
  const sema::Space& space = base->space();
  struct Moved {
    const char* axis;
    double value;
    std::vector<plan::Axis> moves;
  };
  using plan::Axis;
  const Moved all[] = {
      {"light.ambient", 0.1, {Axis::kLight}},
      {"light.power", 0.5, {Axis::kLight}},
      {"light.direction", 0.5, {Axis::kLight}},
      {"camera.third_view.x", 0.03, {Axis::kCamera}},
      {"camera.third_view.turn", 0.1, {Axis::kCamera}},
      {"place.source", 0.01, {Axis::kLayout}},
      {"clutter", 3, {Axis::kDistractors, Axis::kLayout}},
      {"phrase.source", 1, {}},
      {"sensor.noise", 0.05, {Axis::kSensor}},
      {"sensor.blur", 1, {Axis::kSensor}},
      {"sensor.exposure", 0.5, {Axis::kSensor}},
      {"delay", 2, {Axis::kLatency}},
  };
  for (const Moved& moved : all) {
    CAPTURE(moved.axis);
    Point point{std::string("p"), own_values(space), 7, {}};
    for (char& c : point.name) c = 'p';
    point.values[axis_called(space, moved.axis)] = moved.value;
    const WrittenPoint written = write_point(base->text.model, space, point, false);
    REQUIRE(written.left_out.empty());
    INFO(written.text);
    AnalyzedText text;
    const sema::Task& task = compiled(*base, written, text, "p");
    CHECK(task.axes != 0);
    CHECK(written.starts.size() == task.starts.size());
    if (moved.moves.empty()) continue;
    std::uint32_t mask = 0;
    for (const plan::Axis axis : moved.moves) mask |= plan::bit(axis);
    CHECK(task.axes == mask);
  }
}

TEST_CASE("a point at which nothing is changed has no axis, and a noise that nobody sees is none") {
  const auto base = space_text(kEverything);
  std::vector<double> values = own_values(base->space());
  CHECK(changed_axes(base->space(), values).empty());
  CHECK(point_text(base->space(), values) == "nothing");
  values[axis_called(base->space(), "sensor.noise")] = 0.003;
  values[axis_called(base->space(), "sensor.blur")] = 0.005;
  CHECK(changed_axes(base->space(), values).empty());
  values[axis_called(base->space(), "light.power")] = 0.5;
  values[axis_called(base->space(), "clutter")] = 2;
  CHECK(point_text(base->space(), values) == "light.power x 0.5, clutter 2");
}

TEST_CASE("what is moved lies as far from its start as the point says, in each another way") {
  const auto base = space_text(kEverything);
  const sema::Space& space = base->space();
  Point point{"p", own_values(space), 7, {}};
  point.values[axis_called(space, "place.source")] = 0.015;
  const WrittenPoint written = write_point(base->text.model, space, point, false);
  AnalyzedText text;
  const sema::Task& moved = compiled(*base, written, text, "p");
  const sema::Task& own = base->text.model.tasks[space.of];
  REQUIRE(moved.starts.size() == own.starts.size());
  double first = 0;
  bool is_alike = true;
  for (std::size_t i = 0; i < own.starts.size(); ++i) {
    const auto& a = own.starts[i].placed[0];
    const auto& b = moved.starts[i].placed[0];
    CHECK(std::hypot(b.x - a.x, b.y - a.y) == doctest::Approx(0.015));
    CHECK(own.starts[i].placed[1].x == moved.starts[i].placed[1].x);
    const double way = std::atan2(b.y - a.y, b.x - a.x);
    if (i == 0) first = way;
    is_alike = is_alike && std::abs(way - first) < 1e-3;
  }
  CHECK_FALSE(is_alike);
}

TEST_CASE("more clutter leaves the first of it where it was, and more than are listed are copies") {
  const auto base = space_text(kEverything);
  const sema::Space& space = base->space();
  const std::size_t clutter = axis_called(space, "clutter");
  std::string few, many;
  for (const auto& [count, to] : {std::pair(1.0, &few), std::pair(3.0, &many)}) {
    Point point{"p", own_values(space), 7, {0}};
    point.values[clutter] = count;
    const WrittenPoint written = write_point(base->text.model, space, point, false);
    REQUIRE(written.table);
    *to = written.table->text;
  }
  CHECK(many.starts_with(few));
  CHECK(many.find("0,p_nut2,") != std::string::npos);
}

TEST_CASE("numbers of any size are ones that the language reads") {
  const auto base = space_text(
      "space around of carrot_on_plate { light ambient 0.00001 .. 0.6, power 0.2 .. 3 }\n");
  for (const double ambient : {2.7e-5, 1.0 / 3, 0.0056152156819127596, 0.1 + 0.2}) {
    CAPTURE(ambient);
    Point point{"p", {ambient, 0.7 / 3}, 3, {}};
    AnalyzedText text;
    const auto written = write_point(base->text.model, base->space(), point, false);
    const sema::Task& task = compiled(*base, written, text, "p");
    CHECK(text.model.lights[task.light].ambient == doctest::Approx(ambient).epsilon(1e-12));
  }
}

TEST_CASE(
    "starts that have heights keep them when things lie around, which have heights of their own") {
  const auto base = space_text(
      R"(
layout high { starts "high.csv"; drop 1cm settle 0.5s }
variant lifted of carrot_on_plate { layout high }
space around of lifted { clutter 0 .. 2 from (nut, rabbit) }
)",
      {{"high.csv",
        "start,object,x_m,y_m,z_m\n0,carrot,-0.16,0.075,0.95\n0,plate,-0.16,-0.075,0.90\n"}});
  Point point{"p", {2}, 3, {}};
  AnalyzedText text;
  const auto written = write_point(base->text.model, base->space(), point, false);
  const sema::Task& task = compiled(*base, written, text, "p");
  REQUIRE(task.starts.size() == 1);
  REQUIRE(task.starts[0].placed.size() == 4);
  CHECK(task.starts[0].placed[0].z == 0.95);
  for (const auto& placed : task.starts[0].placed) CHECK(placed.z.has_value());
}

TEST_CASE("clutter keeps clear of the ways of fixtures' parts, as far as there is room") {
  const auto base = space_text(kEverything);
  const sema::Space& space = base->space();
  Point point{"p", own_values(space), 5, {}};
  point.values[axis_called(space, "clutter")] = 3;
  const sema::Task& own = base->text.model.tasks[space.of];
  const sema::Scene& scene = base->text.model.scenes[own.scene];
  // A part that sweeps one half of the area.
  const double middle = (scene.area[1] + scene.area[3]) / 2;
  sema::PartBox part;
  part.solid = scene::upright_solid({scene.area[0], scene.area[1], scene.surface_z},
                                    {scene.area[2], middle, scene.surface_z + 0.1});
  part.half = part.solid.half_extent();
  const auto in_its_way = [&](const sema::PartBoxes& ways) {
    const WrittenPoint written = write_point(base->text.model, space, point, false, ways);
    AnalyzedText text;
    const sema::Task& task = compiled(*base, written, text, "p");
    REQUIRE(task.starts.size() == own.starts.size());
    int found = 0;
    for (const sema::Start& start : task.starts) {
      for (const sema::Start::Placed& placed : start.placed) {
        const std::string& name = text.model.objects[placed.object].name;
        const bool is_clutter = name.find("nut") != name.npos || name.find("rabbit") != name.npos;
        found += is_clutter && placed.y < middle ? 1 : 0;
      }
    }
    return found;
  };
  CHECK(in_its_way({}) > 10);
  CHECK(in_its_way(sema::PartBoxes({part})) == 0);
  part.solid = scene::upright_solid({scene.area[0], scene.area[1], scene.surface_z},
                                    {scene.area[2], scene.area[3], scene.surface_z + 0.1});
  part.half = part.solid.half_extent();
  const WrittenPoint none =
      write_point(base->text.model, space, point, false, sema::PartBoxes({part}));
  CHECK(none.left_out.find("find no room") != std::string::npos);
}

TEST_CASE("draws follow from the point alone, so the same point is the same text") {
  const auto base = space_text(kEverything);
  const sema::Space& space = base->space();
  Point point{"p", own_values(space), 11, {}};
  point.values[axis_called(space, "light.direction")] = 0.4;
  point.values[axis_called(space, "camera.third_view.turn")] = 0.1;
  const auto once = write_point(base->text.model, space, point, false);
  CHECK(once.text == write_point(base->text.model, space, point, false).text);
  point.draw = 12;
  CHECK(once.text != write_point(base->text.model, space, point, false).text);
}

TEST_CASE("lamps of a light that lights corners keep all that they have") {
  const auto base = space_text(R"(
light lamps {
  ambient 0.1
  spot at (1m, 1m, 4m) along (0, -0.15, -1) power 0.8 specular 0.3 cutoff 45deg exponent 10 fade (1, 0.5, 0)
  headlight power 0.4 specular 0.5 ambient 0.1
  sun (0, 0, -1) power 0.5 specular 0.2
  shading vertex
  color (1, 0.9, 0.8)
}
variant lit of carrot_on_plate { light lamps }
space around of lit { light power 0.5 .. 2 }
)");
  Point point{"p", {0.5}, 3, {}};
  AnalyzedText text;
  const auto written = write_point(base->text.model, base->space(), point, false);
  INFO(written.text);
  const sema::Task& task = compiled(*base, written, text, "p");
  const sema::Light& own = *std::ranges::find(base->text.model.lights, "lamps", &sema::Light::name);
  sema::Light made = text.model.lights[task.light];
  REQUIRE(made.lamps.size() == 3);
  for (plan::LampRecord& lamp : made.lamps) {
    lamp.power *= 2;
    lamp.specular *= 2;
    lamp.ambient *= 2;
  }
  CHECK(made == own);
}

}  // namespace
}  // namespace probe::space
