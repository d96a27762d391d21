// What is told of a whole text: its outline, colours, links, hints, mistakes.
#include <filesystem>

#include "compiler/language/hints.h"
#include "compiler/language/outline.h"
#include "compiler/language/tokens.h"
#include "runtime/lsp/answers_impl.h"
#include "runtime/lsp/uri.h"
#include "runtime/lsp/values.h"

namespace probe::lsp {
namespace {

Json symbol_tree(const language::Snapshot& snapshot, const language::OutlineItem& item) {
  Json out = {{"name", item.name},
              {"kind", info(item.kind).symbol},
              {"range", to_json(snapshot.range(item.whole))},
              {"selectionRange", to_json(snapshot.range(item.at))}};
  if (!item.detail.empty()) out["detail"] = item.detail;
  if (!item.children.empty()) {
    Json children = Json::array();
    for (const language::OutlineItem& child : item.children)
      children.push_back(symbol_tree(snapshot, child));
    out["children"] = std::move(children);
  }
  return out;
}

void add_symbols(const language::Snapshot& snapshot, const language::OutlineItem& item,
                 const std::string& within, Json& out) {
  Json symbol = {{"name", item.name},
                 {"kind", info(item.kind).symbol},
                 {"location", location(snapshot, item.whole)}};
  if (!within.empty()) symbol["containerName"] = within;
  out.push_back(std::move(symbol));
  for (const language::OutlineItem& child : item.children)
    add_symbols(snapshot, child, item.name, out);
}

}  // namespace

Result<Json> answer_symbols(Workspace& workspace, const Client& client, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  Json out = Json::array();
  for (const language::OutlineItem& item : language::outline(at.snapshot(), at.file)) {
    if (client.has_hierarchy) {
      out.push_back(symbol_tree(at.snapshot(), item));
    } else {
      add_symbols(at.snapshot(), item, "", out);
    }
  }
  return out;
}

Result<Json> answer_folds(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  Json out = Json::array();
  for (const language::Fold& fold : language::folds(at.snapshot(), at.file)) {
    Json range = {{"startLine", fold.first}, {"endLine", fold.last}};
    if (fold.kind == language::FoldKind::kComment) range["kind"] = "comment";
    if (fold.kind == language::FoldKind::kUses) range["kind"] = "imports";
    out.push_back(std::move(range));
  }
  return out;
}

Json token_legend() {
  Json types = Json::array(), modifiers = Json::array();
  for (const std::string_view type : language::kTokenTypes) types.push_back(type);
  for (const std::string_view type : language::kMoreTokenTypes) types.push_back(type);
  for (const std::string_view modifier : language::kTokenModifiers) modifiers.push_back(modifier);
  return {{"tokenTypes", std::move(types)}, {"tokenModifiers", std::move(modifiers)}};
}

// Five numbers a token, each place counted from the one before.
Result<Json> answer_tokens(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const auto wanted = read_range(params.find("range"));
  Json data = Json::array();
  language::Position last;
  for (const language::ColouredToken& token : language::coloured(at.snapshot(), at.file)) {
    const language::Range range = at.snapshot().range(token.span);
    if (range.begin.line != range.end.line || range.end == range.begin) continue;
    if (wanted && (range.end < wanted->begin || wanted->end < range.begin)) continue;
    const bool is_same_line = range.begin.line == last.line;
    data.push_back(range.begin.line - last.line);
    data.push_back(range.begin.character - (is_same_line ? last.character : 0));
    data.push_back(range.end.character - range.begin.character);
    data.push_back(token.type);
    data.push_back(token.modifiers);
    last = range.begin;
  }
  return Json{{"data", std::move(data)}};
}

Result<Json> answer_links(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const language::Snapshot& snapshot = at.snapshot();
  Json out = Json::array();
  const auto add = [&](const syntax::Text& path, FileId to) {
    if (to.is_none() || path.span.size() < 2) return;
    const Span within{path.span.file, path.span.begin + 1, path.span.end - 1};  // without quotes
    std::error_code error;
    const std::string target = std::filesystem::absolute(snapshot.path(to), error).string();
    out.push_back({{"range", to_json(snapshot.range(within))}, {"target", uri_of(target)}});
  };
  for (const syntax::Decl& decl : snapshot.tree(at.file)->file.decls) {
    if (const auto* use = std::get_if<syntax::UseDecl>(&decl.node)) add(use->path, use->file);
    const auto* layout = std::get_if<syntax::LayoutDecl>(&decl.node);
    if (layout == nullptr) continue;
    for (const syntax::LayoutStmt& stmt : layout->body) {
      if (const auto* starts = std::get_if<syntax::StartsStmt>(&stmt))
        add(starts->path, starts->file);
    }
  }
  return out;
}

Result<Json> answer_hints(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const language::Lines& lines = at.snapshot().lines(at.file);
  const auto range = read_range(params.find("range"));
  if (!range) return Failure{Fault::kUsage, "expected `range`", ""};
  Json out = Json::array();
  for (const language::Hint& hint : language::hints(
           at.snapshot(), at.file, lines.offset(range->begin), lines.offset(range->end))) {
    out.push_back({{"position", to_json(lines.position(hint.offset))},
                   {"label", hint.label},
                   {"paddingLeft", true}});
  }
  return out;
}

// The commands are the editor's: it knows in which terminal the program runs.
Result<Json> answer_lenses(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const std::string uri = read_text(params, {"textDocument", "uri"});
  Json out = Json::array();
  for (const language::Lens& lens : language::lenses(at.snapshot(), at.file)) {
    const Json range = to_json(at.snapshot().range(lens.name));
    const auto add = [&](const std::string& title, const char* command) {
      out.push_back({{"range", range},
                     {"command",
                      {{"title", title},
                       {"command", command},
                       {"arguments", Json::array({Json(uri), Json(lens.subject)})}}}});
    };
    if (lens.kind == language::LensKind::kTask) {
      add(lens.title, "vlaprobe.show");
      add("preview", "vlaprobe.preview");
      add("run expert", "vlaprobe.runExpert");
    } else {
      add(lens.title, "vlaprobe.list");
    }
  }
  return out;
}

Result<Json> answer_diagnostics(Workspace& workspace, const Client& client, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  Json items = Json::array();
  for (const Diagnostic* said : at.program->said(at.file))
    items.push_back(to_json(at.snapshot(), *said, client.has_related));
  return Json{{"kind", "full"}, {"items", std::move(items)}};
}

}  // namespace probe::lsp
