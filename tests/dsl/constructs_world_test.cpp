// Catalogue and stage. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include "compiler/define/query.h"
#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

// The truth of each phrase of `o` for the object itself: "yes", "no" or "unknown".
std::string truths(const Analysis& a, std::string_view object) {
  std::string text;
  const sema::Object& o = named(a.model.objects, object);
  for (const sema::Phrase& phrase : o.phrases) {
    const sema::Truth truth = sema::evaluate(phrase.means, o);
    text += (text.empty() ? "" : " ") + phrase.name + "=" +
            (truth == sema::Truth::kYes  ? "yes"
             : truth == sema::Truth::kNo ? "no"
                                         : "unknown");
  }
  return text;
}

}  // namespace

TEST_CASE("dataset, seen_on: what was seen together, in order and by name") {
  const auto a = clean(
      "dataset d \"The \\\"D\\\" set\" { relations red on tray, tray under blue }\n"
      "dataset bare \"Bare\"\n");
  const sema::Dataset& d = named(a->model.datasets, "d");
  CHECK(d.title == "The \"D\" set");
  REQUIRE(d.relations.size() == 2);
  CHECK(a->model.objects[d.relations[1].subject].name == "tray");
  CHECK(named(a->model.datasets, "bare").relations.empty());
}

TEST_CASE("attribute, facts: closed lists; a value of another list is an error with its place") {
  const auto a = clean(
      "attribute finish { shiny, matte }\nfacts { hollow, sharp }\n"
      "object o like red { finish shiny, matte; is hollow; name \"o\" }\n");
  CHECK(a->model.facts.back() == "sharp");
  const auto wrong = analyze_with_suite("object o like red { color shiny; name \"o\" }\n");
  CHECK(wrong->codes() == "P0204");
  CHECK(wrong->underlined() == "shiny");
}

TEST_CASE("object: `like` copies every statement and a statement replaces what was copied") {
  const auto a = clean(
      "object o like red { density 200kg/m3; name \"other\"; phrase toy "
      "appearance \"thing\" means favorite }\n");
  const sema::Object& red = named(a->model.objects, "red");
  const sema::Object& o = named(a->model.objects, "o");
  CHECK(o.mesh.text == red.mesh.text);
  CHECK(o.box_max == red.box_max);
  CHECK(o.rest == red.rest);
  CHECK(o.values == red.values);
  CHECK(o.density == 200);
  CHECK(o.text.text == "other");
  CHECK(o.phrases.size() == 3);
  CHECK(o.find_phrase("toy")->text.text == "thing");
  CHECK(
      analyze_with_suite("object a like b {}\nobject b like a {}\n")->codes().starts_with("P0207"));
}

TEST_CASE("extend: an object of another file is known more of, and so are its copies") {
  const auto a = clean(
      "attribute material { wood, steel }\nfacts { heavy }\nobject o like red { name \"other\" }\n"
      "extend object red { material wood; is heavy; phrase m appearance \"wooden block\" means material "
      "wood }\n");
  for (const char* name : {"red", "o"}) {
    const sema::Object& object = named(a->model.objects, name);
    CHECK(object.values.back() == std::vector<std::uint32_t>{0});
    CHECK(object.facts.back() == sema::Truth::kYes);
    REQUIRE(object.find_phrase("m") != nullptr);
    CHECK(object.find_phrase("m")->text.text == "wooden block");
  }
  const auto wrong = analyze_with_suite("extend object red { color blue }");
  CHECK(wrong->codes() == "P0203");
  CHECK(wrong->underlined() == "color blue");
}

