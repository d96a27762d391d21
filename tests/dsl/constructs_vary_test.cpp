// What varies without a new mesh. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compiler/geometry/frame.h"
#include "runtime/plan/shakes.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

TEST_CASE(
    "object_st: with `scale` box and regions follow, mass by volume; a copy's scale replaces") {
  const Built built(
      "object large like red { scale 2; region inside box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1cm) }\n"
      "object back like large { scale 1 }\n"
      "variant grown of red_on_tray { source large }\n");
  const plan::Plan& plan = built.plan();
  const plan::ObjectRecord& red = plan.objects()[built.task("red_on_tray").source];
  const plan::ObjectRecord& large = plan.objects()[built.task("grown").source];
  CHECK(analyze_with_suite("object thin like red { scale 0.01 }\n")->codes() == "P0304");
  CHECK(red.scale == 0);
  CHECK(large.scale == 2);
  CHECK(large.box_max[0] == 2 * red.box_max[0]);
  CHECK(large.density == red.density);
  CHECK(built.task("grown").axes == bit(plan::Axis::kObjectSource));
  const auto a = clean("object large like red { scale 2 }\nobject back like large { scale 1 }\n");
  CHECK(named(a->model.objects, "back").box_max == named(a->model.objects, "red").box_max);
  CHECK(analyze_with_suite("object o like red { scale 0; name \"o\" }\n")->codes() == "P0304");
  CHECK(analyze_with_suite("object o like red { scale 101; name \"o\" }\n")->codes() == "P0304");
  CHECK(analyze_with_suite("object o like red { scale 2cm; name \"o\" }\n")->codes() == "P0302");
}

TEST_CASE(
    "object_st: `mass` takes the place of `density`, alone or with its centre and its moments, and "
    "follows `scale`") {
  const Built built(
      "object heavy like red { mass 0.2kg }\n"
      "object top_heavy like red { mass 0.2kg com (0cm, 0cm, 1cm) inertia (2e-4kgm2, 2e-4kgm2, "
      "1e-4kgm2, 0kgm2, 1e-5kgm2, 0kgm2) }\n"
      "object large like top_heavy { scale 2 }\n"
      "object light like large { density 300kg/m3 }\n"
      "variant heavier of red_on_tray { source heavy }\n"
      "variant higher of red_on_tray { source top_heavy }\n"
      "variant larger of red_on_tray { source large }\n"
      "variant lighter of red_on_tray { source light }\n");
  const plan::Plan& plan = built.plan();
  const auto object = [&](const char* task) { return plan.objects()[built.task(task).source]; };
  CHECK(plan.mass(object("red_on_tray")) == nullptr);
  const plan::MassRecord* mass = plan.mass(object("heavier"));
  REQUIRE(mass != nullptr);
  CHECK(object("heavier").density == 0);
  CHECK(mass->mass == 0.2);
  CHECK(mass->inertia == std::array<double, 6>{});
  mass = plan.mass(object("higher"));
  REQUIRE(mass != nullptr);
  CHECK(mass->centre == std::array<double, 3>{0, 0, 0.01});
  CHECK(mass->inertia == std::array<double, 6>{2e-4, 2e-4, 1e-4, 0, 1e-5, 0});
  mass = plan.mass(object("larger"));
  REQUIRE(mass != nullptr);
  CHECK(mass->mass == doctest::Approx(8 * 0.2));
  CHECK(mass->centre[2] == 0.02);
  CHECK(mass->inertia[0] == doctest::Approx(32 * 2e-4));
  CHECK(plan.mass(object("lighter")) == nullptr);
  CHECK(object("lighter").density == 300);
  CHECK(built.task("heavier").axes == bit(plan::Axis::kObjectSource));
  const auto codes = [](const char* said) {
    return analyze_with_suite("object o like red { " + std::string(said) + "; name \"o\" }\n")
        ->codes();
  };
  CHECK(codes("mass 0.2kg; density 500kg/m3") == "P0203");
  CHECK(codes("mass 0kg") == "P0304");
  CHECK(codes("mass 20kg/m3") == "P0302");
  CHECK(codes("mass 2000kg") == "P0303");
  CHECK(codes("mass 0.2kg com (0cm, 0cm, 1cm)") == "P0101");
  CHECK(codes("mass 0.2kg com (0cm, 0cm, 1cm) inertia (1kgm2, 1kgm2, 3kgm2)") == "P0304");
  CHECK(codes("mass 0.2kg com (0cm, 0cm, 1cm) inertia (1kgm2, 1kgm2, 0kgm2)") == "P0304");
  CHECK(codes("mass 0.2kg com (0cm, 0cm, 1cm) inertia (1kgm2, 1kgm2, 1kgm2, 0kgm2)") == "P0304");
}

