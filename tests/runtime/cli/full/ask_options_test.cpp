#include "runtime/cli/full/ask_options.h"

#include <doctest/doctest.h>

#include <fstream>
#include <set>

#include "tests/runtime/run/temporary_folder.h"

namespace probe::cli {
namespace {

// Sets of questions that the text's tasks are asked when that suite is named.
std::set<std::string> asked_by(const std::string& file, const std::string& suite) {
  AskArguments arguments;
  arguments.file = file;
  arguments.suite = suite;
  arguments.tasks = "*";
  arguments.assets.folders = {std::string(VLAPROBE_SOURCE_DIR) + "/assets"};
  arguments.assets.library = std::string(VLAPROBE_SOURCE_DIR) + "/dsl";
  ask::AskOptions options;
  const LoadedPlan loaded = load_asked(arguments, options);
  REQUIRE(loaded.plan);
  std::set<std::string> sets;
  for (const plan::QuestionRecord& question : loaded.plan->questions()) {
    const plan::FamilyRecord& family = loaded.plan->families()[question.family];
    sets.emplace(loaded.plan->text(family.set));
  }
  return sets;
}

}  // namespace

TEST_CASE("a suite of a text is asked its own questions, not those of others with its tasks") {
  run::TemporaryFolder folder;
  const std::string file = folder / "two.probe";
  std::ofstream(file)
      << "use \"" << VLAPROBE_SOURCE_DIR << "/examples/questions.probe\"\n"
      << "questions other { point there \"Point at {the target}.\" answer target }\n"
         "suite second trained on bridge_v2 {\n"
         "  tasks { carrot_on_plate }; seeds 42; questions other\n}\n";
  CHECK(asked_by(file, "second") == std::set<std::string>{"other"});
  CHECK(asked_by(file, "asked") == std::set<std::string>{"grounding"});
  CHECK(asked_by(file, "") == std::set<std::string>{"grounding", "other"});
}

}  // namespace probe::cli
