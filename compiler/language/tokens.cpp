#include "compiler/language/tokens.h"

#include <algorithm>
#include <unordered_set>

#include "compiler/syntax/words.h"

namespace probe::language {
namespace {

const std::unordered_set<std::string_view>& all_words() {
  static const std::unordered_set<std::string_view> kWords = [] {
    std::unordered_set<std::string_view> out;
    for (const std::string_view word : syntax::declaration_words()) out.insert(word);
    for (const syntax::StatementWord& word : syntax::statement_words()) out.insert(word.word);
    for (const std::string_view word : syntax::inner_words()) out.insert(word);
    return out;
  }();
  return kWords;
}

}  // namespace

std::uint32_t token_type(std::string_view name) {
  const auto found = std::ranges::find(kTokenTypes, name);
  if (found != kTokenTypes.end()) return static_cast<std::uint32_t>(found - kTokenTypes.begin());
  const auto more = std::ranges::find(kMoreTokenTypes, name);
  return static_cast<std::uint32_t>(kTokenTypes.size()) +
         static_cast<std::uint32_t>(more - kMoreTokenTypes.begin());
}

std::vector<ColouredToken> coloured(const Snapshot& snapshot, FileId id) {
  using syntax::TokenKind;
  const syntax::ParseResult* parsed = snapshot.tree(id);
  if (parsed == nullptr) return {};
  const std::vector<Place>& places = snapshot.index().places(id);
  auto place = places.begin();
  std::vector<ColouredToken> out;
  const auto add = [&](std::uint32_t begin, std::uint32_t end, std::string_view type,
                       std::uint32_t modifiers = 0) {
    if (begin < end) out.push_back({{id, begin, end}, token_type(type), modifiers});
  };
  const auto add_place = [&](const Place& named) {
    const auto symbol = snapshot.index().symbol(named);
    if (!symbol) return;
    const bool is_own = Index::is_built_in(symbol->kind, symbol->name);
    add(named.span.begin, named.span.end, info(symbol->kind).token,
        (named.declares ? kIsDeclaration : 0) | (is_own ? kIsOfLanguage : 0));
  };
  for (const syntax::Token& token : parsed->tokens.tokens) {
    while (place != places.end() && place->span.begin < token.begin) ++place;
    switch (token.kind) {
      case TokenKind::kComment:
      case TokenKind::kDocComment:
        add(token.begin, token.end, "comment");
        break;
      case TokenKind::kNumber:
        add(token.begin, token.end, "number");
        break;
      case TokenKind::kString: {
        // Names in its slots stand out of it.
        std::uint32_t at = token.begin;
        for (; place != places.end() && place->span.end <= token.end; ++place) {
          add(at, place->span.begin, "string");
          add_place(*place);
          at = place->span.end;
        }
        add(at, token.end, "string");
        break;
      }
      case TokenKind::kIdent:
        if (place != places.end() && place->span.begin == token.begin) {
          add_place(*place++);
        } else if (all_words().contains(
                       snapshot.text(id).substr(token.begin, token.end - token.begin))) {
          add(token.begin, token.end, "keyword");
        }
        break;
      default:
        break;
    }
  }
  return out;
}

}  // namespace probe::language
