// Import of a made-up data folder: what is taken, what is odd, what is missing, and that the result
// is an asset folder.
#include <doctest/doctest.h>

#include <algorithm>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/assets/asset_check.h"
#include "runtime/assets/catalogue_text.h"
#include "runtime/assets/import.h"
#include "runtime/assets/pack.h"
#include "runtime/assets/robot_files.h"
#include "runtime/base/file.h"
#include "runtime/robot/urdf.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/image.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::assets {
namespace {

using namespace scene::test;
using run::TemporaryFolder;
namespace fs = std::filesystem;

constexpr char kBoxInfo[] =
    R"("bbox":{"min":[-0.01,-0.02,-0.03],"max":[0.01,0.02,0.03]},"scales":[1.0],"density":700)";

// data/custom with a carrot as it should be, a plate without collision mesh, a can that is cut off,
// a model of the user's and one photo.
void make_data(const std::string& root) {
  const std::string models = root + "/data/custom/models/";
  write_text(models + "bridge_carrot_generated_modified/textured.dae", dae_box("Z_UP"));
  write_text(models + "bridge_carrot_generated_modified/collision.stl", binary_stl_box());
  write_text(models + "bridge_plate_objaverse_larger/textured.obj", obj_box());
  write_text(models + "coke_can/textured.dae", dae_box("Z_UP").substr(0, 900));
  write_text(models + "coke_can/collision.obj", obj_box());
  write_text(models + "mug 2/textured.glb", glb_file(gltf_box("")));
  write_text(root + "/data/custom/info_bridge_custom_v0.json",
             std::string("{\"bridge_carrot_generated_modified\":{") + kBoxInfo +
                 "},\"bridge_plate_objaverse_larger\":{" + kBoxInfo +
                 "},\"flat\":{\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]}}}");
  write_text(root + "/data/custom/info_broken.json", "{\"cut\":");
  fs::create_directories(root + "/data/real_inpainting");
  REQUIRE(scene::write_png(root + "/data/real_inpainting/bridge_real_eval_1.png", 4, 3,
                           std::vector<std::uint8_t>(36, 50))
              .ok());
}

std::string line_of(const ImportReport& report, const std::string& name) {
  for (const ImportLine& line : report.lines) {
    if (line.name == name) return std::string(to_word(line.verdict)) + " " + line.text;
  }
  return "no line";
}

bool says(const std::string& text, const std::string& what) {
  INFO(text);
  return text.find(what) != std::string::npos;
}

TEST_CASE("a data folder becomes an asset folder with a line on everything") {
  TemporaryFolder folder;
  make_data(folder / "repo");
  REQUIRE(scene::write_png(folder / "repo/data/real_inpainting/bridge_sink.png", 16, 10,
                           std::vector<std::uint8_t>(480, 50))
              .ok());
  const auto report = import_data({folder / "repo", folder / "out", ""});
  REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : to_text(report.failure())));

  CHECK(says(line_of(*report, "objects/carrot"), "taken bridge_carrot_generated_modified: 12"));
  CHECK(says(line_of(*report, "objects/plate"), "odd "));
  CHECK(says(line_of(*report, "objects/plate"), "no collision mesh"));
  CHECK(says(line_of(*report, "objects/coke_can"),
             "missing data/custom/models/coke_can/textured.dae: "));
  CHECK(says(line_of(*report, "objects/nut"), "missing no model `nut` in the data"));
  CHECK(says(line_of(*report, "objects/mug 2"), "in no model database"));
  CHECK(says(line_of(*report, "scenes/table"), "photo bridge_real_eval_1.png, 4 x 3"));
  CHECK(says(line_of(*report, "scenes/table"), "the photo is scaled"));
  CHECK(says(line_of(*report, "scenes/sink"), "the photo is 16 x 10 pixels, the camera's picture"));
  CHECK(says(line_of(*report, "robots/widowx"), "missing no wx250s.urdf"));
  CHECK(says(line_of(*report, "database"), "`flat` has a box without size"));

  // Whole, hashed, readable; ours were not filled in.
  const auto manifest = read_manifest(folder / "out");
  REQUIRE(manifest.ok());
  CHECK(manifest->find("objects/carrot/visual.glb")->source ==
        "data/custom/models/bridge_carrot_generated_modified/textured.dae");
  for (const auto& [path, entry] : manifest->files) {
    const auto bytes = read_file((folder / "out/") + path);
    REQUIRE(bytes.ok());
    CHECK(bytes->size() == entry.bytes);
    CHECK(to_hex(sha256(*bytes)) == entry.sha256);
  }
  CHECK_FALSE(fs::exists(folder / "out/objects/nut"));
  const auto shape =
      scene::load_collision_mesh(folder / "out/objects/carrot/collision.obj", {1, 1, 1});
  REQUIRE(shape.ok());
  CHECK(shape->parts.size() == 1);
  CHECK(says(*read_file(folder / "out/objects.probe"),
             "mesh \"carrot\"; box 2cm x 4cm x 6cm; density 700kg/m3"));
  CHECK(says(*read_file(folder / "out/objects.probe"), "object mug_2 {"));

  // Nothing is left of the making, and what is there is not written over.
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 2);
  const auto again = import_data({folder / "repo", folder / "out", ""});
  REQUIRE_FALSE(again.ok());
  CHECK(says(to_text(again.failure()), "is there already"));
}

