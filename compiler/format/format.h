// The one layout of .probe text. Works on tokens: comments stay, statements joined by `;` stay on
// their line, one blank line stays one, nothing is wider than 120 columns that can be broken.
// Knows how text looks, never what it means.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "compiler/syntax/parser.h"
#include "runtime/base/result.h"

namespace probe::format {

inline constexpr std::uint32_t kWidth = 120;
inline constexpr std::uint32_t kIndent = 2;

// The canonical text of a file that parsed without an error. Formatting the result changes nothing.
// Time and memory are linear in the text.
std::string format(const SourceFile& source, const syntax::TokenStream& stream);

// Whether two files that parsed hold the same words in the same statements: what formatting must
// not change. Comments, blanks and the choice between newline and `;` do not count.
bool says_the_same(const SourceFile& a, const syntax::TokenStream& a_stream, const SourceFile& b,
                   const syntax::TokenStream& b_stream);

// Parses, formats and makes sure that the result says the same. No text when the file has errors:
// they are in `diagnostics`. A Failure (kInternal) is our mistake; the file is then better
// left alone.
Result<std::optional<std::string>> format_file(const SourceSet& sources, FileId id,
                                               Diagnostics& diagnostics);

}  // namespace probe::format
