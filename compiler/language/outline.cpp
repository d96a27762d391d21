#include "compiler/language/outline.h"

#include <algorithm>

namespace probe::language {
namespace {

Kind kind_of(const Place& place) {
  for (std::size_t i = 0; i < kKindCount; ++i) {
    if (place.may_be.has(static_cast<Kind>(i))) return static_cast<Kind>(i);
  }
  return Kind::kVariable;
}

// The words of a declaration before its block or its `=`.
std::string head_of(std::string_view text) {
  text = text.substr(0, std::min(text.find_first_of("{=\n"), text.size()));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  return std::string(text);
}

}  // namespace

std::vector<OutlineItem> outline(const Snapshot& snapshot, FileId id) {
  const syntax::ParseResult* parsed = snapshot.tree(id);
  if (parsed == nullptr) return {};
  const std::vector<Place>& places = snapshot.index().places(id);
  std::vector<OutlineItem> out;
  for (const syntax::Decl& decl : parsed->file.decls) {
    if (std::holds_alternative<syntax::UseDecl>(decl.node)) continue;
    const std::string head = head_of(snapshot.sources().text(decl.span));
    OutlineItem item{head, "", Kind::kTask, decl.span, decl.span, {}};
    if (const auto* derive = std::get_if<syntax::DeriveDecl>(&decl.node)) {
      item.name = derive->name.text.value;
      item.detail = "derive";
      item.at = derive->name.text.span;
    } else if (std::holds_alternative<syntax::FactsDecl>(decl.node)) {
      item.kind = Kind::kFact;
    } else if (const auto* extend = std::get_if<syntax::ExtendDecl>(&decl.node)) {
      item.name = std::string(extend->object.text);
      item.detail = "extend";
      item.kind = Kind::kObject;
      item.at = extend->object.span;
    }
    auto place = std::ranges::lower_bound(places, decl.span.begin, {},
                                          [](const Place& p) { return p.span.begin; });
    for (; place != places.end() && place->span.begin < decl.span.end; ++place) {
      if (!place->declares || place->may_be.has(Kind::kVariable)) continue;
      if (place->whole == decl.span) {
        item.name = std::string(place->text);
        const std::size_t behind = head.find(item.name);
        item.detail = behind == head.npos
                          ? head
                          : head.substr(std::min(behind + item.name.size() + 1, head.size()));
        item.kind = kind_of(*place);
        item.at = place->span;
      } else {
        item.children.push_back(
            {std::string(place->text), "", kind_of(*place), place->whole, place->span, {}});
      }
    }
    if (item.name.empty()) item.name = "(no name)";  // a name may not be empty in the protocol
    out.push_back(std::move(item));
  }
  return out;
}

std::vector<Fold> folds(const Snapshot& snapshot, FileId id) {
  using syntax::TokenKind;
  const syntax::ParseResult* parsed = snapshot.tree(id);
  if (parsed == nullptr) return {};
  const Lines& lines = snapshot.lines(id);
  std::vector<Fold> out;
  std::vector<std::uint32_t> open;
  std::uint32_t first = 0, last = 0;  // of a run of comments
  bool runs = false;
  const auto end_run = [&] {
    if (runs && last > first) out.push_back({first, last, FoldKind::kComment});
    runs = false;
  };
  for (const syntax::Token& token : parsed->tokens.tokens) {
    if (token.kind == TokenKind::kBlank || token.kind == TokenKind::kNewline) continue;
    const std::uint32_t line = lines.position(token.begin).line;
    if (token.kind == TokenKind::kComment || token.kind == TokenKind::kDocComment) {
      if (runs && line == last + 1) {
        last = line;
      } else {
        end_run();
        first = last = line;
        runs = true;
      }
      continue;
    }
    end_run();
    if (token.kind == TokenKind::kLeftBrace) open.push_back(line);
    if (token.kind == TokenKind::kRightBrace && !open.empty()) {
      // The line of the brace stays in sight.
      if (line > open.back() + 1) out.push_back({open.back(), line - 1, FoldKind::kBlock});
      open.pop_back();
    }
  }
  end_run();
  // `use` after `use`.
  std::uint32_t begin = 0, end = 0;
  bool uses = false;
  const auto end_uses = [&] {
    if (uses && end > begin) out.push_back({begin, end, FoldKind::kUses});
    uses = false;
  };
  for (const syntax::Decl& decl : parsed->file.decls) {
    if (!std::holds_alternative<syntax::UseDecl>(decl.node)) {
      end_uses();
      continue;
    }
    end = lines.position(decl.span.begin).line;
    if (!uses) begin = end;
    uses = true;
  }
  end_uses();
  std::ranges::sort(out, {}, [](const Fold& fold) { return std::pair(fold.first, fold.last); });
  return out;
}

}  // namespace probe::language
