// What an editor does at a keystroke with the grammar for tree-sitter, beside the compiler's parser
// on the same text.
#include <benchmark/benchmark.h>
#include <tree_sitter/api.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "compiler/syntax/parser.h"

extern "C" const TSLanguage* tree_sitter_probe(void);

namespace {

using namespace probe;

std::string read(const char* path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

const std::string& beyond() {
  static const std::string kText = read(VLAPROBE_SOURCE_DIR "/suite/beyond.probe");
  return kText;
}

TSTree* parsed(TSParser* parser, const TSTree* before, const std::string& text) {
  return ts_parser_parse_string(parser, before, text.data(),
                                static_cast<std::uint32_t>(text.size()));
}

void tree_sitter_whole(benchmark::State& state) {
  TSParser* parser = ts_parser_new();
  ts_parser_set_language(parser, tree_sitter_probe());
  for (auto _ : state) ts_tree_delete(parsed(parser, nullptr, beyond()));
  ts_parser_delete(parser);
}
BENCHMARK(tree_sitter_whole);

// A letter more in a name in the middle of the text.
void tree_sitter_keystroke(benchmark::State& state) {
  TSParser* parser = ts_parser_new();
  ts_parser_set_language(parser, tree_sitter_probe());
  const std::string before = beyond();
  const auto at = static_cast<std::uint32_t>(before.find("to_plate", before.size() / 2));
  std::string behind = before;
  behind.insert(at, "x");
  TSTree* tree = parsed(parser, nullptr, before);
  const auto line =
      static_cast<std::uint32_t>(std::count(before.begin(), before.begin() + at, '\n'));
  const auto column = static_cast<std::uint32_t>(at - before.rfind('\n', at) - 1);
  const TSInputEdit edit{at, at, at + 1, {line, column}, {line, column}, {line, column + 1}};
  for (auto _ : state) {
    TSTree* typed = ts_tree_copy(tree);
    ts_tree_edit(typed, &edit);
    TSTree* next = parsed(parser, typed, behind);
    ts_tree_delete(typed);
    ts_tree_delete(next);
  }
  ts_tree_delete(tree);
  ts_parser_delete(parser);
}
BENCHMARK(tree_sitter_keystroke);

void compiler_whole(benchmark::State& state) {
  for (auto _ : state) {
    SourceSet sources;
    Diagnostics diagnostics;
    const FileId id = sources.add("beyond.probe", beyond());
    benchmark::DoNotOptimize(syntax::parse(sources, id, diagnostics));
  }
}
BENCHMARK(compiler_whole);

}  // namespace
