#include "assets/make/generators.h"
#include "runtime/base/sha256.h"
#include "tests/assets/asset_files.h"

using namespace probe;

TEST_CASE("the manifest gives size and hash of every file, sorted by path") {
  const auto manifest = Json::parse(test::read_bytes(test::asset_path("manifest.json")));
  std::vector<std::string> paths;
  for (const auto& entry : manifest.at("files")) {
    const std::string path = entry.at("path").text();
    CAPTURE(path);
    const std::string bytes = test::read_bytes(test::asset_path(path));
    CHECK(entry.at("bytes").get<std::size_t>() == bytes.size());
    CHECK(entry.at("sha256").get<std::string>() == to_hex(sha256(bytes)));
    paths.push_back(path);
  }
  CHECK(std::is_sorted(paths.begin(), paths.end()));
  // Six textures, three scenes, the sink's two files, six links of fixtures with joints, two a link
  // and two an object.
  // The Google robot has more shapes that are seen than felt, seven of them in three more colourings,
  // a table and a room.
  constexpr std::size_t kGoogle = 11 + 9 + 3 * 7 + 2;
  CHECK(paths.size() ==
        6 + 12 + kGoogle + 2 * test::link_names().size() + 2 * test::object_names().size());
}

TEST_CASE("no mesh lies in the asset folders that the manifest does not name") {
  const auto manifest = Json::parse(test::read_bytes(test::asset_path("manifest.json")));
  std::set<std::string> named;
  for (const auto& entry : manifest.at("files")) named.insert(entry.at("path").text());
  const std::filesystem::path root = test::asset_path("");
  for (const char* folder : {"objects", "fixtures", "robots", "scenes"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".glb" && extension != ".obj") continue;
      const std::string path = std::filesystem::relative(entry.path(), root).generic_string();
      CHECK_MESSAGE(named.count(path) == 1, path);
    }
  }
}

TEST_CASE("making the assets again gives the bytes that are checked in") {
  const std::vector<make::OutputFile> files = make::make_all();
  std::size_t total = 0;
  for (const make::OutputFile& file : files) {
    CAPTURE(file.path);
    // A bare comparison: doctest would print both files.
    const bool same = test::read_bytes(test::asset_path(file.path)) == file.bytes;
    CHECK(same);
    total += file.bytes.size();
  }
  const bool same_manifest =
      test::read_bytes(test::asset_path("manifest.json")) == make::manifest_bytes(files);
  CHECK(same_manifest);
  CHECK(total < 6'000'000);
}

TEST_CASE("in the dark every asset of ours is black, but for what has its light baked in") {
  std::size_t seen = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(VLAPROBE_SOURCE_DIR "/assets")) {
    if (entry.path().extension() != ".glb") continue;
    const Json header = test::glb_header(test::read_bytes(entry.path().string()));
    for (const auto& material : header.at("materials")) {
      const bool glows =
          material.contains("emissiveFactor") || material.contains("emissiveTexture");
      const bool is_baked = entry.path().string().find("/objects/baked_") != std::string::npos;
      CHECK_MESSAGE(glows == is_baked, entry.path().string(), ": ", material.value("name", ""));
      if (!is_baked) continue;
      // Whatever lamp there is: what shines takes no light. Other programs want a factor.
      const auto& pbr = material.at("pbrMetallicRoughness");
      CHECK(!pbr.contains("baseColorTexture"));
      CHECK(pbr.at("baseColorFactor") == Json{0.0, 0.0, 0.0, 1.0});
      CHECK(material.contains("emissiveFactor"));
    }
    ++seen;
  }
  CHECK(seen >= 34);  // 20 objects, 11 links, a fixture, two scenes
}

TEST_CASE("what has its light baked in is felt as the plain thing, to the byte") {
  for (const auto& [baked, plain] : {std::pair{"apple", "apple"},
                                     {"apple_v2", "apple"},
                                     {"7up_can", "coke_can"},
                                     {"coke_can", "coke_can"},
                                     {"pepsi_can", "pepsi_can"},
                                     {"slim_can", "slim_can"},
                                     {"long_sponge", "long_sponge"}}) {
    CAPTURE(baked);
    const auto felt = [](const std::string& name) {
      return test::read_bytes(test::asset_path("objects/" + name + "/collision.obj"));
    };
    CHECK(felt(std::string("baked_") + baked) == felt(plain));
  }
}

TEST_CASE("files that cannot be written are a failure that names the place") {
  const Status status = make::write_files("/dev/null/assets", {{"a/b.txt", "text"}});
  REQUIRE(!status.ok());
  CHECK(status.failure().code == Fault::kIo);
  CHECK(status.failure().where.find("/dev/null/assets") == 0);
}

TEST_CASE("a visual is glTF 2.0 with one node that has no transform") {
  const std::string bytes = test::read_bytes(test::asset_path("objects/carrot/visual.glb"));
  CHECK(bytes.substr(0, 4) == "glTF");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  CHECK(length == bytes.size());
  const auto header = test::glb_header(bytes);
  REQUIRE(header.at("nodes").size() == 1);
  for (const char* key : {"matrix", "translation", "rotation", "scale"}) {
    CHECK(!header["nodes"][0].contains(key));
  }
  for (const auto& material : header.at("materials")) {
    CHECK(material.at("pbrMetallicRoughness").at("metallicFactor") == 0.0);
  }
}