TEST_CASE("what is missing is taken from elsewhere only when that was asked for, and said") {
  TemporaryFolder folder;
  make_data(folder / "repo");
  const std::string own = VLAPROBE_SOURCE_DIR "/assets";
  const auto report = import_data({folder / "repo", folder / "out", own});
  REQUIRE(report.ok());
  CHECK(says(line_of(*report, "objects/nut"), "filled "));
  CHECK(says(line_of(*report, "objects/nut"), "vlaprobe's own"));
  CHECK(*read_file(folder / "out/objects/nut/visual.glb") ==
        *read_file(own + "/objects/nut/visual.glb"));
  CHECK(fs::exists(folder / "out/robots/widowx/wx250s.urdf"));
}

// The Google robot's half: two cans of which one has no picture mesh, photos of two sizes and one of
// another shape, the robot and a colouring whose texture is not there.
void make_google_data(const std::string& root) {
  const std::string models = root + "/data/custom/models/";
  write_text(models + "opened_coke_can/textured.dae", dae_box("Z_UP", 2));  // it is halved
  write_text(models + "opened_coke_can/collision.stl", binary_stl_box());
  // The release has closed cans, too, which are not the suite's.
  write_text(models + "coke_can/textured.dae", dae_box("Z_UP"));
  write_text(models + "coke_can/collision.obj", obj_box());
  write_text(models + "opened_redbull_can/collision.obj", obj_box());
  fs::create_directories(root + "/data/real_inpainting");
  const auto photo = [&](const char* name, int width, int height) {
    REQUIRE(scene::write_png(
                root + "/data/real_inpainting/" + name, width, height,
                std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 50))
                .ok());
  };
  photo("open_drawer_a0.png", 320, 256);
  photo("open_drawer_a1.png", 640, 512);
  photo("open_drawer_b0.png", 320, 240);
  photo("open_drawer_b1.png", 100, 81);
  photo("open_drawer_c0.png", 1000, 792);
  const std::string description = root + "/descriptions/googlerobot_description/";
  const std::string stem = "google_robot_meta_sim_fix_wheel_fix_fingertip";
  const auto robot = [](const std::string& mesh) {
    return "<robot name=\"meta\"><link name=\"base\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" "
           "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><visual><geometry><mesh "
           "filename=\"" +
           mesh + "\"/></geometry></visual></link></robot>";
  };
  write_text(description + "3obj/arm.dae", dae_box("Z_UP"));
  write_text(description + stem + ".urdf", robot("3obj/arm.dae"));
  write_text(description + "3obj_recolor/arm.dae", dae_box("Z_UP", 1, "brown.png"));
  write_text(description + stem + "_recolor_cabinet_visual_matching_1.urdf",
             robot("3obj_recolor/arm.dae"));
}

