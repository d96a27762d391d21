// Data sets: what a policy was trained on.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::dataset_decl() {
  static constexpr Rule<RelationsStmt> kRules[] = {
#define PROBE_IN_DATASET(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  DatasetDecl out;
  out.name = name();
  out.title = string();
  if (!at(TokenKind::kLeftBrace)) return out;
  out.body = body<RelationsStmt>(kRules, "a statement of `dataset`");
  return out;
}

RelationsStmt Parser::dataset_relations() {
  RelationsStmt out;
  out.relations = comma_list([this] {
    Relation relation;
    const std::uint32_t begin = mark();
    relation.subject = name();
    relation.preposition = name();
    relation.object = name();
    relation.span = since(begin);
    return relation;
  });
  return out;
}

}  // namespace probe::syntax
