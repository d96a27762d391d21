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
    MetricStmt stmt = text_ahead(1) == "when" ? ends() : metric();
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

// `ends when CONDITION`: a metric that is called so itself.
MetricStmt Parser::ends() {
  MetricStmt out;
  const std::uint32_t begin = mark();
  expect_word("ends");
  expect_word("when");
  out.readout.kind = plan::Readout::kEnds;
  out.readout.kind_span = since(begin);
  out.name.text = plan::kEndsMetric;
  out.name.span = out.readout.kind_span;
  out.readout.expr = expr();
  out.span = out.readout.span = since(begin);
  return out;
}

Readout Parser::readout() {
  Readout out;
  const std::uint32_t begin = mark();
  const auto found =
      std::ranges::find_if(plan::kReadoutTable, [this](const plan::ReadoutInfo& info) {
        // What ends an episode has no name of its own to stand behind.
        return info.readout != plan::Readout::kEnds && accept_words(info.words);
      });
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
