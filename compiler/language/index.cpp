#include "compiler/language/index.h"

#include <algorithm>

#include "compiler/model/measures.h"

namespace probe::language {
namespace {

bool fits(const Place& declared, Kind kind, const Place& place) {
  if (!declared.may_be.has(kind)) return false;
  // A value is of its attribute; of an unknown one none.
  return kind != Kind::kValue || declared.of == place.of;
}

bool covers(const Span& span, const Place& place) { return is_within(place.span, span); }

}  // namespace

Index::Index(std::span<const syntax::ParseResult> files) {
  for (const syntax::ParseResult& file : files)
    files_.emplace_back(file.file.id, names_in(file.file));
  for (const auto& [id, places] : files_) {
    for (const Place& place : places) {
      if (place.declares) declarations_[place.text].push_back(&place);
    }
  }
}

const std::vector<Place>& Index::places(FileId file) const {
  static const std::vector<Place> kNone;
  for (const auto& [id, places] : files_) {
    if (id == file) return places;
  }
  return kNone;
}

const Place* Index::at(FileId file, std::uint32_t offset) const {
  const std::vector<Place>& all = places(file);
  // Names do not overlap; of two that touch, as in `a.b`, there is always a sign between.
  const auto found = std::ranges::find_if(all, [&](const Place& place) {
    return place.span.begin <= offset && offset <= place.span.end;
  });
  return found == all.end() ? nullptr : &*found;
}

bool Index::is_built_in(Kind kind, std::string_view name) {
  if (kind == Kind::kRole)
    return name == "source" || name == "target" || name == "distractors" || name == "bodies";
  if (kind != Kind::kMeasure) return false;
  return std::ranges::any_of(sema::all_measures(), [&](const sema::MeasureInfo& measure) {
    return measure.name == name;
  });
}

// Of several the innermost.
const Place* Index::variable(const Place& place) const {
  const auto named = declarations_.find(place.text);
  if (named == declarations_.end()) return nullptr;
  const Place* best = nullptr;
  for (const Place* declared : named->second) {
    if (!declared->may_be.has(Kind::kVariable) || !covers(declared->scope, place)) continue;
    if (best == nullptr || declared->scope.size() <= best->scope.size()) best = declared;
  }
  return best;
}

bool Index::is_declared(Kind kind, const Place& place) const {
  if (is_built_in(kind, place.text)) return true;
  const auto named = declarations_.find(place.text);
  return named != declarations_.end() &&
         std::ranges::any_of(named->second,
                             [&](const Place* declared) { return fits(*declared, kind, place); });
}

std::optional<Symbol> Index::symbol(const Place& place) const {
  // Behind an attribute stands its value, whatever object is called so.
  if (place.may_be.has(Kind::kValue) && is_declared(Kind::kValue, place))
    return Symbol{Kind::kValue, std::string(place.text), std::string(place.of), {}};
  for (std::size_t i = 0; i < kKindCount; ++i) {
    const auto kind = static_cast<Kind>(i);
    if (!place.may_be.has(kind)) continue;
    if (kind == Kind::kVariable) {
      const Place* declared = place.declares ? &place : variable(place);
      if (declared == nullptr) continue;
      return Symbol{kind, std::string(place.text), {}, declared->scope};
    }
    if (!place.declares && !is_declared(kind, place)) continue;
    return Symbol{kind, std::string(place.text),
                  kind == Kind::kValue ? std::string(place.of) : std::string(), {}};
  }
  // Frames and links are declared by nobody in a text, and yet are one thing by one name.
  for (const Kind kind : {Kind::kFrame, Kind::kLink}) {
    if (place.may_be.has(kind)) return Symbol{kind, std::string(place.text), {}, {}};
  }
  return std::nullopt;
}

std::vector<const Place*> Index::declarations(const Symbol& symbol) const {
  std::vector<const Place*> out;
  const auto named = declarations_.find(symbol.name);
  if (named == declarations_.end()) return out;
  for (const Place* place : named->second) {
    const bool is_it = symbol.kind == Kind::kVariable
                           ? place->may_be.has(Kind::kVariable) && place->scope == symbol.scope
                           : place->may_be.has(symbol.kind) &&
                                 (symbol.kind != Kind::kValue || place->of == symbol.of);
    if (is_it) out.push_back(place);
  }
  return out;
}

std::vector<const Place*> Index::all(const Symbol& wanted) const {
  std::vector<const Place*> out;
  for (const auto& [id, places] : files_) {
    for (const Place& place : places) {
      if (place.text == wanted.name && symbol(place) == wanted) out.push_back(&place);
    }
  }
  return out;
}

std::vector<const Place*> Index::declared(Kinds kinds) const {
  std::vector<const Place*> out;
  std::unordered_map<std::string_view, bool> seen;
  for (const auto& [id, places] : files_) {
    for (const Place& place : places) {
      if (!place.declares) continue;
      bool wanted = false;
      for (std::size_t i = 0; i < kKindCount; ++i) {
        const auto kind = static_cast<Kind>(i);
        wanted = wanted || (kinds.has(kind) && place.may_be.has(kind));
      }
      if (wanted && seen.emplace(place.text, true).second) out.push_back(&place);
    }
  }
  return out;
}

}  // namespace probe::language