TEST_CASE("object_st: every statement of an object has its value") {
  const auto a = clean(
      "dataset other \"Other\"\nfacts { wet, loud }\n"
      "object o { mesh \"block\"; box (-1cm, -2cm, 0cm) .. (3cm, 2cm, 5cm); density 500kg/m3\n"
      "  friction 0.25; color red, blue; category toy; is favorite, wet; maybe loud\n"
      "  seen in lab, other; rest roll 90deg yaw 180deg; name \"odd thing\" bare }\n"
      "object p like o { unseen; name \"p\" }\n");
  const sema::Object& o = named(a->model.objects, "o");
  CHECK(o.mesh.text == "block");
  CHECK(o.box_min == std::array<double, 3>{-0.01, -0.02, 0});
  CHECK(o.box_max == std::array<double, 3>{0.03, 0.02, 0.05});
  CHECK(o.friction == 0.25);
  CHECK(o.values[0] == std::vector<std::uint32_t>{0, 1});
  CHECK(o.facts[0] == sema::Truth::kYes);
  CHECK(o.facts[2] == sema::Truth::kUnknown);
  CHECK(o.seen_in.size() == 2);
  CHECK(o.bare);
  CHECK(named(a->model.objects, "p").unseen);
  CHECK(named(a->model.objects, "p").seen_in.empty());
  // A size is centred on the origin.
  CHECK(named(a->model.objects, "red").box_min == std::array<double, 3>{-0.02, -0.01, -0.01});
  CHECK(analyze_with_suite("object o { mesh \"block\" }")->codes() == "P0206 P0206 P0206 P0206");
}

TEST_CASE("axis: a phrase probes appearance or commonsense, and says so of the variant") {
  const auto a = clean(
      "variants of red_on_tray { a { refer source as by_color }\n"
      "b { refer source as loved } }\n");
  CHECK(axes_text(*a, "a") == "language.appearance");
  CHECK(axes_text(*a, "b") == "language.commonsense");
  CHECK(analyze_with_suite("object o like red { name \"o\"; phrase p taste \"x\" means favorite }")
            ->codes() == "P0201");
}

TEST_CASE("pose, angle: roll, pitch and yaw turn about the world's x, y and z, in this order") {
  const auto a = clean("object o like red { rest roll 90deg yaw 90deg, pitch 180deg; name \"o\" }");
  const auto& rest = named(a->model.objects, "o").rest;
  REQUIRE(rest.size() == 2);
  // First about x, then about the fixed z: (w, x, y, z) = yaw * roll.
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(rest[0].rotation[i] == doctest::Approx(0.5).epsilon(1e-15));
  CHECK(rest[1].rotation == std::array<double, 4>{0, 0, 1, 0});
}

TEST_CASE("query, q_and, q_not: three values, `not` before `and` before `or`") {
  const auto a = clean(
      "facts { f, g, h }\nattribute size { small, large }\n"
      "object o like red { name \"o\"; is f; maybe g\n"
      "  phrase toy appearance \"1\" means f\n"
      "  phrase loved commonsense \"2\" means h\n"
      "  phrase by_color appearance \"3\" means g\n"
      "  phrase p4 appearance \"4\" means not g or f\n"
      "  phrase p5 appearance \"5\" means h and g\n"
      "  phrase p6 appearance \"6\" means f or h and h\n"
      "  phrase p7 appearance \"7\" means (f or h) and h\n"
      "  phrase p8 appearance \"8\" means not h and color red\n"
      "  phrase p9 appearance \"9\" means size small\n"
      "  phrase p10 appearance \"10\" means not size small or color blue }\n");
  CHECK(truths(*a, "o") ==
        "by_color=unknown loved=no toy=yes p4=yes p5=no p6=yes p7=no p8=yes p9=unknown "
        "p10=unknown");
}

TEST_CASE("robot, robot_st, finger: what the plan holds of an arm") {
  const Built built(R"(
robot second {
  urdf "arm/arm.urdf"; tcp tool; fingers left opens +y, right opens -x; control ee_delta_pose 10Hz
  reach 10cm .. 90cm
  drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm
  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N
  grip 1cm .. 4cm friction 2 patch 5mm
}
camera second_eye { mount second.base at (0cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 30px, 30px, 32px, 24px }
scene other like bench { robot second at (50cm, 0cm) yaw 180deg; camera second_eye }
variant v of red_on_tray { scene other }
)");
  const plan::Plan& plan = built.plan();
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[built.task("v").scene].robot];
  CHECK(plan.text(robot.name) == "second");
  CHECK(plan.text(robot.tcp) == "tool");
  CHECK(robot.control_hz == 10);
  CHECK(robot.reach_min == 0.1);
  CHECK(robot.reach_max == 0.9);
  CHECK(robot.fingers[0].opens == std::array<double, 3>{0, 1, 0});
  CHECK(robot.fingers[1].opens == std::array<double, 3>{-1, 0, 0});
  CHECK(robot.grip_closed == 0.01);
  CHECK(robot.grip_open == 0.04);
  CHECK(robot.finger_friction == 2);
  CHECK(robot.finger_patch == 0.005);
  REQUIRE(robot.drives.count == 3);
  CHECK(plan.text(plan.drives(robot)[2].joint) == "r");
  CHECK(plan.drives(robot)[2].damping == 200);
  CHECK(plan.drives(robot)[0].limit == 20);
}

