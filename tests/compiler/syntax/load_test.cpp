#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "compiler/diag/text.h"
#include "compiler/syntax/parser.h"

using namespace probe;
using namespace probe::syntax;

namespace {

// A folder of small files that is removed again.
struct Folder {
  std::filesystem::path path;

  explicit Folder(const std::string& name) : path(std::filesystem::temp_directory_path() / name) {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

}  // namespace

TEST_CASE("used files come before those that use them, each once, circles included") {
  const Folder folder("probe_load_test_a");
  const std::string root =
      folder.write("root.probe", "use \"sub/a.probe\"\nuse \"./b.probe\"\nset r = tasks\n");
  folder.write("sub/a.probe", "use \"../b.probe\"\nset a = tasks\n");
  folder.write("b.probe", "use \"root.probe\"\nset b = tasks\n");
  SourceSet sources;
  Diagnostics diagnostics;
  const Result<Program> program = load_program(sources, root, {}, diagnostics);
  REQUIRE(program.ok());
  CHECK(diagnostics.empty());
  CHECK(program->ok);
  REQUIRE(program->files.size() == 3);
  const auto name = [&](std::size_t i) {
    return std::filesystem::path(sources.file(program->files[i].file.id).name())
        .filename()
        .string();
  };
  CHECK(name(0) == "b.probe");
  CHECK(name(1) == "a.probe");
  CHECK(name(2) == "root.probe");
}

TEST_CASE("a file is looked up in the library folders when it is not beside the user") {
  const Folder folder("probe_load_test_b");
  const std::string root = folder.write("user/root.probe", "use \"std/judge.probe\"\n");
  folder.write("lib/std/judge.probe", "set b = tasks\n");
  SourceSet sources;
  Diagnostics diagnostics;
  const Result<Program> program =
      load_program(sources, root, {(folder.path / "lib").string()}, diagnostics);
  REQUIRE(program.ok());
  CHECK(program->ok);
  CHECK(program->files.size() == 2);
}

TEST_CASE("a missing used file is P0202 at its use and the rest is still read") {
  const Folder folder("probe_load_test_c");
  const std::string root =
      folder.write("root.probe", "use \"gone.probe\"\nuse \"\"\nset a = tasks\n");
  SourceSet sources;
  Diagnostics diagnostics;
  const Result<Program> program = load_program(sources, root, {}, diagnostics);
  REQUIRE(program.ok());
  CHECK(!program->ok);
  REQUIRE(diagnostics.size() == 2);
  const Diagnostic& error = diagnostics.items()[0];
  CHECK(error.code == Code::P0202);
  CHECK(error.message == "cannot use `gone.probe`");
  CHECK(error.primary_label == "cannot read: No such file or directory");
  CHECK(diagnostics.items()[1].primary_label == "the name is empty");
  CHECK(program->files[0].file.decls.size() == 3);
}

TEST_CASE("a missing root is a failure of the outside") {
  SourceSet sources;
  Diagnostics diagnostics;
  const Result<Program> program = load_program(sources, "/nowhere/x.probe", {}, diagnostics);
  REQUIRE(!program.ok());
  CHECK(program.failure().where == "/nowhere/x.probe");
}

TEST_CASE("a syntax error in a used file makes the program not ok") {
  const Folder folder("probe_load_test_d");
  const std::string root = folder.write("root.probe", "use \"bad.probe\"\nset a = tasks\n");
  folder.write("bad.probe", "set =\n");
  SourceSet sources;
  Diagnostics diagnostics;
  const Result<Program> program = load_program(sources, root, {}, diagnostics);
  REQUIRE(program.ok());
  CHECK(!program->ok);
  CHECK(diagnostics.error_count() == 1);
}
