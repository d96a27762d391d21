#include "compiler/names/uses.h"

#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;

TEST_CASE("a file sees what it uses, and no other file that ends in the same name") {
  SourceSet sources;
  Diagnostics diagnostics;
  sources.add("base.probe", test::kSmallSuite);
  sources.add("a/more.probe",
              "use \"../base.probe\"\nvariant here of red_on_tray { light night }\n");
  sources.add("b/more.probe", "use \"../base.probe\"\nvariant there of red_on_tray { say take }\n");
  sources.add("a/mine.probe", "use \"more.probe\"\nset seen = variants of { red_on_tray }\n");
  sources.add("all.probe", "use \"a/mine.probe\"\nuse \"b/more.probe\"\n");
  const auto program = syntax::load_program(sources, "all.probe", {}, diagnostics);
  REQUIRE(program.ok());
  std::vector<const syntax::File*> files;
  for (const syntax::ParseResult& result : program->files) files.push_back(&result.file);
  const sema::Model model = sema::analyze(sources, files, test::asset_root(), diagnostics);
  REQUIRE(diagnostics.empty());
  REQUIRE(model.sets.size() == 1);
  const std::vector<sema::TaskId>& seen = model.sets[static_cast<sema::SetId>(0)].members;
  REQUIRE(seen.size() == 1);
  CHECK(model.tasks[seen[0]].name == "here");

  const syntax::File& mine = *files[2];
  CHECK(sources.file(mine.id).name() == "a/mine.probe");
  CHECK(sema::visible_files(files, mine).size() == 3);
  CHECK(sema::is_used(files, mine));
  CHECK_FALSE(sema::is_used(files, *files.back()));
}
