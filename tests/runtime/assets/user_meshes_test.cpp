// Meshes of every format in the suite's own text: what is compiled, what runs, and what `check`
// says of files that are not good.
#include <doctest/doctest.h>

#include <span>

#include "compiler/emit/compile.h"
#include "runtime/assets/asset_check.h"
#include "runtime/plan/plan.h"
#include "runtime/scene/image.h"
#include "runtime/show/preview.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/tiny_meshes.h"

namespace probe::assets {
namespace {

using namespace scene::test;
using run::TemporaryFolder;
namespace fs = std::filesystem;

// The part of our assets that carrot_on_plate needs, without the carrot and without a manifest.
struct OwnAssets : TemporaryFolder {
  OwnAssets() {
    const fs::path ours = VLAPROBE_SOURCE_DIR "/assets";
    for (const char* part : {"objects/plate", "robots/widowx", "scenes/table"}) {
      fs::create_directories(fs::path(path) / part);
      fs::copy(ours / part, fs::path(path) / part, fs::copy_options::recursive);
    }
  }
  std::string carrot(const std::string& name) const { return path + "/objects/carrot/" + name; }
};

Compilation compile(const std::string& root, bool want_plan) {
  auto inspect = AssetCheck::open(root);
  REQUIRE(inspect.ok());
  CompileOptions options{.asset_root = root,
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"},
                         .inspect_asset = *inspect};
  options.wants_task = [](std::string_view name) { return name == "carrot_on_plate"; };
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/intact.probe";
  auto compiled =
      want_plan ? build(std::span(&file, 1), options) : check(std::span(&file, 1), options);
  REQUIRE(compiled.ok());
  return *std::move(compiled);
}

// A tetrahedron: one part by its indices.
std::string small_obj_of_one_part() {
  return "v 0 0 0\nv 0.02 0 0\nv 0 0.02 0\nv 0 0 0.02\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
}

// The errors of `check`, one a line.
std::string errors(const std::string& root) {
  const Compilation compiled = compile(root, false);
  std::string text;
  for (const Diagnostic& diagnostic : compiled.diagnostics.items()) {
    if (diagnostic.severity == Severity::kError) text += diagnostic.message + "\n";
  }
  return text;
}

bool says(const std::string& text, const std::string& what) {
  INFO(text);
  return text.find(what) != std::string::npos;
}

TEST_CASE("a mesh of any format beside no collision mesh is seen, felt and settled") {
  const std::pair<const char*, std::string> files[] = {{"visual.stl", binary_stl_box()},
                                                       {"visual.obj", obj_box()},
                                                       {"visual.dae", dae_box("Z_UP")},
                                                       {"visual.glb", glb_file(gltf_box(""))}};
  for (const auto& [name, bytes] : files) {
    OwnAssets assets;
    write_text(assets.carrot(name), bytes);
    CHECK(errors(assets.path).empty());
    Compilation built = compile(assets.path, true);
    REQUIRE(built.ok);
    const auto plan = plan::Plan::from_bytes(std::move(built.plan));
    REQUIRE(plan.ok());
    int named = 0;
    for (const plan::AssetRecord& asset : plan->assets()) {
      if (plan->text(asset.path) == std::string("objects/carrot/") + name) ++named;
    }
    CHECK(named == 2);                                // to be seen and to be felt
    if (std::string(name) == "visual.glb") continue;  // its node puts it a metre away
    const auto start = show::write_start(*plan, 0, 0, assets / "start.png", assets.path);
    CHECK_MESSAGE(start.ok(), (start.ok() ? "" : to_text(start.failure())));
  }
}

TEST_CASE("check names the file that is not good, what is wrong with it and who needs it") {
  OwnAssets assets;
  CHECK(says(errors(assets.path), "asset `objects/carrot/visual.glb` is not there"));
  const std::string collision = small_obj_of_one_part();
  write_text(assets.carrot("collision.obj"), collision);
  const auto with = [&](const std::string& name, const std::string& bytes) {
    for (const char* old :
         {"visual.glb", "visual.gltf", "visual.dae", "visual.obj", "visual.stl"}) {
      fs::remove(assets.carrot(old));
    }
    write_text(assets.carrot(name), bytes);
    return errors(assets.path);
  };
  CHECK(with("visual.obj", obj_box()).empty());
  for (const auto& [name, bytes] :
       {std::pair<std::string, std::string>{"visual.glb", glb_file(gltf_box(""))},
        {"visual.dae", dae_box("Z_UP")},
        {"visual.stl", binary_stl_box()}}) {
    CHECK(
        says(with(name, bytes.substr(0, bytes.size() / 2)), "asset `objects/carrot/" + name + "`"));
  }
  CHECK(says(with("visual.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "not finite"));
  CHECK(says(with("visual.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "more than 1000 m"));
  CHECK(says(with("visual.obj", obj_box("mtllib wood.mtl\n")), "assets pack"));
  CHECK(says(with("visual.dae", dae_box("Z_UP", 1, "../../../../etc/wood.png")), "assets pack"));
  with("visual.obj", obj_box());
  write_text(assets.carrot("collision.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  CHECK(says(errors(assets.path),
             "asset `objects/carrot/collision.obj` 4: a face names a vertex that is not there"));
  write_text(assets.carrot("collision.obj"), collision);

  write_text(assets / "scenes/table/photo.png", "\x89PNG not one");
  CHECK(says(errors(assets.path), "asset `scenes/table/photo.png` cannot read the image"));
  fs::remove(assets / "scenes/table/photo.png");

  // A link that leads out of the folder.
  fs::remove(assets.carrot("visual.obj"));
  fs::create_symlink(VLAPROBE_SOURCE_DIR "/assets/objects/carrot/visual.glb",
                     assets.carrot("visual.glb"));
  CHECK(says(errors(assets.path), "is a link that leads out of the asset folder"));
}

TEST_CASE("a photo in the scene's folder stands behind the robot, at any size") {
  OwnAssets assets;
  write_text(assets.carrot("visual.obj"), obj_box());
  REQUIRE(scene::write_png(assets / "scenes/table/photo.png", 40, 30,
                           std::vector<std::uint8_t>(3600, 77))
              .ok());
  Compilation built = compile(assets.path, true);
  REQUIRE(built.ok);
  const auto plan = plan::Plan::from_bytes(std::move(built.plan));
  REQUIRE(plan.ok());
  REQUIRE(plan->scenes()[0].photo != plan::kNone);
  CHECK(plan->scenes()[0].backdrop != plan::kNone);
  REQUIRE(show::write_start(*plan, 0, 0, assets / "start.png", assets.path).ok());
  const auto picture = scene::load_image(assets / "start.png");
  REQUIRE(picture.ok());
  CHECK(picture->width == 640);
  const std::size_t corner = 4 * (479u * 640u + 639u);
  CHECK(picture->rgba[corner] == 77);
}

TEST_CASE("tasks that the assets serve can be compiled without the others") {
  OwnAssets assets;
  write_text(assets.carrot("visual.obj"), obj_box());
  CompileOptions options{.asset_root = assets.path,
                         .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}};
  const std::string file = VLAPROBE_SOURCE_DIR "/suite/intact.probe";
  const auto all = check(std::span(&file, 1), options);
  REQUIRE(all.ok());
  CHECK_FALSE(all->ok);
  bool named = false;
  for (const Diagnostic& diagnostic : all->diagnostics.items()) {
    if (diagnostic.message != "asset `objects/spoon/visual.glb` is not there") continue;
    for (const std::string& note : diagnostic.notes) {
      named = named || note.starts_with("needed by `spoon_on_towel`, ");
    }
  }
  CHECK(named);
  CHECK(compile(assets.path, false).ok);
}

}  // namespace
}  // namespace probe::assets
