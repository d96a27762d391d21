// libFuzzer over the parser, the formatter and the checker: any bytes give a tree, a layout that is
// a fixed point, and diagnostics whose spans lie in the text. A text with a `use` is checked
// together with the suite's world.
// links: probe_compiler_format probe_compiler_check
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/analyze.h"
#include "compiler/diag/text.h"
#include "compiler/format/format.h"
#include "compiler/syntax/parser.h"

using namespace probe;

namespace {

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "source_fuzz: %s\n", what);
  std::abort();
}

const std::vector<std::string>& world() {
  static const std::vector<std::string> texts = [] {
    std::vector<std::string> out;
    for (const char* name : {"catalog", "stage", "layouts", "manipulation", "language"}) {
      std::ifstream stream(std::string(VLAPROBE_SOURCE_DIR "/suite/") + name + ".probe",
                           std::ios::binary);
      std::ostringstream text;
      text << stream.rdbuf();
      out.push_back(text.str());
    }
    return out;
  }();
  return texts;
}

void check_layout(const SourceSet& sources, FileId id) {
  Diagnostics diagnostics;
  const auto once = format::format_file(sources, id, diagnostics);
  if (!once) fail("formatting changes what the text says");
  if (!*once) return;
  SourceSet again;
  const auto twice = format::format_file(again, again.add("fuzz.probe", **once), diagnostics);
  if (!twice || !*twice || **twice != **once) fail("formatting twice changes the text");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SourceSet sources;
  Diagnostics diagnostics;
  std::vector<syntax::ParseResult> files;
  std::string text(reinterpret_cast<const char*>(data), size);
  if (text.find("use \"") != std::string::npos) {
    for (const std::string& part : world()) {
      files.push_back(syntax::parse(sources, sources.add("world.probe", part), diagnostics));
    }
  }
  const FileId id = sources.add("fuzz.probe", std::move(text));
  files.push_back(syntax::parse(sources, id, diagnostics));
  if (syntax::to_text(files.back().tokens, sources) != sources.file(id).text()) {
    fail("the tokens do not give the text back");
  }
  check_layout(sources, id);
  std::vector<const syntax::File*> trees;
  for (const syntax::ParseResult& file : files) trees.push_back(&file.file);
  sema::analyze(sources, trees, VLAPROBE_SOURCE_DIR "/assets", diagnostics);
  for (const Diagnostic& item : diagnostics.items()) {
    const std::size_t end = sources.file(item.primary.file).text().size();
    if (item.primary.begin > item.primary.end || item.primary.end > end)
      fail("a span out of its file");
  }
  if (render_text(diagnostics, sources).empty() != diagnostics.empty()) fail("nothing drawn");
  return 0;
}
