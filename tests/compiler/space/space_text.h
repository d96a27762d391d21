// A text with a space, and what it means.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compiler/diag/text.h"
#include "compiler/emit/analyzed.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::space {

// Analysed where it lies, so that texts beside it may use it.
struct SpaceText {
  run::TemporaryFolder folder;
  std::string file;
  AnalyzedText text;

  const sema::Space& space(std::size_t i = 0) const { return text.model.spaces[i]; }
};

inline AnalyzedText analyzed(const std::string& file) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  auto text = analyze_text(std::span(&file, 1), {.asset_root = root + "/assets",
                                                 .library_folders = {root + "/dsl", root}});
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  INFO(render_text(text->compilation.diagnostics, text->compilation.sources));
  REQUIRE(text->compilation.ok);
  return std::move(text).value();
}

// `body`: behind `use "suite/intact_clean.probe"`.
// `beside`: files that lie beside it.
inline std::unique_ptr<SpaceText> space_text(
    const std::string& body, const std::vector<std::pair<std::string, std::string>>& beside = {}) {
  auto made = std::make_unique<SpaceText>();
  for (const auto& [name, text] : beside) std::ofstream(made->folder / name) << text;
  made->file = made->folder / "mine.probe";
  std::ofstream(made->file) << "use \"" << VLAPROBE_SOURCE_DIR << "/suite/intact_clean.probe\"\n"
                            << body;
  made->text = analyzed(made->file);
  return made;
}

}  // namespace probe::space