TEST_CASE("object_st: `damping` of moving and of turning, either alone, gone again in a copy") {
  const Built built(
      "object slow like red { damping 0.1Ns/m 0.002Nms/rad }\n"
      "object turning like red { damping 0.002Nms/rad }\n"
      "object moving like slow { damping 0.2Ns/m; scale 2 }\n"
      "object free like slow { damping 0Ns/m; friction 0.3 }\n"
      "variant slower of red_on_tray { source slow }\n"
      "variant turned of red_on_tray { source turning }\n"
      "variant moved of red_on_tray { source moving }\n"
      "variant freed of red_on_tray { source free }\n");
  const plan::Plan& plan = built.plan();
  const auto damping = [&](const char* task) {
    return plan.damping(plan.objects()[built.task(task).source]);
  };
  CHECK(damping("red_on_tray") == nullptr);
  REQUIRE(damping("slower") != nullptr);
  CHECK(damping("slower")->shift == 0.1);
  CHECK(damping("slower")->turn == 0.002);
  REQUIRE(damping("turned") != nullptr);
  CHECK(damping("turned")->shift == 0);
  CHECK(damping("turned")->turn == 0.002);
  REQUIRE(damping("moved") != nullptr);
  CHECK(damping("moved")->shift == 0.2);
  CHECK(damping("moved")->turn == 0);
  CHECK(damping("freed") == nullptr);
  CHECK(built.task("slower").axes == bit(plan::Axis::kObjectSource));
  const auto codes = [](const char* said) {
    return analyze_with_suite("object o like red { " + std::string(said) + "; name \"o\" }\n")
        ->codes();
  };
  CHECK(codes("damping 0.1Ns/m 0.1Nms/rad") == "");
  CHECK(codes("damping -0.1Ns/m") == "P0304");
  CHECK(codes("damping 0.1Ns/m -0.1Nms/rad") == "P0304");
  CHECK(codes("damping 1e9Ns/m") == "P0304");
  CHECK(codes("damping 0.1Nms/rad 0.1Ns/m") == "P0302 P0302");
  CHECK(codes("damping 0.1N") == "P0302");
  CHECK(codes("damping") == "P0101");
}

TEST_CASE("object_st: paint by name or by number, and the colour that is said agrees") {
  const auto a = clean(
      "object o like red { paint (0, 0.2, 1); color blue; name \"o\" }\n"
      "object p like red { paint red; name \"p\" }\nobject plain like p { texture \"wood\" 4cm "
      "}\n");
  const sema::Object& o = named(a->model.objects, "o");
  REQUIRE(o.paint);
  CHECK(o.paint->rgb == std::array<std::uint8_t, 3>{0, 51, 255});
  const sema::Object& plain = named(a->model.objects, "plain");
  CHECK(!plain.paint);
  REQUIRE(plain.texture);
  CHECK(plain.texture->side == 0.04);
  const auto lies = analyze_with_suite("object o like red { paint blue; name \"o\" }\n");
  CHECK(lies->codes() == "P1510");
  CHECK(lies->underlined() == "blue");
  CHECK(analyze_with_suite("object o like red { paint blu; name \"o\" }\n")->codes() == "P0201");
  CHECK(analyze_with_suite("object o like red { paint (2, 0, 0); name \"o\" }\n")->codes() ==
        "P0304");
  CHECK(analyze_with_suite("object o like red { paint red; texture \"wood\"; name \"o\" }\n")
            ->codes() == "P0203");
}

