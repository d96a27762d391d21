// The mesh cache gives what the import gives, whatever state its files are in.
#include "runtime/scene/mesh_cache.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "runtime/base/file.h"
#include "runtime/scene/mesh_hash.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("probe_cache_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path / "meshes"); }
  ~Folder() { fs::remove_all(path); }
  std::string cache() const { return (path / "cache").string(); }
  std::string mesh(double height) const {
    const std::string file = (path / "meshes" / "a.obj").string();
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 " << height << "\nf 1 2 3\n";
    return file;
  }
};

std::shared_ptr<const Mesh> load(const MeshCache& cache, const std::string& path) {
  auto mesh = cache.load(path);
  REQUIRE_MESSAGE(mesh.ok(), (mesh.ok() ? "" : to_text(mesh.failure())));
  return *mesh;
}

TEST_CASE("what comes from the cache is what was imported, textures and materials too") {
  const Folder folder;
  const MeshCache cache(folder.cache());
  const std::string can = std::string(VLAPROBE_SOURCE_DIR) + "/assets/objects/coke_can/visual.glb";
  const auto imported = load_mesh(can);
  REQUIRE(imported.ok());
  const auto first = load(cache, can);
  CHECK(fs::exists(cache.file_of(can).value()));
  const auto second = load(cache, can);
  CHECK(first != second);
  CHECK(mesh_hash(*first) == mesh_hash(**imported));
  CHECK(mesh_hash(*second) == mesh_hash(**imported));
  CHECK(second->name == can);
  REQUIRE_FALSE(second->textures.empty());
}

TEST_CASE("a cached mesh is stale when its source, its scale or a limit changes") {
  const Folder folder;
  const MeshCache cache(folder.cache());
  const std::string path = folder.mesh(0);
  const std::string flat = cache.file_of(path).value();
  CHECK(load(cache, path)->parts[0].positions[8] == 0.0f);
  CHECK(cache.file_of(path, {2, 2, 2}).value() != flat);
  CHECK(cache.load(path, {2, 2, 2}).value()->parts[0].positions[3] == 2.0f);
  folder.mesh(0.5);
  CHECK(cache.file_of(path).value() != flat);
  CHECK(load(cache, path)->parts[0].positions[8] == 0.5f);
  MeshLimits tight;
  tight.triangles = 0;
  CHECK_FALSE(cache.load(path, {1, 1, 1}, tight).ok());
}

TEST_CASE("a damaged, truncated or foreign cache file is made anew") {
  const Folder folder;
  const MeshCache cache(folder.cache());
  const std::string path = folder.mesh(0.25);
  const Sha256 right = mesh_hash(*load(cache, path));
  const std::string file = cache.file_of(path).value();
  const std::string whole = read_file(file).value();
  const auto put = [&file](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  };
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    put(damaged);
    CHECK(mesh_hash(*load(cache, path)) == right);
    CHECK(read_file(file).value() == whole);
    put(whole.substr(0, at));
    CHECK(mesh_hash(*load(cache, path)) == right);
    CHECK(read_file(file).value() == whole);
  }
}

TEST_CASE("a cache that cannot be written costs nothing but time; missing sources fail as ever") {
  const Folder folder;
  std::ofstream(folder.cache()) << "a file where the folder would be";
  const MeshCache cache(folder.cache());
  CHECK(load(cache, folder.mesh(0))->parts.size() == 1);
  const auto missing = cache.load("/no/such/mesh.glb");
  REQUIRE_FALSE(missing.ok());
  CHECK(missing.failure().code == Fault::kAsset);
  CHECK(MeshCache("").load(folder.mesh(0)).ok());
}

TEST_CASE("the cache lies where the environment says; a mesh is shared while somebody holds it") {
  const Folder folder;
  const char* before = std::getenv("VLAPROBE_CACHE");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("VLAPROBE_CACHE", folder.cache().c_str(), 1);
  CHECK(default_mesh_cache() == folder.cache() + "/meshes");
  const std::string path = folder.mesh(0);
  auto first = shared_mesh(path).value();
  CHECK(shared_mesh(path).value() == first);
  CHECK(shared_mesh(path, {2, 2, 2}).value() != first);
  folder.mesh(0.5);
  CHECK(shared_mesh(path).value() != first);
  CHECK(fs::exists(folder.cache() + "/meshes"));
  ::setenv("VLAPROBE_CACHE", "", 1);
  CHECK(default_mesh_cache().empty());
  ::unsetenv("VLAPROBE_CACHE");
  ::setenv("XDG_CACHE_HOME", "/var/x", 1);
  CHECK(default_mesh_cache() == "/var/x/vlaprobe/meshes");
  ::unsetenv("XDG_CACHE_HOME");
  if (before != nullptr) ::setenv("VLAPROBE_CACHE", kept.c_str(), 1);
}

}  // namespace
}  // namespace probe::scene
