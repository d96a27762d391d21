#include "runtime/lsp/values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/lsp/uri.h"

namespace probe::lsp {

Json to_json(const language::Position& position) {
  return {{"line", position.line}, {"character", position.character}};
}

Json to_json(const language::Range& range) {
  return {{"start", to_json(range.begin)}, {"end", to_json(range.end)}};
}

Json location(const language::Snapshot& snapshot, const Span& span) {
  return {{"uri", uri_of(snapshot.path(span.file))}, {"range", to_json(snapshot.range(span))}};
}

Json text_edit(const language::Range& range, const std::string& text) {
  return {{"range", to_json(range)}, {"newText", text}};
}

Json markdown(const std::string& text) { return {{"kind", "markdown"}, {"value", text}}; }

Json to_json(const language::Snapshot& snapshot, const Diagnostic& diagnostic, bool has_related) {
  std::string message = diagnostic.message;
  if (!diagnostic.primary_label.empty()) message += "\n" + diagnostic.primary_label;
  for (const std::string& help : diagnostic.helps) message += "\nhelp: " + help;
  for (const std::string& note : diagnostic.notes) message += "\nnote: " + note;
  const bool is_placed = !diagnostic.primary.is_none();
  Json out = Json::object();
  out["range"] = is_placed ? to_json(snapshot.range(diagnostic.primary)) : to_json(language::Range());
  out["severity"] = diagnostic.severity == Severity::kError ? 1 : 2;
  out["code"] = info(diagnostic.code).text;
  out["source"] = "vlaprobe";
  out["message"] = message;
  if (diagnostic.code == Code::P0205) out["tags"] = Json::array({1});  // nothing uses it
  Json related = Json::array();
  for (const Label& label : diagnostic.labels) {
    if (label.span.is_none() || !has_related) continue;
    related.push_back({{"location", location(snapshot, label.span)},
                       {"message", label.text.empty() ? std::string("here, too") : label.text}});
  }
  if (!related.empty()) out["relatedInformation"] = std::move(related);
  return out;
}

const Json* find(const Json& value, std::initializer_list<std::string_view> keys) {
  const Json* at = &value;
  for (const std::string_view key : keys) {
    at = at->find(key);
    if (at == nullptr) return nullptr;
  }
  return at;
}

std::string read_text(const Json& value, std::initializer_list<std::string_view> keys) {
  const Json* found = find(value, keys);
  return found != nullptr && found->is_string() ? found->text() : std::string();
}

bool read_flag(const Json& value, std::initializer_list<std::string_view> keys) {
  const Json* found = find(value, keys);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

namespace {

std::optional<std::uint32_t> read_count(const Json* value) {
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const double number = value->get<double>();
  if (!(number >= 0)) return std::nullopt;
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(number, kMost));
}

}  // namespace

std::optional<language::Position> read_position(const Json* value) {
  if (value == nullptr) return std::nullopt;
  const auto line = read_count(value->find("line"));
  const auto character = read_count(value->find("character"));
  if (!line || !character) return std::nullopt;
  return language::Position{*line, *character};
}

std::optional<language::Range> read_range(const Json* value) {
  if (value == nullptr) return std::nullopt;
  const auto begin = read_position(value->find("start"));
  const auto end = read_position(value->find("end"));
  if (!begin || !end) return std::nullopt;
  return language::Range{*begin, *end};
}

}  // namespace probe::lsp