TEST_CASE("for the Google robot's suite: what is there under its names, what is not by name") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  const auto report =
      import_data({folder / "repo", folder / "out", "", ImportFor::kGoogle});
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK_MESSAGE(says(line_of(*report, "objects/coke_can"), "opened_coke_can at 0.5: "),
                line_of(*report, "objects/coke_can"));
  CHECK(says(line_of(*report, "objects/slim_can"),
             "missing opened_redbull_can has no textured.glb"));
  CHECK(says(line_of(*report, "objects/water_bottle"), "missing no model `blue_plastic_bottle`"));
  CHECK_FALSE(fs::exists(folder / "out/objects/slim_can"));
  // A photo of half the picture's size is shown, one of another shape is not taken.
  CHECK(line_of(*report, "scenes/google/open_drawer_a0.png") == "taken 320 x 256");
  CHECK(line_of(*report, "scenes/google/open_drawer_a1.png") == "taken 640 x 512");
  CHECK(says(line_of(*report, "scenes/google/open_drawer_b0.png"),
             "missing the photo is 320 x 240 pixels, the camera's picture 640 x 512: "));
  CHECK_FALSE(fs::exists(folder / "out/scenes/google/open_drawer_b0.png"));
  // By the rule of those who show it: a pixel of rounding, and else a hundredth of the shape.
  CHECK(line_of(*report, "scenes/google/open_drawer_b1.png") == "taken 100 x 81");
  CHECK(says(line_of(*report, "scenes/google/open_drawer_c0.png"),
             "missing the photo is 1000 x 792"));
  CHECK(says(line_of(*report, "scenes/google/open_drawer_c2.png"), "missing no photo"));
  // A colouring without its texture would be the plain robot.
  CHECK(says(line_of(*report, "robots/google_released/google_robot.urdf"), "1 mesh files"));
  CHECK(fs::exists(folder / "out/robots/google_released/meshes/google_robot/arm.glb"));
  const std::string brown = line_of(*report, "robots/google_released/google_robot_cabinet_1.urdf");
  CHECK(says(brown, "missing "));
  CHECK(says(brown, "brown.png"));
  CHECK_FALSE(fs::exists(folder / "out/robots/google_released/google_robot_cabinet_1.urdf"));

  // Nothing of ours is taken, until it is asked for.
  const auto filled = import_data({folder / "repo", folder / "filled",
                                   VLAPROBE_SOURCE_DIR "/assets", ImportFor::kGoogle});
  REQUIRE(filled.ok());
  CHECK(says(line_of(*filled, "objects/slim_can"), "filled "));
  CHECK(fs::exists(folder / "filled/objects/slim_can/visual.glb"));
}

TEST_CASE(
    "a baked thing of the release shines, and without a mesh of its own is felt as the plain") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  const std::string models = folder / "repo/data/custom/models/";
  // Of another width than what is felt.
  write_text(models + "baked_opened_coke_can/textured.dae", dae_box("Z_UP", 2.5));
  write_text(models + "baked_opened_pepsi_can/textured.dae", dae_box("Z_UP", 2.5));
  write_text(models + "baked_opened_pepsi_can/collision.obj", obj_box());
  write_text(models + "baked_sponge/textured.dae", dae_box("Z_UP"));
  const auto report = import_data({folder / "repo", folder / "out", "", ImportFor::kGoogle});
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  const auto felt = [&](const std::string& name) {
    return *read_file(folder / ("out/objects/" + name + "/collision.obj"));
  };
  CHECK(says(line_of(*report, "objects/baked_coke_can"), "felt as opened_coke_can"));
  CHECK(felt("baked_coke_can") == felt("coke_can"));
  CHECK_FALSE(says(line_of(*report, "objects/baked_pepsi_can"), "felt as opened"));
  // No plain one in the data either.
  CHECK(says(line_of(*report, "objects/baked_long_sponge"), "taken from the picture mesh"));
  CHECK(says(line_of(*report, "objects/baked_7up_can"),
             "missing no model `baked_opened_7up_can` in the data"));
}

TEST_CASE("what is copied is the suite's own, not filled in; folders of models are no model") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  const std::string models = folder / "repo/data/custom/models/";
  write_text(models + "_substitutes/older_can/textured.dae", dae_box("Z_UP"));
  fs::create_directories(models + "mug");
  const auto report = import_data(
      {folder / "repo", folder / "out", "", ImportFor::kGoogle, {VLAPROBE_SOURCE_DIR "/assets"}});
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(says(line_of(*report, "robots/google_robot"), "own "));
  CHECK(fs::exists(folder / "out/robots/google_robot"));
  CHECK(std::ranges::none_of(
      report->lines, [](const ImportLine& line) { return line.verdict == Verdict::kFilled; }));
  CHECK(line_of(*report, "objects/_substitutes") == "no line");
  CHECK(says(line_of(*report, "objects/mug"), "missing mug has no textured.glb"));
}

