// The text itself: words, numbers, lines, files. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

TEST_CASE("comment: a `#` ends the line's meaning, inside a string it is a letter") {
  const auto a = clean(
      "variant v of red_on_tray { say \"put # {source} on {target}\" } # variant v of nothing\n"
      "## two marks document the next declaration\nvariant w of red_on_tray { say take }\n");
  CHECK(a->task("v").prompt == "put # red block on tray");
  CHECK(a->files[0].file.decls.back().docs ==
        std::vector<std::string_view>{"two marks document the next declaration"});
}

TEST_CASE("ident: words are special only where the grammar wants them") {
  const auto a = clean(
      "object task like red { name \"task\" }\nattribute like { source, say }\n"
      "object Variant_2 like red { like say; color blue; paint blue; name \"second\" }\n"
      "variant suite of red_on_tray { source task }\nvariant set of suite { distractors Variant_2 "
      "}\n");
  CHECK(a->task("suite").prompt == "put task on the tray");
  CHECK(named(a->model.attributes, "like").values == std::vector<std::string>{"source", "say"});
}

TEST_CASE("number, unit, quantity: the decimal is converted exactly and rounded once") {
  const auto a = clean(
      "object o like red { box 20.6cm x 206mm x 0.206m; density 1.5e3kg/m3; name \"o\" }\n"
      "layout l like pairs { drop 2.5e+1cm settle 1500ms; orient by rest }\n"
      "layout turned like pairs { orient source yaw 90deg, yaw -0.5rad; orient target yaw +0deg }\n"
      "variant v of red_on_tray { layout l }\nvariant w of red_on_tray { layout turned }\n");
  for (const double side : named(a->model.objects, "o").box_max) CHECK(side == 0.206 / 2);
  CHECK(named(a->model.objects, "o").density == 1500);
  CHECK(named(a->model.layouts, "l").drop == 0.25);
  CHECK(named(a->model.layouts, "l").settle == 1.5);
  CHECK(starts_text(*a, "w")[0] == "red -10,-10@90 tray -10,10@0");
  CHECK(starts_text(*a, "w")[1] ==
        "red -10,-10@" + number_text(-0.5 * 180 / 3.14159265358979) + " tray -10,10@0");
  // Every unit stands for its dimension: what it is wrong for is said by name.
  const std::pair<const char*, const char*> units[] = {
      {"1m", "a length"},       {"1cm", "a length"},   {"1mm", "a length"},
      {"1s", "a time"},         {"1ms", "a time"},     {"1Hz", "a frequency"},
      {"1kg/m3", "a density"},  {"1Ns", "an impulse"}, {"1deg", "an angle"},
      {"1rad", "an angle"},     {"1N", "a force"},     {"1Nm", "a torque"},
      {"1px", "a pixel count"}, {"1", "a number"}};
  for (const auto& unit : units) {
    const auto text = unit.first, name = unit.second;
    const auto wrong =
        analyze_with_suite("object o like red { density " + std::string(text) + "; name \"o\" }\n");
    if (std::string(name) == "a density") {
      CHECK(!wrong->diagnostics.has_errors());
    } else {
      CHECK_MESSAGE(wrong->said().find(std::string("found ") + name) != std::string::npos, text,
                    "\n", wrong->said());
    }
  }
}

TEST_CASE("string: a quote, a backslash and a line are written with a backslash") {
  const auto a = clean(
      "object o like red { name \"the \\\"O\\\" \\\\ thing\" bare }\n"
      "variant v of red_on_tray { source o }\n");
  CHECK(a->task("v").prompt == "put the \"O\" \\ thing on the tray");
  CHECK(analyze_with_suite("variant v of red_on_tray { say \"put \\t\" }")->codes() == "P0105");
}

TEST_CASE("NL: a line ends a statement where one can end, and `;` ends it anywhere") {
  const auto a = clean(
      "@allow(confounded, \"test\")\nvariant v of red_on_tray {\n source blue; distractors red,\n "
      "pale\n say take }\n"
      "predicate p(a: object,\n  b: object) =\n height(a) >\n height(b) and "
      "  (grip\n > 0.5)\n"
      "variant w of red_on_tray { set success = at end p(source, target) };;\n\n;\n"
      "variant x of red_on_tray { horizon 61 steps };variant y of red_on_tray { say take }\n");
  CHECK(a->task("v").prompt == "take the blue block to the tray");
  CHECK(axes_text(*a, "v") == "object.source distractors language.action");
  CHECK(axes_text(*a, "y") == "language.action");
}

