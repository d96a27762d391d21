// Links in a folder that somebody sent: nothing is written behind them.
#include "runtime/base/inside.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/folder_kind.h"

namespace probe {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("probe_inside_" + std::to_string(::getpid()));
  Folder() {
    fs::create_directories(path / "run/traces");
    fs::create_directories(path / "other");
    std::ofstream(path / "other/mine") << "mine";
  }
  ~Folder() { fs::remove_all(path); }
  std::string run() const { return (path / "run").string(); }
};

TEST_CASE("a link in the place of a file is taken away, what it points to stays") {
  const Folder folder;
  fs::create_symlink("../other/mine", folder.path / "run/chosen");
  fs::create_symlink("../other/none", folder.path / "run/suite.plan");
  for (const char* name : {"chosen", "suite.plan", "traces/absent/0-0.mp4"}) {
    CAPTURE(name);
    const auto file = file_inside(folder.run(), name);
    REQUIRE(file.ok());
    CHECK(*file == folder.run() + "/" + name);
    CHECK(!is_link(*file));
  }
  CHECK(is_there((folder.path / "other/mine").string()));
}

TEST_CASE("a link in the place of a folder on the way is refused by name") {
  const Folder folder;
  fs::create_symlink("../other", folder.path / "run/videos");
  const auto file = file_inside(folder.run(), "videos/task/0-0.mp4");
  REQUIRE(!file.ok());
  CHECK(file.failure().code == Fault::kIo);
  CHECK(file.failure().where == folder.run() + "/videos");
  CHECK(file.failure().message.starts_with("is a link: what is written here would land"));
  CHECK(!check_inside(folder.run(), "videos").ok());
  CHECK(check_inside(folder.run(), "traces/task").ok());
}

TEST_CASE("the folder itself may be a link, as somebody named it") {
  const Folder folder;
  fs::create_symlink("run", folder.path / "named");
  CHECK(file_inside((folder.path / "named").string(), "traces/x").ok());
}

TEST_CASE("no link lies in a folder that has files of ours alone") {
  const Folder folder;
  CHECK(check_all_inside(folder.run(), "traces").ok());
  CHECK(check_all_inside(folder.run(), "absent").ok());
  fs::create_symlink("nowhere", folder.path / "run/traces/log");
  const Status status = check_all_inside(folder.run(), "traces");
  REQUIRE(!status.ok());
  CHECK(status.failure().where == folder.run() + "/traces/log");
}

TEST_CASE("a folder holds a run, a model's answers or a search, and no two of them") {
  const Folder folder;
  CHECK(check_holds_no_other(folder.run(), FolderKind::kRun).ok());
  std::ofstream(folder.path / "run/search.json") << "{}";
  CHECK(check_holds_no_other(folder.run(), FolderKind::kSearch).ok());
  for (const auto& [kind, words] :
       {std::pair{FolderKind::kRun, "a run"}, std::pair{FolderKind::kAnswers, "answers"},
        std::pair{FolderKind::kSweep, "a sweep"}}) {
    const Status status = check_holds_no_other(folder.run(), kind);
    REQUIRE(!status.ok());
    CHECK(status.failure().message ==
          std::string("holds a search; take another folder for ") + words);
  }
  for (std::size_t i = 0; i < folder_table().size(); ++i)
    CHECK(static_cast<std::size_t>(folder_table()[i].kind) == i);
}

}  // namespace
}  // namespace probe