TEST_CASE("object_st: what is covered with a texture has no colour unless one is said with it") {
  const auto a = clean(
      "object p like red { texture \"wood\"; name \"p\" }\n"
      "object q like red { texture \"wood\"; color blue; name \"q\" }\n"
      "object r like q { scale 1.1; name \"r\" }\n");
  const auto color = [&](const char* name) {
    const auto& attributes = a->model.attributes;
    std::size_t at = 0;
    while (attributes[static_cast<sema::AttributeId>(at)].name != "color") ++at;
    return named(a->model.objects, name).values[at];
  };
  CHECK(color("red").size() == 1);
  CHECK(color("p").empty());
  CHECK(color("q").size() == 1);
  CHECK(color("r") == color("q"));
}

TEST_CASE("light_st: a colour of its light, white is what says nothing") {
  const Built built(
      "light warm { ambient 0.3; color (1, 0.8, 0.6) }\nlight white { ambient 0.3; color (1, 1, 1) "
      "}\n"
      "light bare { ambient 0.3 }\n"
      "variants of red_on_tray { a { light warm }; b { light white } }\n"
      "variant c of b { light warm }\n");
  const plan::Plan& plan = built.plan();
  CHECK(plan.lights()[built.task("a").light].color == std::array<double, 3>{1, 0.8, 0.6});
  CHECK(plan.lights()[built.task("b").light].color == std::array<double, 3>{});
  CHECK(built.task("c").axes == bit(plan::Axis::kLight));
  CHECK(analyze_with_suite("light l { ambient 1; color (0, 0, 0) }\n")->codes().find("P0304") !=
        std::string::npos);
  CHECK(analyze_with_suite("light l { ambient 1; color (1, 0, -1) }\n")->codes().find("P0304") !=
        std::string::npos);
}

TEST_CASE("camera_st, sensor: in any order, each once; the lens is the same") {
  const Built built(
      "camera c like eye { sensor dropped 0.1 mirrored noise 0.02 exposure 0.5 blur 1.5px patch "
      "(0.1, 0.2) .. "
      "(0.3, 0.4) }\n"
      "variant v of red_on_tray { camera c }\n");
  CHECK(built.task("v").axes == bit(plan::Axis::kSensor));
  const plan::SensorRecord* sensor =
      built.plan().sensor(built.plan().cameras()[built.task("v").camera]);
  REQUIRE(sensor != nullptr);
  CHECK(sensor->noise == 0.02);
  CHECK(sensor->blur == 1.5);
  CHECK(sensor->exposure == 0.5);
  CHECK(sensor->patch == std::array<double, 4>{0.1, 0.2, 0.3, 0.4});
  CHECK(sensor->dropped == 0.1);
  CHECK(sensor->mirrored == 1);
  for (const char* bad : {"noise 2", "dropped 1.5", "patch (0.5, 0) .. (0.2, 1)",
                          "patch (0, 0) .. (2, 1)", "exposure 0", "blur 65px"})
    CHECK(analyze_with_suite(std::string("camera c like eye { sensor ") + bad + " }\n")
              ->codes()
              .find("P0304") != std::string::npos);
  for (const char* bad : {"", "noise 0.1 noise 0.2", "mirrored mirrored", "haze 0.1"})
    CHECK(analyze_with_suite(std::string("camera c like eye { sensor ") + bad + " }\n")
              ->codes()
              .find("P0101") != std::string::npos);
}

