#include "runtime/base/asset_root.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/runtime/run/temporary_folder.h"

using namespace probe;
using probe::run::TemporaryFolder;

namespace fs = std::filesystem;

namespace {

// A thing with one file.
void put(const TemporaryFolder& folder, const std::string& path) {
  const fs::path file = folder / path;
  fs::create_directories(file.parent_path());
  std::ofstream(file) << path;
}

}  // namespace

TEST_CASE("a thing is whole in the first folder that has it, whatever the others have of it") {
  TemporaryFolder folder;
  put(folder, "a/objects/mug/visual.glb");
  put(folder, "b/objects/mug/visual.glb");
  put(folder, "b/objects/mug/collision.obj");
  put(folder, "b/objects/bowl/visual.glb");
  put(folder, "b/textures/oak.png");
  put(folder, "a/textures/pine.png");
  const AssetRoot root = AssetRoot::chosen({folder / "a", folder / "b"});
  CHECK(root.file("objects/mug/visual.glb") == folder / "a/objects/mug/visual.glb");
  CHECK(root.file("objects/mug/collision.obj") == folder / "a/objects/mug/collision.obj");
  CHECK(root.file("objects/bowl/visual.glb") == folder / "b/objects/bowl/visual.glb");
  // A file that is a thing by itself.
  CHECK(root.holder("textures/oak.png") == folder / "b");
  CHECK(root.holder("textures/pine.png") == folder / "a");
  // What is nowhere is missed in the first.
  CHECK(root.holder("objects/spoon/visual.glb") == folder / "a");
  CHECK(root.text() == "`" + (folder / "a") + "`, `" + (folder / "b") + "`");
  CHECK(AssetRoot().file("objects/mug/visual.glb") == "objects/mug/visual.glb");
}

TEST_CASE("what lies beside a text comes behind what was named and before what is found by itself") {
  TemporaryFolder folder;
  for (const char* path : {"named/objects/mug/x", "text/objects/mug/x", "text/assets/objects/cup/x",
                           "own/objects/mug/x", "own/objects/cup/x", "own/objects/bowl/x"})
    put(folder, path);
  const std::vector<std::string> texts = {folder / "text/my.probe", folder / "text/other.probe"};
  const AssetRoot named = AssetRoot::chosen({folder / "named"}).beside(texts);
  CHECK(named.holder("objects/mug/x") == folder / "named");
  CHECK(named.holder("objects/cup/x") == folder / "text/assets");
  const AssetRoot found = AssetRoot::found({folder / "own"}).beside(texts);
  CHECK(found.holder("objects/mug/x") == folder / "text");
  CHECK(found.holder("objects/cup/x") == folder / "text/assets");
  CHECK(found.holder("objects/bowl/x") == folder / "own");
  CHECK(found.text() == "`" + (folder / "own") + "`");

  // One folder under two names is one: nothing lies beside a text that the program has itself.
  fs::create_directory_symlink(folder / "text", folder / "linked");
  const std::vector<std::string> linked = {folder / "linked/my.probe"};
  CHECK(AssetRoot::found({folder / "text"}).beside(linked).folders() ==
        std::vector<std::string>{folder / "linked/assets", folder / "text"});

  // Kept are the folders that are needed; nothing, where it is as without any text.
  const std::vector<std::string> cup = {"objects/cup/x", "objects/bowl/x"}, bowl = {"objects/bowl/x"};
  CHECK(found.kept_for(cup).folders() ==
        std::vector<std::string>{folder / "text/assets", folder / "own"});
  CHECK(found.kept_for(bowl).empty());
  CHECK(named.kept_for(bowl).folders() == std::vector<std::string>{folder / "named"});

  // A folder that is gone meanwhile is told of as what it was.
  fs::remove_all(folder / "text");
  const auto gone = find_asset_root(found);
  REQUIRE_FALSE(gone.ok());
  CHECK(to_text(gone.failure()).find("beside the text is gone") != std::string::npos);
}

TEST_CASE("several folders of the environment stand as in PATH, and a name may have a colon") {
  TemporaryFolder folder;
  put(folder, "a/objects/mug/x");
  put(folder, "b:c/objects/mug/x");
  const char* before = std::getenv("VLAPROBE_ASSETS");
  const std::string kept = before == nullptr ? "" : before;
  setenv("VLAPROBE_ASSETS", (folder / "b:c").c_str(), 1);
  auto root = find_asset_root();
  REQUIRE(root.ok());
  CHECK(root->folders() == std::vector<std::string>{folder / "b:c"});
  setenv("VLAPROBE_ASSETS", ((folder / "a") + ":" + (folder / "a")).c_str(), 1);
  root = find_asset_root();
  REQUIRE(root.ok());
  CHECK(root->folders() == std::vector<std::string>{folder / "a"});
  setenv("VLAPROBE_ASSETS", ((folder / "a") + ":" + (folder / "none")).c_str(), 1);
  root = find_asset_root();
  REQUIRE_FALSE(root.ok());
  CHECK(root.failure().where == folder / "none");
  setenv("VLAPROBE_ASSETS", ":", 1);
  CHECK_FALSE(find_asset_root().ok());
  if (before == nullptr) unsetenv("VLAPROBE_ASSETS");
  else setenv("VLAPROBE_ASSETS", kept.c_str(), 1);
  // A named folder is one, whatever its name has.
  CHECK(find_asset_root(AssetRoot::chosen({folder / "b:c"})).ok());
}