TEST_CASE("int: a whole number has no unit, no point and no exponent") {
  CHECK(clean("variant v of red_on_tray { horizon 61 steps }")->task("v").horizon == 61);
  for (const char* steps : {"61.0", "6e1", "61s", "-61"}) {
    const auto a =
        analyze_with_suite("variant v of red_on_tray { horizon " + std::string(steps) + " steps }");
    CHECK_MESSAGE(a->codes().starts_with("P01"), steps, " ", a->codes());
  }
}

TEST_CASE("names, name_set, path, point: lists keep their order, sets may span lines") {
  const auto a = clean(
      "attribute size {\n  small,\n  large\n}\n"
      "set s = {\n  red_on_tray\n}\n"
      "variant v of red_on_tray { distractors pale, blue }\n"
      "camera c { mount arm.base at (1cm, -2cm, 1m) look (1, 0, -1); "
      "image 64 x 48; lens 30px, 30px, 32px, 24px }\n");
  CHECK(named(a->model.attributes, "size").values == std::vector<std::string>{"small", "large"});
  CHECK(names_text(*a, named(a->model.sets, "s").members) == "red_on_tray");
  CHECK(a->model.objects[a->task("v").distractors[0]].name == "pale");
  CHECK(named(a->model.cameras, "c").mount_link.text == "base");
  CHECK(named(a->model.cameras, "c").position == std::array<double, 3>{0.01, -0.02, 1});
}

TEST_CASE("block: empty, on one line and on many, with any number of ends between statements") {
  const auto a = clean(
      "light a {}\nlight b { ;; ambient 0.5 ;\n; sun (0, 0, -1) power 2;\n}\n"
      "object twin like red {\n\n}\n");
  CHECK(named(a->model.lights, "a").suns.empty());
  CHECK(named(a->model.lights, "b").suns.size() == 1);
  CHECK(named(a->model.objects, "twin").density == 500);
}

TEST_CASE("file, decl: the order of declarations has no meaning, and kinds share names") {
  const std::string tasks = "task late like base { source red; target tray; layout red }\n";
  const std::string layout = "layout red like pairs { drop 20cm }\n";
  const auto before = clean(tasks + layout), after = clean(layout + tasks);
  CHECK(starts_text(*before, "late") == starts_text(*after, "late"));
  CHECK(named(before->model.layouts, "red").drop == 0.2);
  CHECK(analyze_with_suite("layout pairs {}")->codes().starts_with("P0203"));
}

TEST_CASE("decl: `use` brings in another file's names, once, also in a circle") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("probe_use_" + std::to_string(getpid()));
  write_text(folder / "world.probe", std::string("use \"own.probe\"\n") + kSmallSuite);
  write_text(folder / "own.probe",
             "use \"world.probe\"\nuse \"world.probe\"\nvariant v of red_on_tray { say take }\n");
  const std::string file = (folder / "own.probe").string();
  const auto built = build(std::span<const std::string>(&file, 1), {asset_root(), ""});
  std::filesystem::remove_all(folder);
  REQUIRE(built.ok());
  CHECK_MESSAGE(built->ok, render_text(built->diagnostics, built->sources));
  CHECK(built->sources.size() == 2);
}

TEST_CASE("allow: the reason stands in the plan, and silences that warning alone") {
  const std::string two = "variant v of red_on_tray { say take; light night }\n";
  CHECK(analyze_with_suite(two)->codes() == "P0701");
  const Built built("@allow(confounded, \"both, to see \\\"more\\\"\")\n" + two);
  CHECK(built.plan().text(built.task("v").allow) == "both, to see \"more\"");
  CHECK(built.plan().text(built.task("red_on_tray").allow).empty());
  // On its own line or before the declaration; two of them above one.
  CHECK(
      clean("@allow(confounded, \"a\") @allow(unknown_referent, \"b\")\n"
            "variant v of red_on_tray { light night; distractors pale; refer source as by_color }")
          ->task("v")
          .allow_confounded == "a");
  CHECK(analyze_with_suite("@allow(confused, \"why\")\n" + two)->codes() == "P0208 P0701");
}
