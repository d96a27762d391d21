// Questions to the file system where a throwing one would end the program.
#include "runtime/base/paths.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace probe {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("probe_paths_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

TEST_CASE("what cannot be asked is answered with no instead of an exception") {
  const Folder folder;
  fs::create_symlink("loop", folder / "loop");
  fs::create_symlink("nowhere", folder / "dangling");
  const std::string long_name(5000, 'n'), null_byte("a\0b", 3);
  for (const std::string& path :
       {folder / "loop", folder / "loop/inside", folder / "dangling", folder / long_name,
        std::string(), null_byte, folder / "absent/deeper"}) {
    CAPTURE(path.substr(0, 60));
    CHECK_FALSE(is_there(path));
    CHECK_FALSE(is_file(path));
    CHECK_FALSE(is_folder(path));
    CHECK_FALSE(is_same(path, path));
    CHECK_FALSE(list_folder(path).ok());
  }
  CHECK(is_link(folder / "dangling"));
}

TEST_CASE("files, folders and what is neither are told apart through links") {
  const Folder folder;
  std::ofstream(folder / "file") << "x";
  fs::create_symlink("file", folder / "link");
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK(is_file(folder / "link"));
  CHECK(is_link(folder / "link"));
  CHECK(is_same(folder / "link", folder / "file"));
  CHECK(is_there(folder / "pipe"));
  CHECK_FALSE(is_file(folder / "pipe"));
  CHECK(is_folder(folder.path.string()));
  CHECK(list_folder(folder.path.string()).value() ==
        std::vector<std::string>{"file", "link", "pipe"});
}

TEST_CASE("folders are made with those above them, and a file in the way is named") {
  const Folder folder;
  REQUIRE(make_lasting_folders(folder / "a/b/c/").ok());
  CHECK(is_folder(folder / "a/b/c"));
  CHECK(make_lasting_folders(folder / "a/b").ok());
  std::ofstream(folder / "file") << "x";
  const Status status = make_folders(folder / "file/below");
  REQUIRE_FALSE(status.ok());
  CHECK(status.failure().code == Fault::kIo);
  CHECK(status.failure().where == folder / "file/below");
  CHECK(status.failure().message == "the folder cannot be made: Not a directory");
  CHECK_FALSE(sync_folder(folder / "absent").ok());
}

TEST_CASE("a path is made absolute without asking for what it leads to") {
  CHECK(absolute_path("/a/./b/../c") == "/a/c");
  CHECK(absolute_path("x/y").ends_with("/x/y"));
}

}  // namespace
}  // namespace probe