TEST_CASE("a folder with nothing but the Google robot's description is data for its suite") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  fs::remove_all(folder / "repo/data");
  const auto report = import_data({folder / "repo", folder / "out", "", ImportFor::kGoogle});
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(says(line_of(*report, "robots/google_released/google_robot.urdf"), "taken "));
  CHECK(says(line_of(*report, "objects/coke_can"), "missing no model"));
  // Other robots' tasks have no use for it.
  CHECK(says(to_text(import_data({folder / "repo", folder / "other", ""}).failure()),
             "no SimplerEnv data in it"));
}

TEST_CASE("a colouring whose mesh asks for no texture is missing, not plain") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  const std::string description = folder / "repo/descriptions/googlerobot_description/";
  const std::string name = "robots/google_released/google_robot_cabinet_1.urdf";
  const std::string urdf =
      description +
      "google_robot_meta_sim_fix_wheel_fix_fingertip_recolor_cabinet_visual_matching_1.urdf";
  std::string text = *read_file(urdf);
  text.replace(text.find("arm.dae"), 7, "arm.obj");
  write_text(urdf, text);
  const auto line = [&](const std::string& out, const std::string& used) {
    write_text(description + "3obj_recolor/arm.obj",
               "mtllib arm.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
               "usemtl " +
                   used + "\nf 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n");
    const auto report = import_data({folder / "repo", folder / out, "", ImportFor::kGoogle});
    REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
    return line_of(*report, name);
  };
  write_text(description + "3obj_recolor/arm.mtl",
             "newmtl brown\nmap_Kd brown.png\nnewmtl white\nKd 1 1 1\n");
  REQUIRE(scene::write_png(description + "3obj_recolor/brown.png", 2, 2,
                           std::vector<std::uint8_t>(12, 90))
              .ok());
  CHECK(says(line("textured", "brown"), "taken "));
  for (const char* used : {"white", "unheard"}) {
    const std::string plain = line(used, used);
    CHECK(says(plain, "missing "));
    CHECK(says(plain, "3obj_recolor/arm.obj has no texture"));
    CHECK_FALSE(fs::exists((folder / used + "/") + name));
  }
}

TEST_CASE("tasks whose thing has no mesh in an imported folder are named, with the thing") {
  TemporaryFolder folder;
  make_google_data(folder / "repo");
  REQUIRE(import_data({folder / "repo", folder / "out", "", ImportFor::kGoogle,
                       {VLAPROBE_SOURCE_DIR "/assets"}})
              .ok());
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/google.probe";
  CompileOptions options;
  options.asset_root = AssetRoot::chosen({folder / "out"});
  options.suite = "google";
  const auto built = build(std::span<const std::string>(&file, 1), options);
  REQUIRE(built.ok());
  CHECK_FALSE(built->ok);
  const std::string said = render_text(built->diagnostics, built->sources);
  CHECK(says(said, "asset `objects/slim_can/visual"));
  CHECK(says(said, "`coke_near_redbull_by_apple`"));
  CHECK(says(said, "asset `objects/water_bottle/visual"));
}

TEST_CASE("the released assets of the Google robot lack four things' meshes, and no photo") {
  const std::string released = VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_assets";
  if (!fs::exists(released)) {
    MESSAGE("skipped: the Google robot's released assets are not on this machine");
    return;
  }
  TemporaryFolder folder;
  const auto report = import_data({released, folder / "out", "", ImportFor::kGoogle});
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  std::vector<std::string> missing;
  for (const ImportLine& line : report->lines) {
    if (line.verdict == Verdict::kMissing) missing.push_back(line.name);
    MESSAGE(to_word(line.verdict) << " " << line.name << "  " << line.text);
  }
  CHECK(line_of(*report, "objects/_substitutes") == "no line");
  for (const char* name :
       {"objects/slim_can", "objects/water_bottle", "objects/eggplant", "objects/baked_slim_can"})
    CHECK(std::ranges::find(missing, name) != missing.end());
  CHECK(std::ranges::none_of(missing,
                             [](const std::string& name) { return name.starts_with("scenes/google/"); }));
}

