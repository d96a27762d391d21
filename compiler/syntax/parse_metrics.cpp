// Metrics and what they keep of a signal.
#include <algorithm>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::metrics_decl() {
  advance();
  MetricsDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block(any_name, [&] {
    MetricStmt stmt = metric();
    if (!failed_) out.body.push_back(std::move(stmt));
  });
  return out;
}

MetricStmt Parser::metric() {
  MetricStmt out;
  const std::uint32_t begin = mark();
  out.name = name();
  expect(TokenKind::kAssign);
  out.readout = readout();
  out.span = since(begin);
  return out;
}

Readout Parser::readout() {
  Readout out;
  const std::uint32_t begin = mark();
  const auto found = std::ranges::find_if(
      plan::kReadoutTable,
      [this](const plan::ReadoutInfo& info) { return accept_words(info.words); });
  if (found == plan::kReadoutTable.end()) {
    fail_expected("a read-out");
  } else {
    out.kind = found->readout;
  }
  out.kind_span = since(begin);
  out.expr = expr();
  out.span = since(begin);
  return out;
}

}  // namespace probe::syntax
