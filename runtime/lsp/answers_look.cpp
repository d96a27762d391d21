// What stands at a place, where it is declared and where else it stands, and what could stand there.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/language/complete.h"
#include "compiler/language/hover.h"
#include "compiler/language/outline.h"
#include "compiler/language/rename.h"
#include "compiler/language/signature.h"
#include "runtime/lsp/answers_impl.h"
#include "runtime/lsp/uri.h"
#include "runtime/lsp/values.h"

namespace probe::lsp {

Result<At> text_of(Workspace& workspace, const Json& params) {
  const std::string uri = read_text(params, {"textDocument", "uri"});
  if (uri.empty()) return Failure{Fault::kUsage, "expected `textDocument.uri`", ""};
  const Workspace::Found found = workspace.find(path_of(uri));
  if (found.program == nullptr)
    return Failure{Fault::kUsage, "`" + uri + "` is not open, or cannot be read", ""};
  return At{found.program, found.file, 0};
}

Result<At> place_of(Workspace& workspace, const Json& params) {
  PROBE_ASSIGN(At at, text_of(workspace, params));
  const auto position = read_position(params.find("position"));
  if (!position) return Failure{Fault::kUsage, "expected `position`, a line and a character", ""};
  at.offset = at.snapshot().lines(at.file).offset(*position);
  return at;
}

Result<Json> answer_hover(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  const auto found =
      language::hover(at.snapshot(), at.file, at.offset, at.program->said(at.file));
  if (!found) return Json();
  return Json{{"contents", markdown(found->text)},
              {"range", to_json(at.snapshot().range(found->span))}};
}

Result<Json> answer_definition(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  Json out = Json::array();
  for (const Span& span : language::definitions(at.snapshot(), at.file, at.offset))
    out.push_back(location(at.snapshot(), span));
  return out;
}

Result<Json> answer_references(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  const bool with_declarations = read_flag(params, {"context", "includeDeclaration"});
  Json out = Json::array();
  for (const language::FilePlace& place :
       language::references(at.snapshot(), at.file, at.offset, workspace.others())) {
    if (place.declares && !with_declarations) continue;
    out.push_back({{"uri", uri_of(place.path)}, {"range", to_json(place.range)}});
  }
  return out;
}

Result<Json> answer_highlights(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  Json out = Json::array();
  const std::string& path = at.snapshot().path(at.file);
  for (const language::FilePlace& place :
       language::references(at.snapshot(), at.file, at.offset, {})) {
    if (place.path != path) continue;
    constexpr int kRead = 2, kWrite = 3;
    out.push_back(
        {{"range", to_json(place.range)}, {"kind", place.declares ? kWrite : kRead}});
  }
  return out;
}

Result<Json> answer_signature(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  const auto call = language::call_at(at.snapshot(), at.file, at.offset);
  if (!call) return Json();
  Json parameters = Json::array();
  for (const auto& [begin, end] : call->signature.parameters)
    parameters.push_back({{"label", call->signature.label.substr(begin, end - begin)}});
  Json signature = {{"label", call->signature.label}, {"parameters", std::move(parameters)}};
  if (!call->signature.documentation.empty())
    signature["documentation"] = markdown(call->signature.documentation);
  return Json{{"signatures", Json::array({std::move(signature)})},
              {"activeSignature", 0},
              {"activeParameter", call->parameter}};
}

Result<Json> answer_completion(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  const language::Suggestions found =
      language::complete(at.snapshot(), at.file, at.offset, workspace.setting());
  const Json range = to_json(at.snapshot().range(found.replaced));
  Json items = Json::array();
  for (std::size_t i = 0; i < found.items.size(); ++i) {
    const language::Suggestion& suggestion = found.items[i];
    Json item = {{"label", suggestion.label},
                 {"kind", suggestion.item_kind},
                 {"sortText", fmt::format("{}{:05}", suggestion.rank, i)},
                 {"textEdit", {{"range", range}, {"newText", suggestion.label}}}};
    if (!suggestion.detail.empty()) item["detail"] = suggestion.detail;
    if (!suggestion.documentation.empty())
      item["documentation"] = markdown(suggestion.documentation);
    items.push_back(std::move(item));
  }
  return Json{{"isIncomplete", false}, {"items", std::move(items)}};
}

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Whether the letters of one stand in the other, in their order.
bool is_within(std::string_view letters, std::string_view name) {
  std::size_t at = 0;
  for (const char c : name) {
    if (at < letters.size() && lower(c) == lower(letters[at])) ++at;
  }
  return at == letters.size();
}

}  // namespace

Result<Json> answer_workspace_symbols(Workspace& workspace, const Client&, const Json& params) {
  constexpr std::size_t kMost = 500;
  const std::string query = read_text(params, {"query"});
  Json out = Json::array();
  std::set<std::string> seen;  // a file of several programs is told once
  for (const language::Snapshot* snapshot : workspace.others()) {
    for (const syntax::ParseResult& file : snapshot->files()) {
      const std::string& path = snapshot->path(file.file.id);
      if (!workspace.is_ours(path) || !seen.insert(path).second) continue;
      for (const language::OutlineItem& item : language::outline(*snapshot, file.file.id)) {
        if (out.size() == kMost) return out;
        if (!is_within(query, item.name)) continue;
        out.push_back({{"name", item.name},
                       {"kind", info(item.kind).symbol},
                       {"location", location(*snapshot, item.at)}});
      }
    }
  }
  return out;
}

}  // namespace probe::lsp
