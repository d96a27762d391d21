// A text as tree-sitter reads it, for the tests of this folder.
#pragma once

#include <doctest/doctest.h>
#include <tree_sitter/api.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/parser.h"

extern "C" const TSLanguage* tree_sitter_probe(void);

namespace probe::test {

namespace fs = std::filesystem;
inline const fs::path kRoot = VLAPROBE_SOURCE_DIR;
inline const fs::path kGrammar = kRoot / "dsl/editor/tree-sitter";

inline std::string text_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Every text of the tree, the tests' inputs among them; not what builds leave.
inline std::vector<fs::path> all_texts() {
  std::vector<fs::path> out;
  for (const char* part : {"suite", "examples", "dsl", "tests", "assets"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / part)) {
      if (entry.path().extension() == ".probe") out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

inline std::string in_tree(const fs::path& path) {
  return fs::relative(path, kRoot).generic_string();
}

struct Lines {
  std::uint32_t first, last;  // from 1
};

class Tree {
 public:
  explicit Tree(std::string_view text) : Tree(text, nullptr) {}
  // `before` has been told of the edit.
  Tree(std::string_view text, const Tree& before) : Tree(text, before.tree_.get()) {}

  TSNode root() const { return ts_tree_root_node(tree_.get()); }
  bool has_error() const { return ts_node_has_error(root()); }
  void edit(const TSInputEdit& edit) { ts_tree_edit(tree_.get(), &edit); }

  std::string shape() const {
    const std::unique_ptr<char, decltype(&std::free)> text(ts_node_string(root()), &std::free);
    return text.get();
  }

  // Of nodes that are mistakes or were put in where something is missing.
  std::vector<Lines> mistakes() const {
    std::vector<Lines> out;
    std::function<void(TSNode)> look = [&](TSNode node) {
      if (!ts_node_has_error(node)) return;
      const bool is_mistake =
          ts_node_is_missing(node) || std::string_view(ts_node_type(node)) == "ERROR";
      const std::size_t before = out.size();
      for (std::uint32_t i = 0; !is_mistake && i < ts_node_child_count(node); ++i)
        look(ts_node_child(node, i));
      if (out.size() == before)
        out.push_back({ts_node_start_point(node).row + 1, ts_node_end_point(node).row + 1});
    };
    look(root());
    return out;
  }

 private:
  Tree(std::string_view text, const TSTree* before) : tree_(nullptr, &ts_tree_delete) {
    const std::unique_ptr<TSParser, decltype(&ts_parser_delete)> parser(ts_parser_new(),
                                                                        &ts_parser_delete);
    REQUIRE(ts_parser_set_language(parser.get(), tree_sitter_probe()));
    tree_.reset(ts_parser_parse_string(parser.get(), before, text.data(),
                                       static_cast<std::uint32_t>(text.size())));
    REQUIRE(tree_ != nullptr);
  }

  std::unique_ptr<TSTree, decltype(&ts_tree_delete)> tree_;
};

// What the compiler's parser says of the same text.
struct Said {
  std::uint32_t line;
  Code code;
  std::string message;
};
inline std::vector<Said> said_of(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("t.probe", text);
  syntax::parse(sources, id, diagnostics);
  std::vector<Said> out;
  for (const Diagnostic* item : diagnostics.in_source_order()) {
    out.push_back(
        {sources.file(id).line_column(item->primary.begin).line, item->code, item->message});
  }
  return out;
}

}  // namespace probe::test
