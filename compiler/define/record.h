// What the records of all constructs have in common: one row a declaration, filled parent first
// where `like` copies one, and statements that must be there.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/names/context.h"
#include "compiler/names/like.h"

namespace probe::sema {

// P0206 unless it is there.
inline void require(Context& context, bool is_there, std::string_view kind, const std::string& name,
                    const Span& span, std::string_view statement) {
  if (is_there) return;
  context.report(Situation::kStatementMissing, span,
                 std::string(kind) + " `" + name + "` has no `" + std::string(statement) + "`");
}

// SI values into a record, where they could be read.
template <std::size_t N>
void assign(std::array<double, N>& to, const std::optional<std::vector<Quantity>>& from) {
  if (!from) return;
  for (std::size_t i = 0; i < from->size() && i < N; ++i) to[i] = (*from)[i].si();
}

// Fills `table` with one record for each of `decls`, copied along `like` before it is read.
// `read(declared, record)` reads the statements; `complete(record, is_read)` then looks at what is
// missing, unless the text was torn or the copied record is broken; `is_read`: no statement was
// reported. A record of which anything was reported is `broken`.
template <typename Id, typename Record, typename Node, typename Read, typename Complete>
void define_records(Context& context, const NameTable& names,
                    const std::vector<Declared<Node>>& decls, Table<Id, Record>& table, Read read,
                    Complete complete) {
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  for (std::size_t i = 0; i < decls.size(); ++i) {
    table.add({});
    if (decls[i].node->like) parents[i] = names.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, names.names())) {
    const Declared<Node>& declared = decls[i];
    bool broken = !declared.decl->complete || (declared.node->like && !parents[i]);
    Record record;
    if (parents[i]) {
      record = table[static_cast<Id>(*parents[i])];
      broken = broken || record.broken;
      if constexpr (requires { record.like; }) record.like = static_cast<Id>(*parents[i]);
    }
    record.name = std::string(declared.node->name.text);
    record.span = declared.node->name.span;
    const std::size_t mistakes = context.mistakes();
    read(declared, record);
    if (!broken) complete(record, context.mistakes() == mistakes);
    record.broken = broken || record.broken || context.mistakes() != mistakes;
    table[static_cast<Id>(i)] = std::move(record);
  }
}

}  // namespace probe::sema
