#include <doctest/doctest.h>

#include "compiler/geometry/mesh_bounds.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

// Meshes by the names that the tests below give them.
void write_mesh(const std::string& name, const std::string& vertices) {
  const std::filesystem::path folder = std::filesystem::path(test::asset_root()) / "objects" / name;
  test::write_text(folder / "visual.glb", "visual");
  test::write_text(folder / "collision.obj", vertices);
}

// A bar of 12 x 2 x 3 cm about its origin, and a cup of 4 x 4 x 6 cm that stands on it.
void write_meshes() {
  write_mesh("bar", "# bar\nv -0.06 -0.01 -0.015\nv 0.06 0.01 0.015\nf 1 2 1\n");
  write_mesh("cup", "v -0.02 -0.02 0\nv 0.02 0.02 0.06\n");
}

std::string object(const std::string& statements) {
  return "object o like red { " + statements + " }\n";
}

}  // namespace

TEST_CASE("the bounds of a Wavefront text are those of its positions") {
  const auto bounds = sema::bounds_of_obj("o x\nv 1 2 3\r\nvn 9 9 9\nv -1 5 -3\nf 1 2 1");
  REQUIRE(bounds);
  CHECK(bounds->low == std::array{-1.0, 2.0, -3.0});
  CHECK(bounds->high == std::array{1.0, 5.0, 3.0});
  CHECK(!sema::bounds_of_obj(""));
  CHECK(!sema::bounds_of_obj("v 1 2\n"));
  CHECK(!sema::bounds_of_obj("v 1 2 nan\n"));
  CHECK(!sema::bounds_of_mesh(test::asset_root(), "no_such_mesh"));
}

TEST_CASE("a box that is not that of its mesh is answered with the mesh's") {
  write_meshes();
  const auto a = analyze_with_suite(object("mesh \"bar\"; box 2cm x 12cm x 3cm"));
  CHECK_MESSAGE(a->codes() == "P0506", a->said());
  CHECK(a->underlined() == "box 2cm x 12cm x 3cm");
  const Diagnostic& found = a->diagnostics.items().front();
  CHECK(found.primary_label == "declared 2cm x 12cm x 3cm");
  CHECK(found.labels[0].text == "the mesh measures 12cm x 2cm x 3cm");
  REQUIRE(found.fix);
  CHECK(found.fix->replacements[0].text == "box 12cm x 2cm x 3cm");
}

TEST_CASE("a box that was copied with another mesh gets one of its own") {
  write_meshes();
  const auto a = analyze_with_suite(object("mesh \"cup\""));
  CHECK_MESSAGE(a->codes() == "P0506", a->said());
  CHECK(a->underlined() == "\"cup\"");
  REQUIRE(a->diagnostics.items().front().fix);
  CHECK(a->diagnostics.items().front().fix->replacements[0].text ==
        "; box (-2cm, -2cm, 0cm) .. (2cm, 2cm, 6cm)");
}

TEST_CASE("a box within five millimetres and a tenth of each side is fine, a shifted one is not") {
  write_meshes();
  const auto codes = [](const std::string& box) {
    return analyze_with_suite(object("mesh \"bar\"; box " + box))->codes();
  };
  CHECK(codes("12cm x 2cm x 3cm") == "");
  CHECK(codes("12.9cm x 2.1cm x 3.2cm") == "");
  CHECK(codes("13.1cm x 2cm x 3cm") == "P0506");  // each end 5.5 mm out
  CHECK(codes("12cm x 2.3cm x 3cm") == "P0506");  // 15 % of a side
  CHECK(codes("(-5cm, -1cm, -1.5cm) .. (7cm, 1cm, 1.5cm)") == "P0506");
  CHECK(codes("(-6cm, -1cm, -1.5cm) .. (6cm, 1cm, 1.5cm)") == "");
}

TEST_CASE("a reason silences a box, a copy is not doubted again, a wrong unit is said alone") {
  write_meshes();
  const std::string wrong = object("mesh \"bar\"; box 2cm x 2cm x 2cm");
  CHECK(analyze_with_suite("@allow(box, \"as published\")\n" + wrong)->codes() == "");
  CHECK(analyze_with_suite(wrong + "object p like o { color blue; paint blue; name \"p\" }")->codes() ==
        "P0506");
  CHECK(analyze_with_suite(object("mesh \"bar\"; box 12deg x 2cm x 3cm"))->codes() == "P0302");
}
