#include "compiler/language/rename.h"

#include <algorithm>
#include <set>

#include "compiler/syntax/lexer.h"

namespace probe::language {
namespace {

std::set<std::string> declaring_files(const Snapshot& snapshot, const Symbol& symbol) {
  std::set<std::string> files;
  for (const Place* place : snapshot.index().declarations(symbol))
    files.insert(snapshot.path(place->span.file));
  return files;
}

void add_all(const Snapshot& snapshot, const Symbol& symbol, std::vector<FilePlace>& out) {
  for (const Place* place : snapshot.index().all(symbol)) {
    out.push_back({snapshot.path(place->span.file), snapshot.range(place->span), place->span,
                   place->declares});
  }
}

Result<Symbol> symbol_at(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  const Place* place = snapshot.index().at(file, offset);
  const auto symbol = place == nullptr ? std::nullopt : snapshot.index().symbol(*place);
  if (!symbol) return Failure{Fault::kUsage, "no name is declared of what stands here", ""};
  return *symbol;
}

}  // namespace

std::vector<FilePlace> references(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                                  const std::vector<const Snapshot*>& others) {
  std::vector<FilePlace> out;
  const auto symbol = symbol_at(snapshot, file, offset);
  if (!symbol) return out;
  add_all(snapshot, *symbol, out);
  const std::set<std::string> declared = declaring_files(snapshot, *symbol);
  for (const Snapshot* other : others) {
    if (symbol->kind == Kind::kVariable) break;  // known in its declaration alone
    for (const std::string& path : declaring_files(*other, *symbol)) {
      if (!declared.contains(path)) continue;
      add_all(*other, *symbol, out);
      break;
    }
  }
  std::ranges::sort(out, {}, [](const FilePlace& at) { return std::pair(at.path, at.range); });
  const auto repeated = std::ranges::unique(out, {}, [](const FilePlace& at) {
    return std::pair(at.path, at.range);
  });
  out.erase(repeated.begin(), repeated.end());
  return out;
}

Result<Span> renamed_span(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  PROBE_ASSIGN(const Symbol symbol, symbol_at(snapshot, file, offset));
  const bool is_ours = !snapshot.index().declarations(symbol).empty();
  if (!is_ours && Index::is_built_in(symbol.kind, symbol.name)) {
    return Failure{Fault::kUsage, "`" + symbol.name + "` is a word of the language", ""};
  }
  if (!is_ours) {
    return Failure{Fault::kUsage,
                   std::string(info(symbol.kind).word) + " `" + symbol.name +
                       "` is declared by no text",
                   ""};
  }
  return snapshot.index().at(file, offset)->span;
}

Status check_new_name(const Snapshot& snapshot, FileId file, std::uint32_t offset,
                      const std::string& name) {
  const bool is_name = !name.empty() && syntax::is_letter(name.front()) &&
                       std::ranges::all_of(name, syntax::is_word);
  if (!is_name)
    return Failure{Fault::kUsage,
                   "a name is a letter, then letters, digits and `_`; `" + name + "` is none", ""};
  PROBE_ASSIGN(Symbol symbol, symbol_at(snapshot, file, offset));
  symbol.name = name;
  const bool is_taken = !snapshot.index().declarations(symbol).empty() ||
                        Index::is_built_in(symbol.kind, name);
  if (is_taken)
    return Failure{Fault::kUsage,
                   "there is a " + std::string(info(symbol.kind).word) + " `" + name + "` already",
                   ""};
  return {};
}

std::string new_mistake(const Snapshot& snapshot, const Unsaved& edited, const Setting& setting) {
  const auto after = Snapshot::analysed(snapshot.path(snapshot.root()), edited, setting);
  if (after == nullptr) return {};
  if (after->diagnostics().error_count() <= snapshot.diagnostics().error_count()) return {};
  std::set<std::string> known;
  for (const Diagnostic& item : snapshot.diagnostics().items()) known.insert(item.message);
  for (const Diagnostic& item : after->diagnostics().items()) {
    if (item.severity == Severity::kError && !known.contains(item.message)) return item.message;
  }
  return {};
}

}  // namespace probe::language
