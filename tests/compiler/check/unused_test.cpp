#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

TEST_CASE("what a file of tasks declares and never mentions is pointed out, a catalogue is not") {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId library = sources.add("library.probe", test::kSmallSuite);
  const FileId tasks = sources.add("tasks.probe", R"(use "library.probe"
template spare "take {source}"
template used "take {source} to {target}"
predicate lonely(o: object) = height(o) > 1m
object third like red { phrase odd appearance "strange thing" means color red }
# a comment that names third and lonely is no use
task t like red_on_tray { say used }
)");
  const auto program = syntax::load_program(sources, "tasks.probe", {}, diagnostics);
  REQUIRE(program.ok());
  REQUIRE(program->files.front().file.id == library);
  sema::analyze(sources, {&program->files[0].file, &program->files[1].file}, test::asset_root(),
                diagnostics, {tasks});
  std::string said;
  for (const Diagnostic& item : diagnostics.items())
    said += std::string(info(item.code).text) + " " + item.message + "\n";
  CHECK(said ==
        "P0205 template `spare` is never used\nP0205 predicate `lonely` is never used\n"
        "P0205 object `third` is never used\nP0205 phrase `odd` is never used\n");
}