TEST_CASE(
    "camera_st: with `jitter` each start has its camera elsewhere, the same way for all that "
    "jitter") {
  const Built built(
      "camera loose like eye { jitter 1cm 2deg }\ncamera looser like eye { jitter 2cm 0deg }\n"
      "variants of red_on_tray { v { camera loose }; w { camera looser } }\n"
      "variant x of v { horizon 63 steps }\n");
  const plan::Plan& plan = built.plan();
  CHECK(built.task("v").axes == bit(plan::Axis::kCamera));
  const auto shake = [&](const char* task, std::size_t start) {
    return plan::shake_of(plan::shakes_of(plan.tables(), plan.episodes(built.task(task))[start]),
                          0);
  };
  CHECK(shake("red_on_tray", 0) == plan::Shake{});
  for (const std::size_t start : {0u, 1u, 2u}) {
    const plan::Shake loose = shake("v", start), looser = shake("w", start);
    CHECK(loose != plan::Shake{});
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(loose.moved[i]) <= 0.01);
      CHECK(looser.moved[i] == doctest::Approx(2 * loose.moved[i]));
      // About each axis by up to 2 degrees.
      CHECK(std::abs(loose.turned[1 + i]) < std::sin(1.001 * 3.14159265 / 180));
    }
    CHECK(looser.turned == plan::Shake{}.turned);
    CHECK(shake("x", start).moved == loose.moved);
    CHECK(shake("x", start).turned == loose.turned);
  }
  CHECK(shake("v", 0).moved != shake("v", 1).moved);
  const auto start_id = [&](const char* task) {
    return plan.episodes(built.task(task))[0].start_id;
  };
  CHECK(start_id("v") != start_id("red_on_tray"));
  CHECK(start_id("v") == start_id("x"));
  for (const char* bad : {"-1cm 2deg", "1cm -2deg", "1cm 91deg"})
    CHECK(analyze_with_suite(std::string("camera c like eye { jitter ") + bad + " }\n")
              ->codes()
              .find("P0304") != std::string::npos);
  CHECK(analyze_with_suite("camera c like eye { jitter 1cm 2cm }\n")->codes() == "P0302");
  CHECK(analyze_with_suite("camera c like eye { jitter 1cm }\n")->codes() == "P0101");
}

TEST_CASE(
    "camera_st: with `jitter` what is left in one start need not be so in the next; photos stay") {
  const std::string loose = "camera loose like eye { jitter 1cm 2deg }\n";
  const auto a = clean(loose + "variant v of red_on_tray { camera loose }\n");
  const sema::Scene& bench = named(a->model.scenes, "bench");
  CHECK(sema::frame_of(a->model, bench, named(a->model.cameras, "eye")).sight.has_value());
  CHECK_FALSE(sema::frame_of(a->model, bench, named(a->model.cameras, "loose")).sight.has_value());
  const auto photo =
      analyze_with_suite(loose +
                         "scene pictured like bench { camera loose overlay \"wall.png\" }\n"
                         "variant v of red_on_tray { scene pictured }\n");
  CHECK(photo->codes().find("P0304") != std::string::npos);
  CHECK_MESSAGE(photo->said().find("`loose` jitters, and the photo `wall.png` behind its picture "
                                   "in `v` is from one place") != std::string::npos,
                photo->said());
}

TEST_CASE("camera_st: `sensor none` takes a copied one away") {
  const Built built(
      "camera c like eye { sensor noise 0.02 }\ncamera d like c { sensor none }\n"
      "variants of red_on_tray { v { camera c } }\nvariant w of v { camera d }\n");
  CHECK(built.task("w").axes == bit(plan::Axis::kSensor));
  CHECK(built.plan().sensor(built.plan().cameras()[built.task("w").camera]) == nullptr);
  CHECK(analyze_with_suite("camera c like eye { sensor none; sensor noise 0.1 }\n")
            ->codes()
            .find("P0203") != std::string::npos);
  CHECK(
      analyze_with_suite("camera c like eye { sensor none noise 0.1 }\n")->codes().find("P0101") !=
      std::string::npos);
}

