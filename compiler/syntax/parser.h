// Text to typed tree. Always returns a tree: a mistake is reported once, skipped to the next line
// or `}`, and parsing goes on. Time and memory are linear in the text; recursion stops at
// kMaxDepth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/token.h"

namespace probe::syntax {

// Height of any expression, query, condition or set, so that passes may recurse over them.
inline constexpr std::uint32_t kMaxDepth = 200;
// A file with more syntax errors than this is given up with P0107.
inline constexpr std::uint32_t kMaxSyntaxErrors = 100;

struct ParseResult {
  File file;
  TokenStream tokens;  // lossless: every byte of the file, trivia included
  bool ok = true;      // no error was reported for this file
};

ParseResult parse(const SourceSet& sources, FileId id, Diagnostics& diagnostics);

// The words of the language that the grammar takes in place of the word that begins at `offset`, in
// the order in which it looks for them; for completion. The file is parsed for it.
std::vector<std::string_view> words_at(const SourceSet& sources, FileId id, std::uint32_t offset);

// A root file and everything it uses, each once. `files` is in the order in which names become
// known: a file comes after the files it uses; the root is last.
struct Program {
  std::vector<ParseResult> files;
  bool ok = true;
};

// A `use` is looked up beside the file that names it, then in each of `library_folders`. A file
// that cannot be read is P0202 at its `use`; the root itself that cannot be read is a Failure.
Result<Program> load_program(SourceSet& sources, const std::string& root,
                             const std::vector<std::string>& library_folders,
                             Diagnostics& diagnostics);

}  // namespace probe::syntax
