#include "compiler/names/name_table.h"

#include <algorithm>
#include <iterator>

#include "compiler/names/texts.h"
#include "runtime/base/spelling.h"

namespace probe::sema {
namespace {

// Of these a text cannot be searched for what there is: they stand in other files, or in none.
bool tells_all(std::string_view kind) {
  constexpr std::string_view kKinds[] = {"link",   "object", "scene", "fixture",
                                         "joint",  "camera", "light", "layout",
                                         "phrase", "set",    "suite"};
  return std::ranges::find(kKinds, kind) != std::end(kKinds) || kind.starts_with("part ") ||
         kind.starts_with("joint of ");
}

// "there are `top`, `middle`, `bottom`": at most eight, the nearest spelling first.
std::string nearest_few(std::string_view name, std::vector<std::string_view> candidates) {
  constexpr std::size_t kMost = 8, kLongest = 128;
  if (name.size() <= kLongest) {
    std::ranges::stable_sort(candidates, {}, [&](std::string_view known) {
      return spelling_edits(name, known.substr(0, kLongest));
    });
  }
  std::string text = candidates.size() == 1 ? "there is " : "there are ";
  for (std::size_t i = 0; i < std::min(kMost, candidates.size()); ++i)
    text += (i == 0 ? "`" : ", `") + std::string(candidates[i]) + "`";
  if (candidates.size() > kMost)
    text += " and " + std::to_string(candidates.size() - kMost) + " more";
  return text;
}

}  // namespace

std::optional<std::uint32_t> NameTable::declare(const syntax::Name& name,
                                                Diagnostics& diagnostics) {
  const auto index = static_cast<std::uint32_t>(names_.size());
  const auto [at, is_new] = by_text_.try_emplace(name.text, index);
  if (!is_new) {
    diagnostics
        .report(Code::P0203, name.span,
                kind_ + " `" + std::string(name.text) + "` is declared twice")
        .label(names_[at->second].span, "first declared here");
    return std::nullopt;
  }
  check_name(diagnostics, name);
  names_.push_back(name);
  return index;
}

std::optional<std::uint32_t> NameTable::peek(std::string_view text) const {
  const auto at = by_text_.find(text);
  if (at == by_text_.end()) return std::nullopt;
  return at->second;
}

void NameTable::forget_last() {
  by_text_.erase(names_.back().text);
  names_.pop_back();
}

std::optional<std::uint32_t> NameTable::find(const syntax::Name& name,
                                             Diagnostics& diagnostics) const {
  if (const auto found = peek(name.text)) return found;
  std::vector<std::string_view> candidates;
  for (const syntax::Name& known : names_) candidates.push_back(known.text);
  report_unknown(diagnostics, kind_, name, candidates);
  return std::nullopt;
}

Diagnostic& report_unknown(Diagnostics& diagnostics, std::string_view kind,
                           const syntax::Name& name,
                           const std::vector<std::string_view>& candidates) {
  Diagnostic& diagnostic =
      diagnostics.report(Situation::kUnknownName, name.span,
                         "unknown " + std::string(kind) + " `" + std::string(name.text) + "`");
  // A role or an object that is not declared is missed in words, metrics and layouts alike.
  const bool is_body =
      kind == "object" || kind == "role" || kind == "name" || kind == "set of bodies";
  diagnostic.subject = (is_body ? "body" : std::string(kind)) + " " + std::string(name.text);
  auto near = nearest(name.text, candidates);
  if (!near && name.text.size() > 2) {
    // `bridge` for `bridge_v2`: the only one that begins so.
    const auto begins = [&](std::string_view known) {
      return known.starts_with(std::string(name.text) + "_");
    };
    if (std::count_if(candidates.begin(), candidates.end(), begins) == 1)
      near = *std::find_if(candidates.begin(), candidates.end(), begins);
  }
  if (!near && tells_all(kind) && !candidates.empty())
    diagnostic.point(nearest_few(name.text, candidates));
  if (near) {
    const std::string text(*near);
    diagnostic.point("did you mean `" + text + "`?")
        .fix_by("write `" + text + "`", name.span, text);
  }
  return diagnostic;
}

}  // namespace probe::sema