TEST_CASE(
    "layout_st: with `joints jitter` turning joints begin elsewhere, as the start's number says") {
  const Built built(
      "layout shaken like pairs { joints jitter 2deg }\nvariant v of red_on_tray { layout shaken "
      "}\n"
      "variant w of v { source blue }\n");
  const plan::Plan& plan = built.plan();
  CHECK(built.task("v").axes == bit(plan::Axis::kRobot));
  const plan::SceneRecord& scene = plan.scenes()[built.task("v").scene];
  const auto first = plan.episodes(built.task("v"));
  const auto other = plan.episodes(built.task("w"));
  const auto from = plan.joints(scene);
  double most = 0;
  for (std::size_t e = 0; e < first.size(); ++e) {
    const auto arm = plan.joints(scene, first[e]);
    REQUIRE(arm.size() == from.size());
    CHECK(std::equal(arm.begin(), arm.end(), plan.joints(scene, other[e]).begin()));
    for (std::size_t i = 0; i < arm.size(); ++i) most = std::max(most, std::abs(arm[i] - from[i]));
  }
  CHECK(most > 0.005);
  CHECK(most <= 0.0349066);
  CHECK(first[0].start_id != plan.episodes(built.task("red_on_tray"))[0].start_id);
}

TEST_CASE(
    "task_st: what moves by itself, along corners or round a place; the way of one object is said "
    "anew") {
  const Built built(
      "variants of red_on_tray {\n"
      "  v { moves source along (1cm, 0cm), (1cm, 5mm) at 2cm/s loop }\n"
      "  w { moves red around (5mm, 0cm) at 0.02m/s }\n"
      "  u { moves source along (1cm, 0cm) at 2cm/s once }\n"
      "}\n"
      "variant x of v { moves source along (-1cm, 0cm) at 1cm/s }\n"
      "variant y of v { moves source none }\n");
  const auto legs = [&](const char* task) {
    return plan::slice_of(built.plan().tables().moves, built.task(task).moves);
  };
  REQUIRE(legs("v").size() == 2);
  CHECK(legs("v")[1].to == std::array<double, 2>{0.01, 0.005});
  CHECK(legs("v")[0].body == 0);
  CHECK(legs("v")[0].way == static_cast<std::uint32_t>(plan::Way::kLoop));
  CHECK(legs("v")[0].speed == 0.02);
  CHECK(legs("w")[0].way == static_cast<std::uint32_t>(plan::Way::kRound));
  CHECK(legs("u")[0].way == static_cast<std::uint32_t>(plan::Way::kOnce));
  CHECK(legs("x").size() == 1);
  CHECK(legs("y").empty());
  CHECK(built.task("v").axes == bit(plan::Axis::kMotion));
  CHECK(built.task("x").axes == bit(plan::Axis::kMotion));
  CHECK(built.task("v").judge_id == built.task("red_on_tray").judge_id);
  const auto start = [&](const char* task) {
    return built.plan().episodes(built.task(task))[0].start_id;
  };
  CHECK(start("v") != start("red_on_tray"));
  CHECK(start("v") != start("x"));
  CHECK(start("y") == start("red_on_tray"));
}

TEST_CASE("task_st: a delay in steps or in a time that is a whole number of them") {
  const Built built(
      "variants of red_on_tray { v { delay 2 steps }; w { delay 400ms } }\n"
      "variant u of v { say take }\n");
  CHECK(built.task("v").delay == 2);
  CHECK(built.task("v").axes == bit(plan::Axis::kLatency));
  CHECK(built.task("w").delay == 2);
  CHECK(built.task("u").delay == 2);
  CHECK(built.task("v").judge_id == built.task("red_on_tray").judge_id);
  CHECK(analyze_with_suite("variant v of red_on_tray { delay 450ms }\n")->codes() == "P0304");
  CHECK(analyze_with_suite("variant v of red_on_tray { delay 1001 steps }\n")->codes() == "P0304");
  CHECK(analyze_with_suite("variant v of red_on_tray { delay 2cm }\n")->codes() == "P0302");
  // No action would ever act.
  CHECK(analyze_with_suite("variant v of red_on_tray { delay 12 steps; horizon 12 steps }\n")
            ->codes() == "P0304");
}

