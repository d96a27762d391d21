#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"

using namespace probe;

namespace {

// What is said of tasks of the kitchen, each warning and error as its code and message.
std::string said(const std::string& tasks) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_early_end_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << "use \"suite/kitchen.probe\"\n" << tasks;
  const std::string name = file.string();
  std::string both[2];
  for (const bool builds : {false, true}) {
    const CompileOptions options = {
        .asset_root = root + "/assets", .suite = "", .library_folders = {root + "/dsl", root}};
    const auto made = builds ? build({&name, 1}, options) : check({&name, 1}, options);
    REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
    CHECK(made->plan.empty() == !builds);
    for (const Diagnostic& item : made->diagnostics.items())
      both[builds] += std::string(info(item.code).text) + " " + item.message + "\n";
  }
  std::filesystem::remove(file);
  CHECK(both[0] == both[1]);
  return both[0];
}

const std::string kShut =
    "metrics shut like done_place { success = at end (stowed(source, target) and "
    "closed(cabinet.top_drawer)) }\n";

}  // namespace

TEST_CASE("a copied end of the episode that comes before a replaced success is told") {
  CHECK(said(kShut + "task v like carrot_away { metrics shut }") ==
        "P0608 `ends when` of `v` ends the episode before `success` can be true: it holds after "
        "`open cabinet.top_drawer; put carrot in cabinet.inside_top`, with `close "
        "cabinet.top_drawer` still to be done\n");
  CHECK(said(kShut + "task v like carrot_away { metrics shut; solution none }") ==
        "P0608 `ends when` of `v` ends the episode before `success` can be true: it holds after "
        "`open cabinet.top_drawer; put carrot in cabinet.inside_top`, with `close "
        "cabinet.top_drawer` still to be done\n");
}

TEST_CASE("what ends an episode with success, or never before it, is right") {
  CHECK(said("task v like carrot_away { horizon 30s }") == "");
  CHECK(said("metrics shut like done_place { success = at end (closed(cabinet.top_drawer) and "
             "stowed(source, target)); ends when stowed(source, target) and "
             "closed(cabinet.top_drawer) }\ntask v like carrot_away { metrics shut }") == "");
  // An episode that ends for another reason.
  CHECK(said("metrics kept like done_place { ends when height(source) > 2m }\n"
             "task v like carrot_in_the_drawer { metrics kept }") == "");
}
