#include <doctest/doctest.h>

#include "compiler/emit/compile.h"
#include "compiler/emit/emit.h"
#include "tests/compiler/small_suite.h"

using namespace probe;

namespace {

// The codes for one metric of the small suite's task, after lowering.
std::string codes(const std::string& metric, const std::string& more = "") {
  auto a = test::analyze_with_suite(more + "\nmetrics m like plain { x = " + metric +
                                    " }\ntask t like red_on_tray { metrics m }");
  if (!a->diagnostics.has_errors()) {
    const auto bytes = emit::emit(a->model, a->sources, {a->files[0].file.id},
                                  {test::asset_root(), "", "", false}, a->diagnostics);
    REQUIRE(bytes.ok());
  }
  return a->codes();
}

}  // namespace

TEST_CASE("a metric that no measurement can change is constant") {
  CHECK(codes("once distance(source, target) < 0m") == "P0602");
  CHECK(codes("at end distance(source, target) >= 0cm") == "P0602");
  CHECK(codes("once grip > 1.5") == "P0602");
  CHECK(codes("once step > 60") == "P0602");
  CHECK(codes("once step > 59") == "");
  CHECK(codes("once (abs(height(source)) + 1cm < 5mm)") == "P0602");
  CHECK(codes("once (height(source) < height(source))") == "P0602");
  CHECK(codes("once height(source) < 1m") == "P0607");  // in the starts there are
}

TEST_CASE("a metric that is constant since nothing is in a set names the set") {
  auto a = test::analyze_with_suite(
      "metrics m like plain { x = once any d in distractors: height(d) > 5cm\n"
      "  y = once any o in others: height(o) > 500m }\n"
      "task t like red_on_tray { metrics m }");
  REQUIRE_MESSAGE(!a->diagnostics.has_errors(), a->said());
  REQUIRE(emit::emit(a->model, a->sources, {a->files[0].file.id},
                     {test::asset_root(), "", "", false}, a->diagnostics)
              .ok());
  REQUIRE(a->codes() == "P0602 P0602");
  const Diagnostic& empty = a->diagnostics.items()[0];
  REQUIRE(empty.labels.size() == 1);
  CHECK(empty.labels[0].text == "nothing is in it");
  CHECK(a->sources.file(empty.labels[0].span.file)
            .text()
            .substr(empty.labels[0].span.begin, empty.labels[0].span.size()) == "distractors");
  CHECK(a->diagnostics.items()[1].labels.empty());
}

TEST_CASE("every read-out of a constant is constant") {
  CHECK(codes("max 3") == "P0602");
  CHECK(codes("min 3cm") == "P0602");
  CHECK(codes("final 3") == "P0602");
  CHECK(codes("max max(2cm, 3cm)") == "P0602");
  CHECK(codes("count grip > 1.5") == "P0602");
  CHECK(codes("count grip <= 1") == "P0602");
  CHECK(codes("first grip > 1.5") == "P0602");
  CHECK(codes("always grip >= 0") == "P0602");
  CHECK(codes("max height(source)") == "");
  CHECK(codes("count grip > 0.5") == "");
  CHECK(codes("first grip > 0.5") == "");
}

TEST_CASE("what no room holds is never true, by every comparison") {
  CHECK(codes("once height(source) > 100m") == "P0602");
  CHECK(codes("once height(source) >= 100m") == "P0602");
  CHECK(codes("once height(source) < -100m") == "P0602");
  CHECK(codes("once height(source) <= -100m") == "P0602");
  CHECK(codes("once 100m < height(source)") == "P0602");
  CHECK(codes("always height(source) < 100m") == "P0602");
  CHECK(codes("once distance(source, target) > 100m") == "P0602");
  CHECK(codes("once distance_xy(source, target) > 100m") == "P0602");
  CHECK(codes("once moved_xy(source) > 100m") == "P0602");
  CHECK(codes("once half_height(source) > 100m") == "P0602");
  CHECK(codes("once height(source) - height(target) > 100m") == "P0602");
  CHECK(codes("once time > 13s") == "P0602");
  CHECK(codes("once time > 11s") == "");
  CHECK(codes("once height(source) > 10m") == "");
  CHECK(codes("once distance(source, target) > 10m") == "");
  CHECK(codes("once distance(tcp, source) == 100m") == "P0606 P0602");
  CHECK(codes("once distance(tcp, source) != 100m") == "P0606 P0607 P0602");
  CHECK(codes("once impulse(source, target) > 1000Ns") == "");
}

