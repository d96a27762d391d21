#include "compiler/language/signature.h"

#include <algorithm>

#include "compiler/model/measures.h"

namespace probe::language {
namespace {

using syntax::TokenKind;

std::string_view kind_of(char param) {
  switch (param) {
    case 'B':
      return "body";
    case 'O':
      return "object";
    case 'P':
      return "point";
    case 'V':
      return "vector";
    case 'R':
      return "number";
    case 'J':
      return "joint";
    case 'G':
      return "region";
    case 'F':
      return "body or region";
    case 'C':
      return "condition";
    default:
      return "value";
  }
}

Signature of_measure(const sema::MeasureInfo& measure) {
  Signature out;
  out.label = std::string(measure.name) + "(";
  for (const char param : measure.params) {
    if (!out.parameters.empty()) out.label += ", ";
    const std::size_t begin = out.label.size();
    out.label += kind_of(param);
    out.parameters.emplace_back(begin, out.label.size());
  }
  out.label += ")";
  out.documentation = std::string(measure.meaning);
  return out;
}

Signature of_predicate(const Snapshot& snapshot, const syntax::Decl& decl,
                       const syntax::PredicateDecl& node) {
  Signature out;
  out.label = std::string(node.name.text) + "(";
  for (const syntax::Param& param : node.params) {
    if (!out.parameters.empty()) out.label += ", ";
    const std::size_t begin = out.label.size();
    out.label += snapshot.sources().text(param.span);
    out.parameters.emplace_back(begin, out.label.size());
  }
  out.label += ")";
  for (const std::string_view line : decl.docs) {
    if (!out.documentation.empty()) out.documentation += '\n';
    out.documentation += line;
  }
  return out;
}

}  // namespace

std::optional<Signature> signature_of(const Snapshot& snapshot, std::string_view callee) {
  for (const syntax::ParseResult& file : snapshot.files()) {
    for (const syntax::Decl& decl : file.file.decls) {
      const auto* node = std::get_if<syntax::PredicateDecl>(&decl.node);
      if (node != nullptr && node->name.text == callee) return of_predicate(snapshot, decl, *node);
    }
  }
  for (const sema::MeasureInfo& measure : sema::all_measures()) {
    if (measure.name == callee) return of_measure(measure);
  }
  return std::nullopt;
}

std::optional<Call> call_at(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  const syntax::ParseResult* parsed = snapshot.tree(file);
  if (parsed == nullptr) return std::nullopt;
  const auto& tokens = parsed->tokens.tokens;
  // Backwards from the place: commas at its own level, until a `(` behind a name opens it.
  std::size_t depth = 0, commas = 0;
  auto at = std::ranges::lower_bound(tokens, offset, {}, &syntax::Token::begin) - tokens.begin();
  while (at-- > 0) {
    const syntax::Token& token = tokens[static_cast<std::size_t>(at)];
    if (token.kind == TokenKind::kComma && depth == 0) ++commas;
    if (token.kind == TokenKind::kLeftBrace && depth == 0) return std::nullopt;
    if (token.kind == TokenKind::kRightParen || token.kind == TokenKind::kRightBrace) ++depth;
    if (token.kind == TokenKind::kLeftBrace) --depth;
    if (token.kind != TokenKind::kLeftParen) continue;
    if (depth > 0) {
      --depth;
      continue;
    }
    if (at == 0 || tokens[static_cast<std::size_t>(at - 1)].kind != TokenKind::kIdent) {
      commas = 0;  // a vector or a grouping within a call
      continue;
    }
    const syntax::Token& name = tokens[static_cast<std::size_t>(at - 1)];
    auto signature =
        signature_of(snapshot, snapshot.text(file).substr(name.begin, name.end - name.begin));
    if (!signature) return std::nullopt;
    const std::size_t most = signature->parameters.empty() ? 0 : signature->parameters.size() - 1;
    return Call{std::move(*signature), std::min(commas, most)};
  }
  return std::nullopt;
}

}  // namespace probe::language