TEST_CASE(
    "scene_st: textures of surface, walls and floor; a height of the surface is another axis") {
  const auto a = clean(
      "scene covered like bench { texture surface \"wood\" 40cm; texture walls \"bricks\" }\n"
      "variant v of red_on_tray { scene covered }\n");
  const sema::Scene& covered = named(a->model.scenes, "covered");
  REQUIRE(covered.covers.size() == 2);
  CHECK(covered.covers.at(plan::CoverOf::kSurface).side == 0.4);
  CHECK(named(a->model.tasks, "v").axes == bit(plan::Axis::kSceneTexture));
  CHECK(analyze_with_suite("scene c like bench { texture roof \"wood\" }\n")->codes() == "P0201");
  CHECK(analyze_with_suite("scene c like bench { texture walls \"a\"; texture walls \"b\" }\n")
            ->codes() == "P0203");
}

TEST_CASE("binder: lights, cameras and scenes by name; what the task has already is left out") {
  const auto a = clean(
      "light dusk { ambient 0.1 }\nlight noon { ambient 0.9 }\n"
      "derive \"{t}_{l}\" for t in { red_on_tray }, l in lights (day, dusk, noon) { light l }\n"
      "camera near like eye { mount arm.base at (0cm, 0cm, 40cm) look (1, 0, -1) }\n"
      "derive \"{t}_{c}\" for t in { red_on_tray }, c in cameras (near) { camera c }\n"
      "suite s { tasks variants of { red_on_tray }; seeds 1 }\n");
  CHECK(named(a->model.suites, "s").members.size() == 3);
  CHECK(named(a->model.tasks, "red_on_tray_dusk").axes == bit(plan::Axis::kLight));
  CHECK(named(a->model.tasks, "red_on_tray_near").axes == bit(plan::Axis::kCamera));
  CHECK(analyze_with_suite(
            "derive \"{t}_{l}\" for t in { red_on_tray }, l in lights (dai) { light l }\n")
            ->codes() == "P0201");
}

TEST_CASE("binder: numbers, in a range or a list, where a task takes some") {
  const auto a = clean(
      "derive \"{t}_{k}\" for t in { red_on_tray }, k in 1 .. 3 { idle k steps }\n"
      "derive \"{t}_by_{d}\" for t in { red_on_tray }, d in 200ms, 0.4s { delay d }\n"
      "suite s { tasks variants of { red_on_tray }; seeds 1 }\n");
  CHECK(named(a->model.suites, "s").members.size() == 5);
  CHECK(named(a->model.tasks, "red_on_tray_3").idle == 3);
  CHECK(named(a->model.tasks, "red_on_tray_by_200ms").delay == 1);
  CHECK(named(a->model.tasks, "red_on_tray_by_0_4s").delay == 2);
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  CHECK(codes("derive \"{t}_{k}\" for t in { red_on_tray }, k in 3 .. 1 { idle k steps }\n") ==
        "P0304");
  CHECK(codes("derive \"{t}_{k}\" for t in { red_on_tray }, k in 1cm .. 3cm { idle k steps }\n") ==
        "P0304");
  CHECK(codes("variant v of red_on_tray { idle k steps }\n") == "P0201");
  CHECK(codes("derive \"{t}_{k}\" for t in { red_on_tray }, k in 0.5, 1 { idle k steps }\n")
            .find("P0302") == 0);
}

