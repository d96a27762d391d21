#include "compiler/language/rename.h"

#include <algorithm>
#include <set>

#include "compiler/define/role.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/words.h"

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

// Roles, measures, keywords, and the words that stand for bodies.
bool is_word_of_language(std::string_view name) {
  for (std::size_t i = 0; i < kKindCount; ++i) {
    if (Index::is_built_in(static_cast<Kind>(i), name)) return true;
  }
  const std::vector<std::string_view> inner = syntax::inner_words();
  return syntax::is_declaration_word(name) ||
         std::ranges::any_of(syntax::statement_words(),
                             [&](const auto& word) { return word.word == name; }) ||
         std::ranges::find(inner, name) != inner.end() || sema::is_taken_word(name);
}

}  // namespace

Result<Symbol> symbol_at(const Snapshot& snapshot, FileId file, std::uint32_t offset) {
  const Place* place = snapshot.index().at(file, offset);
  const auto symbol = place == nullptr ? std::nullopt : snapshot.index().symbol(*place);
  if (!symbol) return Failure{Fault::kUsage, "no name is declared of what stands here", ""};
  return *symbol;
}

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
  const auto is_same = [](const FilePlace& a, const FilePlace& b) {
    return std::pair(a.path, a.range) == std::pair(b.path, b.range);
  };
  out.erase(std::unique(out.begin(), out.end(), is_same), out.end());
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

Status check_new_name(const Snapshot& snapshot, const Symbol& symbol, const std::string& name) {
  const bool is_name = !name.empty() && syntax::is_letter(name.front()) &&
                       std::ranges::all_of(name, syntax::is_word);
  if (!is_name)
    return Failure{Fault::kUsage,
                   "a name is a letter, then letters, digits and `_`; `" + name + "` is none", ""};
  // Whatever its kind and scope: it would take the name from others, or they from it.
  for (const syntax::ParseResult& file : snapshot.files()) {
    for (const Place& place : snapshot.index().places(file.file.id)) {
      if (place.text != name) continue;
      const std::string where =
          snapshot.path(place.span.file) + ":" +
          std::to_string(snapshot.range(place.span).begin.line + 1);
      const bool is_same = place.declares && place.may_be.has(symbol.kind);
      return Failure{Fault::kUsage,
                     is_same ? "there is a " + std::string(info(symbol.kind).word) + " `" + name +
                                   "` already: " + where
                             : "`" + name + "` stands for something already: " + where,
                     ""};
    }
  }
  if (is_word_of_language(name))
    return Failure{Fault::kUsage, "`" + name + "` is a word of the language", ""};
  // What a `derive` makes is declared by no text.
  if (snapshot.task(name) != nullptr)
    return Failure{Fault::kUsage, "there is a task `" + name + "` already", ""};
  return {};
}

std::string new_mistake(const Snapshot& snapshot, const Symbol& symbol, const std::string& name,
                        const Unsaved& edited, const Setting& setting) {
  const std::string is = "`" + name + "`", was = "`" + symbol.name + "`";
  const auto after = Snapshot::analysed(snapshot.path(snapshot.root()), edited, setting);
  if (after == nullptr) return snapshot.path(snapshot.root()) + " cannot be read";
  std::multiset<std::string> known;
  for (const Diagnostic& item : snapshot.diagnostics().items()) known.insert(item.message);
  for (const Diagnostic& item : after->diagnostics().items()) {
    if (item.severity != Severity::kError) continue;
    // What was wrong with it before is so under its other name.
    std::string before = item.message;
    for (std::size_t at = 0; (at = before.find(is, at)) != before.npos; at += was.size())
      before.replace(at, is.size(), was);
    const auto same = known.find(before);
    if (same == known.end()) return item.message;
    known.erase(same);
  }
  return {};
}

}  // namespace probe::language
