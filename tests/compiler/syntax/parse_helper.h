// A parsed text with its diagnostics, for the tests of this folder.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <variant>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/parser.h"

namespace probe::syntax {

struct Parsed {
  SourceSet sources;
  Diagnostics diagnostics;
  ParseResult result;

  explicit Parsed(std::string text) {
    const FileId id = sources.add("t.probe", std::move(text));
    result = parse(sources, id, diagnostics);
    CHECK(to_text(result.tokens, sources) == sources.file(id).text());
    CHECK(result.ok == !diagnostics.has_errors());
  }

  const File& file() const { return result.file; }
  const Decl& decl(std::size_t n) const {
    REQUIRE(n < result.file.decls.size());
    return result.file.decls[n];
  }
  template <typename Node>
  const Node& get(std::size_t n = 0) const {
    REQUIRE(std::holds_alternative<Node>(decl(n).node));
    return std::get<Node>(decl(n).node);
  }
  std::string_view text(const Span& span) const { return sources.text(span); }

  // "line:column code message", one a line.
  std::string messages() const {
    std::string out;
    for (const Diagnostic* item : diagnostics.in_source_order()) {
      const LineColumn place = sources.file(item->primary.file).line_column(item->primary.begin);
      out += std::to_string(place.line) + ":" + std::to_string(place.column) + " " +
             std::string(info(item->code).text) + " " + item->message + "\n";
    }
    return out;
  }
};

template <typename Statement, typename Variant>
const Statement& as(const Variant& statement) {
  REQUIRE(std::holds_alternative<Statement>(statement));
  return std::get<Statement>(statement);
}

}  // namespace probe::syntax
