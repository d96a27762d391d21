#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/words.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/readouts.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

const fs::path kRoot(VLAPROBE_SOURCE_DIR);

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Example {
  std::string heading, text;
};

// The ```probe blocks of a page, each under its last heading.
std::vector<Example> examples_of(const fs::path& page) {
  std::vector<Example> out;
  std::istringstream lines(read(page));
  std::string heading;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (line == "```probe") {
      inside = true;
      out.push_back({heading, ""});
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      out.back().text += line + "\n";
    }
  }
  return out;
}

// Compiled as a file of its own behind the suite, with the assets and the library of the tree.
Compilation compile_text(const std::string& text) {
  const fs::path file =
      fs::temp_directory_path() / ("probe_reference_" + std::to_string(getpid()) + ".probe");
  const bool stands_alone = text.find("use \"") != std::string::npos;
  std::ofstream(file, std::ios::binary)
      << (stands_alone ? "" : "use \"suite/intact.probe\"\n") << text;
  const std::string name = file.string();
  auto result = check(std::span<const std::string>(&name, 1),
                      {.asset_root = (kRoot / "assets").string(),
                       .suite = "",
                       .library_folders = {(kRoot / "dsl").string(), kRoot.string()}});
  fs::remove(file);
  REQUIRE_MESSAGE(result.ok(), to_text(result.failure()));
  return std::move(result).value();
}

}  // namespace

TEST_CASE("every example of the reference and of the library's page compiles") {
  std::vector<Example> examples = examples_of(kRoot / "dsl/reference.md");
  CHECK(examples.size() >= 15);
  for (Example& example : examples_of(kRoot / "dsl/std/README.md"))
    examples.push_back(std::move(example));
  for (const Example& example : examples) {
    const Compilation compilation = compile_text(example.text);
    CHECK_MESSAGE(compilation.ok, example.heading, "\n",
                  render_text(compilation.diagnostics, compilation.sources));
  }
}

TEST_CASE("the reference names every declaration, unit, measure and code") {
  const std::string page = read(kRoot / "dsl/reference.md");
  for (const std::string_view word : syntax::declaration_words())
    CHECK_MESSAGE(page.find(word) != std::string::npos, word);
  for (const syntax::StatementWord& statement : syntax::statement_words())
    CHECK_MESSAGE(page.find(statement.word) != std::string::npos, statement.word);
  for (const plan::ReadoutInfo& readout : plan::kReadoutTable)
    CHECK_MESSAGE(page.find("`" + std::string(readout.words)) != std::string::npos, readout.words);
  for (const plan::AxisInfo& axis : plan::kAxisTable)
    CHECK_MESSAGE(page.find(axis.name) != std::string::npos, axis.name);
  for (const std::string_view unit : {
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) std::string_view(text),
#include "compiler/syntax/units.def"
       }) {
    CHECK_MESSAGE(page.find(unit) != std::string::npos, unit);
  }
  for (const std::string_view measure : {
#define PROBE_MEASURE(id, name, params, result, length, time, angle, mass, of_start, meaning) \
  std::string_view("| `" name),
#include "compiler/model/measures.def"
       }) {
    CHECK_MESSAGE(page.find(measure) != std::string::npos, measure);
  }
  for (const Code code : all_codes()) {
    const std::string text(info(code).text);
    const bool in_range = code > Code::P0401 && code < Code::P0405;  // "P0401-P0405"
    if (in_range) continue;
    CHECK_MESSAGE(page.find(text) != std::string::npos, text);
  }
}

TEST_CASE("the library compiles and shares no name with the suite") {
  std::string all;
  for (const auto& entry : fs::directory_iterator(kRoot / "dsl/std")) {
    if (entry.path().extension() != ".probe") continue;
    all += "use \"std/" + entry.path().filename().string() + "\"\n";
  }
  const Compilation alone = compile_text(all);
  CHECK_MESSAGE(alone.ok, render_text(alone.diagnostics, alone.sources));
  const Compilation both =
      compile_text("use \"suite/intact.probe\"\n" + all +
                   "task with_library like carrot_on_plate { metrics placing; "
                   "say place_on }\nvariant lifted_up of with_library { "
                   "metrics lifting }\nvariant pushed of with_library { "
                   "metrics pushing }\nvariants of with_library {\n"
                   "stacked { metrics stacking }\nfilled { metrics filling }\n"
                   "cleared { metrics clearing; say move_away }\ngone { metrics reaching } }\n");
  CHECK_MESSAGE(both.ok, render_text(both.diagnostics, both.sources));
}

TEST_CASE("the reference lists what the suite declares for others to use") {
  const std::string page = read(kRoot / "dsl/reference.md");
  struct Listed {
    const char* file;
    const char* word;
  };
  for (const Listed& one : {Listed{"catalog", "object"}, Listed{"manipulation", "predicate"},
                            Listed{"manipulation", "metrics"}, Listed{"language", "template"},
                            Listed{"layouts", "layout"}, Listed{"stage", "scene"},
                            Listed{"stage", "light"}}) {
    const std::string file = "suite/" + std::string(one.file) + ".probe";
    const std::size_t from = page.find("s | `" + file + "` | ");
    REQUIRE_MESSAGE(from != std::string::npos, file);
    std::istringstream lines(read(kRoot / file));
    for (std::string line; std::getline(lines, line);) {
      const std::string begin = std::string(one.word) + " ";
      if (!line.starts_with(begin)) continue;
      const std::string name =
          line.substr(begin.size(), line.find_first_of(" ({", begin.size()) - begin.size());
      const bool is_listed = page.find("`" + name + "`", from) != std::string::npos ||
                             page.find("`" + name + "(", from) != std::string::npos;
      CHECK_MESSAGE(is_listed, file << ": " << name);
    }
  }
}