TEST_CASE("a folder without such data, or that is none, says what was looked for") {
  TemporaryFolder folder;
  fs::create_directories(folder / "empty");
  CHECK(says(to_text(import_data({folder / "empty", folder / "out", ""}).failure()),
             "`stages` and `wx250s.urdf`"));
  CHECK(says(
      to_text(import_data({folder / "empty", folder / "out", "", ImportFor::kGoogle}).failure()),
      "`stages` and the Google robot's `.urdf`"));
  CHECK(says(to_text(import_data({folder / "none", folder / "out", ""}).failure()),
             "is not a folder"));
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("the mesh elements of a description are replaced and nothing else") {
  const std::string text =
      "<robot><!-- <mesh filename='old.stl'/> --><link name=\"a\"><visual><geometry>"
      "<mesh scale='0.001 0.001 0.001' filename = \"m/a.dae\"/></geometry></visual>"
      "<collision><geometry><mesh "
      "filename=\"m/a.stl\"></mesh></geometry></collision></link></robot>";
  std::vector<MeshElement> seen;
  const auto out = replace_meshes(text, [&](const MeshElement& element) -> Result<std::string> {
    seen.push_back(element);
    return std::string("new") + std::to_string(seen.size());
  });
  REQUIRE(out.ok());
  REQUIRE(seen.size() == 2);
  CHECK(seen[0].file == "m/a.dae");
  CHECK(seen[0].scale == "0.001 0.001 0.001");
  CHECK_FALSE(seen[0].is_collision);
  CHECK(seen[1].is_collision);
  CHECK(says(*out, "<!-- <mesh filename='old.stl'/> -->"));
  CHECK(says(*out, "<mesh filename=\"new1\"/>"));
  CHECK(says(*out, "<mesh filename=\"new2\"></mesh>"));
  CHECK_FALSE(replace_meshes("<robot", [](const MeshElement&) -> Result<std::string> {
                return std::string();
              }).ok());
}

TEST_CASE("a robot with package paths, collada and stl is packed into one that is read as it was") {
  TemporaryFolder folder;
  const std::string package = folder / "arm_description/";
  write_text(package + "meshes/arm.dae", dae_box("Z_UP"));
  write_text(package + "meshes/arm.stl", binary_stl_box());
  const std::string urdf = write_text(
      package + "urdf/arm.urdf",
      "<robot name=\"arm\"><link name=\"base\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" "
      "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><visual><geometry><mesh "
      "filename=\"package://arm_description/meshes/arm.dae\" scale=\"2 2 2\"/></geometry></visual>"
      "<collision><geometry><mesh filename=\"../meshes/arm.stl\"/></geometry></collision></link>"
      "</robot>");
  const auto packed = pack_asset({urdf, folder / "out", "", 1});
  REQUIRE_MESSAGE(packed.ok(), (packed.ok() ? "" : to_text(packed.failure())));
  const auto model = robot::load_urdf(folder / "out/arm.urdf");
  REQUIRE(model.ok());
  REQUIRE(model->links[0].visuals.size() == 1);
  CHECK(model->links[0].visuals[0].path == "meshes/arm.glb");
  CHECK(model->links[0].visuals[0].scale == Vec3(1, 1, 1));
  const auto mesh = scene::load_mesh(folder / "out/meshes/arm.glb");
  REQUIRE(mesh.ok());
  float widest = 0;
  for (const float x : (*mesh)->parts[0].positions) widest = std::max(widest, x);
  CHECK(widest == doctest::Approx(2 * kHalf[2]));
  CHECK(fs::exists(folder / "out/meshes/arm_collision.obj"));

  fs::remove(package + "meshes/arm.stl");
  CHECK(says(to_text(pack_asset({urdf, folder / "out2", "", 1}).failure()), "arm.stl"));
}

TEST_CASE("a mesh is packed with its scale, its texture and a collision shape of its own") {
  TemporaryFolder folder;
  fs::create_directories(folder / "mug");
  REQUIRE(scene::write_png(folder / "mug/wood.png", 2, 2, std::vector<std::uint8_t>(12, 90)).ok());
  const std::string dae = write_text(folder / "mug/mug.dae", dae_box("Z_UP", 1, "wood.png"));
  const auto packed = pack_asset({dae, folder / "my/objects/mug", "", 0.5});
  REQUIRE_MESSAGE(packed.ok(), (packed.ok() ? "" : to_text(packed.failure())));
  CHECK(says(packed->made,
             "1 convex part, 1 x 2 x 3 cm; box (-0.5cm, -1cm, -1.5cm) .. (0.5cm, 1cm, 1.5cm)"));
  const auto check = AssetCheck::open(folder / "my");
  REQUIRE(check.ok());
  const Sha256 none = sha256(std::string_view(""));
  CHECK((*check)(folder / "my", "objects/mug/visual.glb", plan::AssetKind::kVisualMesh, none).ok());
  CHECK((*check)(folder / "my", "objects/mug/collision.obj", plan::AssetKind::kCollisionMesh, none)
            .ok());
  CHECK_FALSE(pack_asset({dae, folder / "my/objects/other", "", 0}).ok());
  fs::remove(folder / "mug/wood.png");
  CHECK(says(to_text(pack_asset({dae, folder / "my/objects/cup", "", 1}).failure()), "wood.png"));
}

TEST_CASE("what the manifest vouches for is not read again, whatever else is") {
  TemporaryFolder folder;
  const std::string path = "objects/box/visual.obj";
  write_text((folder / "a/") + path, "not a mesh");
  auto check = AssetCheck::open(folder / "a");
  REQUIRE(check.ok());
  const Sha256 own = sha256(std::string_view("not a mesh"));
  const Status bad = (*check)(folder / "a", path, plan::AssetKind::kVisualMesh, own);
  REQUIRE_FALSE(bad.ok());
  CHECK(bad.failure().where == path);

  Manifest manifest;
  manifest.files[path] = {10, to_hex(own), ""};
  write_text(folder / "a/manifest.json", manifest.to_json());
  check = AssetCheck::open(folder / "a");
  REQUIRE(check.ok());
  CHECK((*check)(folder / "a", path, plan::AssetKind::kVisualMesh, own).ok());
  const Sha256 other = sha256(std::string_view("not a mask"));
  CHECK_FALSE((*check)(folder / "a", path, plan::AssetKind::kVisualMesh, other).ok());

  write_text(folder / "a/manifest.json", "{\"files\":[{\"path\":3}]}");
  CHECK_FALSE(AssetCheck::open(folder / "a").ok());
}

TEST_CASE("names that the language cannot have are made so") {
  const std::string text = catalogue_text({{"7up can", {-1, -1, 0}, {1, 1, 2}, 50}});
  CHECK(says(text, "object model_7up_can {"));
  CHECK(says(text, "box (-100cm, -100cm, 0cm) .. (100cm, 100cm, 200cm); density 50kg/m3"));
  CHECK(says(text, "name \"7up can\""));
}

TEST_CASE("the catalogue's text checks, whatever the models are called") {
  const Vec3 low(-1, -1, 0), high(1, 1, 2);
  std::vector<CatalogueObject> objects;
  for (const std::string folder :
       {"-dash", "a-b", "a_b", "A B", "_", "--", "", "quo\"te", "back\\slash", "new\nline",
        "esc\x1b[2J", "caf\xc3\xa9", "object", "task", "001", ".hidden", "(x)", "sp  ace "}) {
    objects.push_back({folder, low, high, 700});
  }
  objects.push_back({std::string(255, 'x'), low, high, 700});
  objects.push_back({"flat", low, {1, 1, 0}, 700});
  objects.push_back({"endless", low, {1, 1, 1e300}, 700});
  objects.push_back({"nothing", low, high, 0});
  objects.push_back({"heavy", low, high, 1e300});
  const std::string text = catalogue_text(objects);
  CHECK(says(text, "object model_dash {"));
  CHECK(says(text, "object a_b {"));
  CHECK(says(text, "object a_b_2 {"));
  CHECK(says(text, "object a_b_3 {"));
  CHECK(says(text, "# left out, for its name: esc [2J"));
  CHECK(says(text, "# left out, for its box or density: flat"));
  TemporaryFolder folder;
  for (const CatalogueObject& object : objects) {
    if (object.folder.empty()) continue;
    write_text(folder / "assets/objects/" + object.folder + "/visual.glb", "x");
    write_text(folder / "assets/objects/" + object.folder + "/collision.obj", obj_box());
  }
  const std::string path = write_text(folder / "t/objects.probe", text);
  const auto checked = check(std::span(&path, 1), {.asset_root = folder / "assets"});
  REQUIRE_MESSAGE(checked.ok(), (checked ? "" : to_text(checked.failure())));
  for (const Diagnostic* found : checked->diagnostics.in_source_order())
    CHECK_MESSAGE(found->severity != Severity::kError, found->message);
}

}  // namespace
}  // namespace probe::assets
