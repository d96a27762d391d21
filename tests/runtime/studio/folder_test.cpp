#include "runtime/studio/folder.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

using namespace probe;
namespace fs = std::filesystem;
using studio::Folder;

namespace {

struct Place {
  fs::path root = fs::temp_directory_path() / ("studio_folder_" + std::to_string(::getpid()));
  Place() {
    fs::remove_all(root);
    fs::create_directories(root / "in" / "deep");
    fs::create_directories(root / "out");
    write("in/a.probe", "suite a { }\n");
    write("in/deep/b.probe", "");
    write("in/notes.txt", "secret");
    write("out/c.probe", "secret");
  }
  ~Place() { fs::remove_all(root); }
  std::string path(const std::string& name) const { return (root / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(root / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

}  // namespace

TEST_CASE("the page has the texts of the folder and nothing else of the machine") {
  const Place place;
  auto folder = Folder::of(place.path("in/a.probe"));
  REQUIRE(folder);
  CHECK((*folder)->texts() ==
        std::vector<std::string>{place.path("in/a.probe"), place.path("in/deep/b.probe")});
  CHECK((*folder)->open(place.path("in/a.probe"))->text == "suite a { }\n");
  fs::create_symlink(place.path("out/c.probe"), place.path("in/link.probe"));
  fs::create_directory_symlink(place.path("out"), place.path("in/door"));
  for (const std::string& outside :
       {place.path("out/c.probe"), place.path("in/../out/c.probe"), place.path("in/notes.txt"),
        place.path("in/link.probe"), place.path("in/door/c.probe"), std::string("/etc/passwd"),
        std::string("a.probe"), std::string(), place.path("in/a.probe") + std::string(1, '\0'),
        place.path("inside.probe")}) {
    CAPTURE(outside);
    CHECK_FALSE((*folder)->has(outside));
    const auto text = (*folder)->open(outside);
    REQUIRE_FALSE(text);
    CHECK(text.failure().message.find("is no text of the folder") != std::string::npos);
    CHECK_FALSE((*folder)->save(outside, "x", true));
  }
  CHECK(place.read("out/c.probe") == "secret");
  CHECK(place.read("in/notes.txt") == "secret");
}

TEST_CASE("a text that is not there yet is begun and saved") {
  const Place place;
  auto folder = Folder::of(place.path("in/new.probe"));
  REQUIRE(folder);
  const auto text = (*folder)->open((*folder)->file());
  REQUIRE(text);
  CHECK(text->is_new);
  CHECK(text->text.empty());
  CHECK((*folder)->news((*folder)->file()) == Folder::News::kNone);
  CHECK((*folder)->save((*folder)->file(), "suite s { }\n", false));
  CHECK(place.read("in/new.probe") == "suite s { }\n");
  CHECK((*folder)->news((*folder)->file()) == Folder::News::kNone);
}

TEST_CASE("what another program wrote meanwhile is not overwritten in silence") {
  const Place place;
  auto folder = Folder::of(place.path("in/a.probe"));
  REQUIRE(folder);
  const std::string file = (*folder)->file();
  REQUIRE((*folder)->open(file));
  place.write("in/a.probe", "another's\n");
  CHECK((*folder)->news(file) == Folder::News::kChanged);
  const auto refused = (*folder)->save(file, "ours\n", false);
  REQUIRE_FALSE(refused);
  CHECK(refused.failure().message == "was changed on the disk meanwhile");
  CHECK(place.read("in/a.probe") == "another's\n");
  CHECK((*folder)->save(file, "ours\n", true));
  CHECK(place.read("in/a.probe") == "ours\n");
}

TEST_CASE("a file that was deleted while it is open is told and written again when it is wanted") {
  const Place place;
  auto folder = Folder::of(place.path("in/a.probe"));
  REQUIRE(folder);
  const std::string file = (*folder)->file();
  REQUIRE((*folder)->open(file));
  fs::remove(file);
  CHECK((*folder)->news(file) == Folder::News::kGone);
  CHECK_FALSE((*folder)->save(file, "again\n", false));
  CHECK((*folder)->save(file, "again\n", true));
  CHECK(place.read("in/a.probe") == "again\n");
}

TEST_CASE("a table of starts takes a name that nothing has") {
  const Place place;
  auto folder = Folder::of(place.path("in/a.probe"));
  REQUIRE(folder);
  place.write("in/a_kept_1.csv", "another's");
  CHECK((*folder)->keep_table("ours").value() == 2);
  CHECK(place.read("in/a_kept_1.csv") == "another's");
  CHECK(place.read("in/a_kept_2.csv") == "ours");
  fs::create_symlink(place.path("out/new.csv"), place.path("in/a_kept_3.csv"));
  CHECK((*folder)->keep_table("ours").value() == 3);
  CHECK(!fs::exists(place.path("out/new.csv")));
  CHECK(place.read("in/a_kept_3.csv") == "ours");
}

TEST_CASE("what an editor would alter or is too large is refused by name") {
  const Place place;
  auto folder = Folder::of(place.path("in/a.probe"));
  REQUIRE(folder);
  place.write("in/latin.probe", "caf\xe9");
  const auto latin = (*folder)->open(place.path("in/latin.probe"));
  REQUIRE_FALSE(latin);
  CHECK(latin.failure().message == "is no UTF-8, and an editor would alter it");
  place.write("in/large.probe", std::string(Folder::kLargest + 1, ' '));
  CHECK_FALSE((*folder)->open(place.path("in/large.probe")));
  CHECK_FALSE((*folder)->save(place.path("in/a.probe"), std::string(Folder::kLargest + 1, ' '), true));
}

TEST_CASE("a studio is started for a text in a folder that is there") {
  const Place place;
  CHECK(Folder::of(place.path("in/notes.txt")).failure().message ==
        "a text of the studio ends in `.probe`");
  CHECK(Folder::of(place.path("nowhere/a.probe")).failure().message == "its folder is not there");
  fs::create_directory(place.path("in/d.probe"));
  CHECK(Folder::of(place.path("in/d.probe")).failure().message == "is a folder");
  fs::create_symlink(place.path("out/c.probe"), place.path("in/link.probe"));
  CHECK(Folder::of(place.path("in/link.probe")).failure().message ==
        "is a link to a file of another folder");
}