TEST_CASE("a room is as large as its scene and objects are") {
  const std::string far =
      "scene far like bench { robot arm at (50cm, 0cm) yaw 180deg; surface 500m area (-50cm, "
      "-50cm) .. (50cm, 50cm) }\n"
      "abstract task away like red_on_tray { scene far }\n";
  const auto codes_there = [&](const std::string& metric) {
    auto a = test::analyze_with_suite(far + "metrics m like plain { x = " + metric +
                                      " }\ntask t like away { metrics m }");
    REQUIRE_MESSAGE(!a->diagnostics.has_errors(), a->said());
    // The small suite's own task stands at the bench and keeps its own metrics.
    const auto bytes = emit::emit(a->model, a->sources, {a->files[0].file.id},
                                  {test::asset_root(), "", "", false}, a->diagnostics);
    REQUIRE(bytes.ok());
    return a->codes();
  };
  // P0303 doubts lengths like these.
  CHECK(codes_there("once height(source) > 490m") == "P0303");
  CHECK(codes_there("once height(source) > 600m") == "P0303 P0602");
  CHECK(codes("once half_height(source) > 15m") == "P0602");
}

TEST_CASE("an angle between two vectors is at most half a turn") {
  CHECK(codes("once angle(axis_z(source), up) <= 200deg") == "P0304");
  CHECK(codes("once angle(axis_z(source), up) > -20deg") == "P0304");
  CHECK(codes("once angle(axis_z(source), up) <= 180deg") == "P0607 P0602");
  CHECK(codes("once angle(axis_z(source), up) < 0deg") == "P0602");
  CHECK(codes("once angle(axis_z(source), up) > 180deg") == "P0602");
  CHECK(codes("once angle(axis_z(source), up) <= 20deg") == "P0607");
}

TEST_CASE("alternatives that leave nothing out are always true") {
  CHECK(codes("once (grip < 0.5 or grip > 0.3)") == "P0607 P0602");
  CHECK(codes("once (grip <= 0.5 or grip > 0.5)") == "P0607 P0602");
  CHECK(codes("once (grip < 0.5 or not grip < 0.5)") == "P0607 P0602");
  CHECK(codes("once (grip < 0.3 or grip > 0.5)") == "");
}

TEST_CASE("conditions that exclude one another are a contradiction") {
  CHECK(codes("once (height(source) < height(target) and height(source) > height(target))") ==
        "P0603");
  CHECK(codes("once (height(source) <= height(target) and height(source) >= height(target))") ==
        "");
  CHECK(codes("once (distance(tcp, source) < 5cm and distance(tcp, source) > 10cm)") == "P0603");
  CHECK(codes("once (height(source) < 5cm and grip > 0.5 and height(source) >= 5cm)") == "P0603");
  CHECK(codes("once (height(source) <= 5cm and height(source) >= 5cm)") == "");
  CHECK(codes("once (not height(source) < 5cm and height(source) < 4cm)") == "P0603");
  CHECK(codes("once (near(source) and distance(tcp, source) > 10cm)",
              "predicate near(o: object) = distance(tcp, o) < 5cm") == "P0603");
  CHECK(codes("once (distance(tcp, source) < 5cm or distance(tcp, source) > 10cm)") == "");
}

TEST_CASE("a condition over no distractors is constant only where no task has any") {
  const std::string metric = "once (any d in distractors: moved_xy(d) > 3cm)";
  CHECK(codes(metric) == "P0602");
  CHECK(codes(metric, "task u like red_on_tray { metrics m; distractors blue }") == "");
}

TEST_CASE(
    "a metric that only a shorter episode makes constant is none where tasks share a program") {
  const std::string late = "metrics m like plain { late = once step > 100 }\n";
  const auto said = [&](const std::string& first, const std::string& second) {
    auto a =
        test::analyze_with_suite(late + "task a like red_on_tray { metrics m; horizon " + first +
                                 " steps }\nvariant b of a { horizon " + second + " steps }");
    REQUIRE_MESSAGE(!a->diagnostics.has_errors(), a->said());
    const auto bytes = emit::emit(a->model, a->sources, {a->files[0].file.id},
                                  {test::asset_root(), "", "", false}, a->diagnostics);
    REQUIRE(bytes.ok());
    return a->codes();
  };
  CHECK(said("60", "200") == "");
  CHECK(said("200", "60") == "");
  CHECK(said("60", "90") == "P0602");
}