TEST_CASE("robot: `like` copies every statement, and a drive replaces that of its joints alone") {
  const Built built(R"(
robot second like arm { control ee_delta_pose 10Hz; drive r stiffness 900N/m damping 200Ns/m limit 60N }
camera second_eye { mount second.base at (0cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 30px, 30px, 32px, 24px }
scene other like bench { robot second at (50cm, 0cm) yaw 180deg; camera second_eye }
variant v of red_on_tray { scene other }
)");
  const plan::Plan& plan = built.plan();
  const plan::RobotRecord& copy = plan.robots()[plan.scenes()[built.task("v").scene].robot];
  const plan::RobotRecord& arm = plan.robots()[plan.scenes()[built.task("red_on_tray").scene].robot];
  CHECK(plan.text(copy.name) == "second");
  CHECK(copy.control_hz == 10);
  CHECK(copy.grip_open == arm.grip_open);
  REQUIRE(copy.drives.count == arm.drives.count);
  for (std::size_t i = 0; i < arm.drives.count; ++i) {
    const auto &of_copy = plan.drives(copy)[i], &of_arm = plan.drives(arm)[i];
    CHECK(plan.text(of_copy.joint) == plan.text(of_arm.joint));
    CHECK((of_copy.stiffness == of_arm.stiffness) == (plan.text(of_arm.joint) != "r"));
  }
}

TEST_CASE("control_st: what the plan holds of a control law, of gears and of air") {
  const Built built(R"(
robot second {
  urdf "arm/arm.urdf"; tcp tool; fingers left opens +y, right opens -y
  control osc_pose 20Hz {
    kp (150, 100); damping 0.9; output (2cm, 0.1rad); null 8; uncouple; ramp 0.2
    home (0.5rad)
  }
  drive waist damping 2Nms/rad limit 20Nm friction 0.1Nm armature 5kgm2
  drive l, r limit 60N
  grip 0cm .. 4cm pace 0.02 stiffness 900N/m limit 15N
}
camera second_eye { mount second.base at (0cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 30px, 30px, 32px, 24px }
scene other like bench {
  robot second at (50cm, 0cm) yaw 180deg; camera second_eye
  physics 500Hz friction 1 air 1.2kg/m3 viscosity 2e-5Pas
}
variant v of red_on_tray { scene other }
)");
  const plan::Plan& plan = built.plan();
  const plan::SceneRecord& scene = plan.scenes()[built.task("v").scene];
  const plan::RobotRecord& robot = plan.robots()[scene.robot];
  CHECK(robot.control == static_cast<std::uint32_t>(plan::Control::kOscPose));
  const plan::LawRecord* law = plan.law(robot);
  REQUIRE(law != nullptr);
  CHECK(law->kp == std::array<double, 6>{150, 150, 150, 100, 100, 100});
  CHECK(law->damping[5] == 0.9);
  CHECK(law->output == std::array<double, 6>{0.02, 0.02, 0.02, 0.1, 0.1, 0.1});
  CHECK(law->null_kp == 8);
  CHECK(law->ramp == 0.2);
  CHECK(law->flags == plan::kLawUncoupled);
  CHECK(law->grip_pace == 0.02);
  CHECK(law->grip_stiffness == 900);
  CHECK(law->grip_limit == 15);
  REQUIRE(plan.home(*law).size() == 1);
  CHECK(plan.home(*law)[0] == 0.5);
  CHECK(plan.drives(robot)[0].stiffness == 0);
  CHECK(plan.drives(robot)[0].damping == 2);
  REQUIRE(plan.gears(robot).size() == 3);
  CHECK(plan.gears(robot)[0].friction == 0.1);
  CHECK(plan.gears(robot)[0].armature == 5);
  CHECK(plan.gears(robot)[2].armature == 0);
  CHECK(scene.air_density == 1.2);
  CHECK(scene.air_viscosity == 2e-5);
  // The others are as they were.
  const plan::RobotRecord& first =
      plan.robots()[plan.scenes()[built.task("red_on_tray").scene].robot];
  CHECK(plan.law(first) == nullptr);
  CHECK(plan.gears(first).empty());
  CHECK(built.task("v").judge_id != built.task("red_on_tray").judge_id);
}

TEST_CASE("camera, camera_st: a copy with another image is another camera") {
  const Built built(
      "camera wide like eye { image 128 x 96 samples 4; lens 20px, 21px, 64px, 48px }\n"
      "camera aside like eye { mount arm.wrist at (1cm, 2cm, 3cm) quat (0, 1, 0, 0) }\n"
      "variant v of red_on_tray { camera wide }\n"
      "variant w of red_on_tray { camera aside }\n");
  const plan::Plan& plan = built.plan();
  const plan::CameraRecord& wide = plan.cameras()[built.task("v").camera];
  CHECK(wide.width == 128);
  CHECK(wide.samples == 4);
  CHECK(wide.fy == 21);
  CHECK(wide.position == std::array<double, 3>{0, 0, 1});
  CHECK(wide.aim == static_cast<std::uint32_t>(plan::CameraAim::kLook));
  const plan::CameraRecord& aside = plan.cameras()[built.task("w").camera];
  CHECK(aside.aim == static_cast<std::uint32_t>(plan::CameraAim::kQuat));
  CHECK(aside.aim_values == std::array<double, 4>{0, 1, 0, 0});
  CHECK(plan.text(aside.mount_link) == "wrist");
  CHECK(built.task("v").axes == static_cast<std::uint32_t>(plan::Axis::kCamera));
}

TEST_CASE("view: a scene's cameras have names that stay when a task puts another camera there") {
  write_text(asset_root() + "/scenes/photo.png", "photo");
  const Built built(
      "camera near like eye { lens 20px, 21px, 64px, 48px }\n"
      "camera hand like eye { mount arm.wrist at (1cm, 2cm, 3cm) quat (0, 1, 0, 0) }\n"
      "camera low_hand like hand { mount arm.wrist at (1cm, 2cm, 1cm) quat (0, 1, 0, 0) }\n"
      "scene seen like bench { camera eye, hand as wrist, near overlay \"photo.png\" }\n"
      "scene again like seen {}\n"
      "task t like red_on_tray { scene seen }\n"
      "variant all of red_on_tray { scene seen }\n"
      "variant words of t { say take }\n"
      "variant first of t { camera near }\n"
      "variant by_name of t { camera low_hand as wrist }\n"
      "variant both of by_name { camera near }\n"
      "variant back of both { camera eye as eye }\n"
      "variant named of red_on_tray { camera near as eye }\n");
  const plan::Plan& plan = built.plan();
  const auto text = [&](const char* task) {
    std::string all;
    for (const plan::ViewRecord& view : plan.views(built.task(task))) {
      all += std::string(plan.text(view.name)) + "=" +
             std::string(plan.text(plan.cameras()[view.camera].name)) +
             (view.photo == plan::kNone ? " " : "+photo ");
    }
    return all;
  };
  CHECK(text("t") == "eye=eye wrist=hand near=near+photo ");
  CHECK(text("first") == "eye=near wrist=hand near=near+photo ");
  CHECK(text("by_name") == "eye=eye wrist=low_hand near=near+photo ");
  CHECK(text("both") == "eye=near wrist=low_hand near=near+photo ");
  CHECK(text("back") == text("by_name"));
  CHECK(text("named") == "eye=near ");
  CHECK(text("red_on_tray") == "eye=eye ");
  CHECK(built.task("red_on_tray").views.count == 0);  // a camera alone needs no name
  CHECK(built.task("words").views.first == built.task("t").views.first);
  for (const char* name : {"all", "first", "by_name", "both", "back"}) {
    CAPTURE(name);
    CHECK(built.task(name).axes == static_cast<std::uint32_t>(plan::Axis::kCamera));
  }
  const plan::EpisodeRecord* episodes = plan.episodes().data();
  CHECK(episodes[built.task("words").episodes.first].start_id ==
        episodes[built.task("t").episodes.first].start_id);
  CHECK(episodes[built.task("back").episodes.first].start_id ==
        episodes[built.task("by_name").episodes.first].start_id);
  CHECK(episodes[built.task("first").episodes.first].start_id !=
        episodes[built.task("t").episodes.first].start_id);
  CHECK(analyze_with_suite("scene s like bench { camera eye }\n"
                           "variant v of red_on_tray { scene s }")
            ->codes() == "P0702");
}

TEST_CASE("cameras that are not there, or twice, are told where they are written") {
  const auto codes = [](const std::string& text) {
    return analyze_with_suite("camera near like eye { lens 20px, 21px, 64px, 48px }\n" + text)
        ->codes();
  };
  CHECK(codes("scene s like bench { camera eye, eye }") == "P0203");
  CHECK(codes("scene s like bench { camera eye, near as eye }") == "P0203");
  CHECK(codes("scene s like bench { camera eye, eye as other }") == "");
  CHECK(codes("scene s like bench { camera eye, ear }") == "P0201");
  CHECK(codes("scene s like bench { camera eye; camera near }") == "P0203");
  CHECK(codes("variant v of red_on_tray { camera near as wrist }") == "P0201");
  CHECK(codes("variant v of red_on_tray { camera near; camera eye }").starts_with("P0203"));
  CHECK(codes("variant v of red_on_tray { camera eye as eye; camera near as eye }")
            .starts_with("P0203"));
  CHECK(codes("camera lost like eye { mount arm.elbow at (0cm, 0cm, 1m) look (1, 0, -1) }\n"
              "scene s like bench { camera eye, lost }\nvariant v of red_on_tray { scene s }") ==
        "P0201");
  std::string many = "scene s like bench { camera eye";
  for (int i = 0; i < 16; ++i) many += ", near as n" + std::to_string(i);
  CHECK(codes(many + " }") == "P0304");
}

TEST_CASE("light, light_st: ambient light and any number of suns, with or without shadow") {
  const Built built(
      "light dawn { ambient 0.25 occlusion 8; sun (0, 0, -2) power 2 shadow; sun (1, 0, -1) power "
      "1 }\n"
      "variant v of red_on_tray { light dawn }\n");
  const plan::Plan& plan = built.plan();
  const plan::LightRecord& light = plan.lights()[built.task("v").light];
  CHECK(light.ambient == 0.25);
  CHECK(light.occlusion == 8);
  REQUIRE(light.suns.count == 2);
  CHECK(plan.suns(light)[0].shadow == 1);
  CHECK(plan.suns(light)[0].direction == std::array<double, 3>{0, 0, -2});
  CHECK(plan.suns(light)[1].power == 1);
  CHECK(plan.suns(light)[1].shadow == 0);
}

TEST_CASE("light_st, lamp: spots, suns and a headlight light corners of triangles") {
  const Built built(
      "light lamps { ambient 0.1; spot at (1m, -2m, 4m) along (0, -0.15, -1) power 0.8 specular "
      "0.3 "
      "ambient 0.2 cutoff 45deg exponent 10 fade (1, 0, 0.5); sun (0, 0, -1) power 0.7 specular "
      "0.6\nheadlight power 0.4 specular 0.5 ambient 0.1; shading vertex }\n"
      "variant v of red_on_tray { light lamps }\n");
  const plan::Plan& plan = built.plan();
  const plan::LightRecord& light = plan.lights()[built.task("v").light];
  CHECK(light.shading == 1);
  CHECK(light.ambient == 0.1);
  CHECK(light.suns.count == 0);
  const auto lamps = plan.lamps(light);
  REQUIRE(lamps.size() == 3);
  CHECK(lamps[0].kind == static_cast<std::uint32_t>(plan::LampKind::kSpot));
  CHECK(lamps[0].position == std::array<double, 3>{1, -2, 4});
  CHECK(lamps[0].direction == std::array<double, 3>{0, -0.15, -1});
  CHECK(lamps[0].power == 0.8);
  CHECK(lamps[0].specular == 0.3);
  CHECK(lamps[0].ambient == 0.2);
  CHECK(lamps[0].cutoff == doctest::Approx(0.7853981633974483).epsilon(1e-15));
  CHECK(lamps[0].exponent == 10);
  CHECK(lamps[0].fade == std::array<double, 3>{1, 0, 0.5});
  CHECK(lamps[1].kind == static_cast<std::uint32_t>(plan::LampKind::kSun));
  CHECK(lamps[1].specular == 0.6);
  CHECK(lamps[2].kind == static_cast<std::uint32_t>(plan::LampKind::kHeadlight));
  CHECK(lamps[2].power == 0.4);
  // A light that lights pixels has no such lamps, one that lights corners no shadows.
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  CHECK(codes("light l { headlight power 0.4 }") == "P0304");
  CHECK(codes("light l { sun (0, 0, -1) power 1 specular 1 }") == "P0304");
  CHECK(codes("light l { sun (0, 0, -1) power 1 shadow; shading vertex }") == "P0304");
  CHECK(codes("light l { ambient 1 occlusion 4; shading vertex }") == "P0304");
  // Nor has it a photo.
  write_text(asset_root() + "/scenes/photo.png", "photo");
  const auto photographed = [](const std::string& lit) {
    return failed_build("light l { " + lit +
                        " }\nscene seen like bench { camera eye overlay \"photo.png\"; light l }\n"
                        "variant v of red_on_tray { scene seen }\n");
  };
  const std::string said = photographed("headlight power 0.4; shading vertex");
  CHECK_MESSAGE(said.starts_with("error[P0304]: `shading vertex` has no photo"), said);
  CHECK(photographed("ambient 0.4") == "");
}

TEST_CASE(
    "scene, scene_st: a copy keeps what it does not say; two coordinates stand on the surface") {
  write_text(asset_root() + "/fixtures/sink/visual.glb", "sink");
  write_text(asset_root() + "/fixtures/sink/collision.obj", "sink");
  write_text(asset_root() + "/scenes/sink/visual.glb", "sink");
  write_text(asset_root() + "/scenes/photo.png", "photo");
  const Built built(R"(
scene kitchen like bench {
  robot arm at (40cm, 10cm, 70cm) yaw 90deg; joints (10deg, 1cm, 2cm)
  surface 90cm area (-60cm, -50cm) .. (50cm, 40cm)
  fixture "sink" at (20cm, 0cm, 90cm)
  backdrop "sink"
  camera eye overlay "photo.png"
  light night
  physics 1000Hz friction 0.5
}
scene raised like bench { surface 85cm area (-50cm, -50cm) .. (50cm, 50cm) }
scene standing like raised { backdrop "sink" stands }
scene lifted like standing { surface 95cm area (-50cm, -50cm) .. (50cm, 50cm) }
variant v of red_on_tray { scene kitchen }
variant w of red_on_tray { scene raised }
variant x of red_on_tray { scene standing }
variant y of red_on_tray { scene lifted }
)");
  const plan::Plan& plan = built.plan();
  const plan::SceneRecord& kitchen = plan.scenes()[built.task("v").scene];
  CHECK(kitchen.base_position == std::array<double, 3>{0.4, 0.1, 0.7});
  CHECK(kitchen.surface_z == 0.9);
  CHECK(kitchen.area == std::array<double, 4>{-0.6, -0.5, 0.5, 0.4});
  CHECK(plan.joints(kitchen)[1] == 0.01);
  CHECK(kitchen.fixture_visual != plan::kNone);
  CHECK(kitchen.fixture_position == std::array<double, 3>{0.2, 0, 0.9});
  CHECK(kitchen.backdrop != plan::kNone);
  CHECK(kitchen.photo != plan::kNone);
  CHECK(kitchen.physics_hz == 1000);
  CHECK(kitchen.friction == 0.5);
  CHECK(plan.text(plan.lights()[built.task("v").light].name) == "night");
  // The light comes with the scene: one axis.
  CHECK(built.task("v").axes == static_cast<std::uint32_t>(plan::Axis::kScene));
  const plan::SceneRecord& raised = plan.scenes()[built.task("w").scene];
  CHECK(raised.base_position[2] == 0.85);
  CHECK(raised.physics_hz == 500);
  // A backdrop stands for the surface that it was written with, in copies as well.
  CHECK(raised.backdrop_stands == 0);
  CHECK(raised.backdrop_z == 0);
  const plan::SceneRecord& standing = plan.scenes()[built.task("x").scene];
  CHECK(standing.backdrop_stands == 1);
  CHECK(standing.backdrop_z == 0.85);
  const plan::SceneRecord& lifted = plan.scenes()[built.task("y").scene];
  CHECK(lifted.backdrop_stands == 1);
  CHECK(lifted.backdrop_z == 0.85);
  CHECK(lifted.surface_z == 0.95);
}