TEST_CASE("task_st, count: drawn distractors grow by the number and have no role") {
  const auto a = clean(
      "object third like red { color blue; paint blue; name \"third block\" }\nobject fourth like "
      "red { color "
      "blue; paint blue; name \"fourth "
      "block\" }\n"
      "variants of red_on_tray { one { distractors 1 of (red, blue, third, fourth) seed 3 }\n"
      "  two { distractors 2 of (fourth, third, blue, red) seed 3 } }\n"
      "suite s { tasks tasks; seeds 1 }\n");
  const sema::Task& one = named(a->model.tasks, "one");
  const sema::Task& two = named(a->model.tasks, "two");
  REQUIRE(one.distractors.size() == 1);
  REQUIRE(two.distractors.size() == 2);
  CHECK(one.distractors[0] == two.distractors[0]);
  CHECK(one.axes == bit(plan::Axis::kDistractors));
  CHECK(one.role_of(one.distractors[0]) == sema::RoleId::kNone);
  CHECK(analyze_with_suite("variant v of red_on_tray { distractors 2 of (red, blue) seed 1 }\n")
            ->codes() == "P0304");
}

TEST_CASE("task_st, count: variants of variants draw what all variants of their task draw") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const std::string drawn =
        "{ distractors 1 of (blue, third, fourth) seed " + std::to_string(seed) + " }\n";
    const auto a = clean(
        "object third like red { color blue; paint blue; name \"third block\" }\nobject fourth "
        "like red { "
        "color blue; paint blue; name \"fourth "
        "block\" }\n"
        "variant late of red_on_tray { delay 2 steps }\n"
        "variant one of red_on_tray " +
        drawn + "variant two of late " + drawn + "suite s { tasks tasks; seeds 1 }\n");
    CAPTURE(seed);
    REQUIRE(named(a->model.tasks, "one").distractors.size() == 1);
    CHECK(named(a->model.tasks, "one").distractors == named(a->model.tasks, "two").distractors);
  }
}

TEST_CASE("t1: of a sample with baselines what is drawn comes with what it is compared with") {
  const auto a = clean(
      "variants of red_on_tray { a { idle 1 steps }; b { idle 2 steps }; c { idle 3 steps } }\n"
      "variant d of a { idle 4 steps }\n"
      "set drawn = sample 2 of ({ a, b, c, d } - { a }) seed 5 with baselines\n"
      "suite s { tasks drawn; seeds 1 }\n");
  const sema::Suite& suite = named(a->model.suites, "s");
  CHECK(suite.cuts.empty());
  for (std::size_t i = 0; i < suite.members.size(); ++i) {
    const sema::TaskId baseline = a->model.tasks[suite.members[i]].baseline;
    if (baseline == sema::TaskId::kNone) continue;
    const auto at = std::find(suite.members.begin(), suite.members.end(), baseline);
    CHECK(at - suite.members.begin() < static_cast<std::ptrdiff_t>(i));
  }
  CHECK(suite.members.size() >= 3);
}

TEST_CASE(
    "task_st, stand: `scene` with a block is the copied scene, or the named one, with other "
    "statements, and either half of `robot` is changed alone") {
  const Built built(
      "robot soft like arm { grip 1cm .. 4cm friction 1 patch 1cm }\n"
      "scene there like bench { robot at (45cm, 0cm) yaw 180deg }\n"
      "variants of red_on_tray {\n  softly { scene { robot soft } }\n"
      "  softly_there { scene there { robot soft; physics 1000Hz friction 1 } }\n}\n"
      "derive \"{t}_by_{r}\" for t in { red_on_tray }, r in robots (soft) {\n"
      "  scene { robot r; light night }\n}\n");
  const plan::Plan& plan = built.plan();
  const auto scene = [&](const char* task) { return plan.scenes()[built.task(task).scene]; };
  const auto robot = [&](const char* task) { return plan.text(plan.robots()[scene(task).robot].name); };
  CHECK(robot("red_on_tray") == "arm");
  CHECK(robot("softly") == "soft");
  CHECK(scene("softly").base_position == scene("red_on_tray").base_position);
  CHECK(scene("softly_there").base_position[0] == 0.45);
  CHECK(scene("softly_there").physics_hz == 1000);
  CHECK(plan.text(scene("softly_there").name) == "there");
  CHECK(robot("red_on_tray_by_soft") == "soft");
  CHECK(built.task("softly").axes == bit(plan::Axis::kScene));
}
