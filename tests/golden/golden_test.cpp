#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "compiler/diag/essays.h"
#include "compiler/diag/text.h"
#include "tests/golden/golden.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

// Works in another folder for a while.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
    fs::current_path(folder);
  }
  ~WorkingFolder() { fs::current_path(before_); }

 private:
  fs::path before_;
};

bool wants_update() { return std::getenv("VLAPROBE_UPDATE_GOLDEN") != nullptr; }

// The text with all replacements made, from the back.
std::string apply(std::string text, std::vector<Replacement> replacements) {
  std::sort(replacements.begin(), replacements.end(),
            [](const Replacement& a, const Replacement& b) { return a.span.begin > b.span.begin; });
  for (const Replacement& replacement : replacements) {
    text.replace(replacement.span.begin, replacement.span.size(), replacement.text);
  }
  return text;
}

// Codes that nothing emits yet. Empty when the language is whole.
const std::set<Code> kNotEmittedYet = {};

// A guard against a gap in the compiler's own list of axes: no text leads to it; the tests of the
// emitter hold it.
bool has_no_text(Code code) { return code == Code::P0704; }

}  // namespace

TEST_CASE("every golden text gets the diagnostics and listings that stand behind it") {
  const WorkingFolder folder(test::kGoldenFolder);
  for (const fs::path& path : test::golden_files()) {
    const std::string name = path.filename().string();
    const std::string wanted = test::read_whole(name), found = test::with_expectations(name);
    if (wants_update() && wanted != found) {
      test::write_whole(name, found);
      MESSAGE("rewritten: ", name);
      continue;
    }
    CHECK_MESSAGE(found == wanted, name, " (tests/golden/run --update rewrites it)");
  }
}

TEST_CASE("every code has its row, its essay and its golden text") {
  const WorkingFolder folder(test::kGoldenFolder);
  std::set<Code> held;
  for (const fs::path& path : test::golden_files()) {
    const std::string text = test::read_whole(path.filename());
    for (const Code code : all_codes()) {
      const std::string mark = "[" + std::string(info(code).text) + "] ";
      const bool expected = text.find("#! error" + mark) != std::string::npos ||
                            text.find("#! warning" + mark) != std::string::npos;
      const bool is_its_own = path.filename().string().starts_with(info(code).text);
      if (expected && is_its_own) held.insert(code);
    }
  }
  for (const Code code : all_codes()) {
    const std::string name(info(code).text);
    CHECK_MESSAGE(!info(code).title.empty(), name);
    const std::string head = "# " + name + ": " + std::string(info(code).title) + "\n";
    CHECK_MESSAGE(essay(code).starts_with(head), name, ": no essay dsl/errors/", name, ".md");
    CHECK_MESSAGE(std::count(essay(code).begin(), essay(code).end(), '\n') >= 8, name);
    CHECK_MESSAGE((has_no_text(code) || essay(code).find("```") != std::string::npos), name);
    if (has_no_text(code)) continue;
    if (kNotEmittedYet.contains(code)) {
      CHECK_MESSAGE(!held.contains(code), name, " is emitted: take it off the list");
    } else {
      CHECK_MESSAGE(held.contains(code), name, ": no tests/golden/", name, "*.probe that shows it");
    }
  }
}

TEST_CASE("every fix that a golden text is offered repairs it") {
  const fs::path copy =
      fs::temp_directory_path() / ("probe_fixes_" + std::to_string(getpid())) / "tests/golden";
  fs::create_directories(copy.parent_path());
  fs::copy(test::kGoldenFolder, copy, fs::copy_options::recursive);
  fs::create_directory_symlink(fs::path(VLAPROBE_SOURCE_DIR) / "suite",
                               copy.parent_path().parent_path() / "suite");
  std::size_t fixes = 0;
  {
    const WorkingFolder folder(copy);
    for (const fs::path& path : test::golden_files()) {
      const std::string name = path.filename().string();
      const Compilation before = test::compile_here(name);
      std::vector<Replacement> replacements;
      std::size_t fixed = 0;
      for (const Diagnostic& item : before.diagnostics.items()) {
        if (!item.fix || before.sources.file(item.primary.file).name() != name) continue;
        ++fixed;
        replacements.insert(replacements.end(), item.fix->replacements.begin(),
                            item.fix->replacements.end());
      }
      if (fixed == 0) continue;
      test::write_whole(name, apply(test::read_whole(name), replacements));
      const Compilation after = test::compile_here(name);
      CHECK_MESSAGE(after.diagnostics.size() <= before.diagnostics.size() - fixed, name, "\n",
                    render_text(after.diagnostics, after.sources));
      if (fixed == before.diagnostics.size()) CHECK_MESSAGE(after.ok, name);
      fixes += fixed;
    }
  }
  fs::remove_all(copy.parent_path().parent_path());
  CHECK(fixes >= 5);
}
