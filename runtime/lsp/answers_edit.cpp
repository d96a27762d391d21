// Edits: layout, other names, fixes.
#include <algorithm>

#include "compiler/format/format.h"
#include "compiler/language/fixes.h"
#include "compiler/language/moved.h"
#include "compiler/language/rename.h"
#include "runtime/lsp/answers_impl.h"
#include "runtime/lsp/common_ends.h"
#include "runtime/lsp/uri.h"
#include "runtime/lsp/values.h"

namespace probe::lsp {
namespace {

// The lines that differ, as one edit; none where the texts are equal.
Json difference(const language::Lines& lines, std::string_view before, std::string_view after) {
  Json out = Json::array();
  if (before == after) return out;
  auto [front, back] = common_ends(before, after);
  while (front > 0 && before[front - 1] != '\n') --front;
  while (back > 0 && before[before.size() - back - 1] != '\n') --back;
  const auto begin = static_cast<std::uint32_t>(front);
  const auto end = static_cast<std::uint32_t>(before.size() - back);
  out.push_back(text_edit(lines.range(begin, end),
                          std::string(after.substr(front, after.size() - back - front))));
  return out;
}

std::optional<std::array<double, 2>> read_pair(const Json& params, std::string_view key) {
  const Json* given = params.find(key);
  const bool is_pair = given != nullptr && given->is_array() && given->size() == 2 &&
                       (*given)[0].is_number() && (*given)[1].is_number();
  if (!is_pair) return std::nullopt;
  return std::array{(*given)[0].get<double>(), (*given)[1].get<double>()};
}

Json edits_of(const language::Snapshot& snapshot, const std::vector<Replacement>& parts) {
  Json changes = Json::object();
  for (const Replacement& part : parts) {
    Json& file = changes[uri_of(snapshot.path(part.span.file))];
    file.push_back(text_edit(snapshot.range(part.span), part.text));
  }
  return {{"changes", std::move(changes)}};
}

bool is_wanted(const Json& params, std::string_view kind) {
  const Json* only = find(params, {"context", "only"});
  if (only == nullptr || !only->is_array()) return true;
  return std::any_of(only->begin(), only->end(), [&](const Json& one) {
    if (!one.is_string()) return false;
    const std::string& wanted = one.text();
    // "source" asks for "source.fixAll" as well.
    return kind == wanted || wanted.empty() ||
           (kind.starts_with(wanted) && kind[wanted.size()] == '.');
  });
}

// Whether a program that has texts which are edited is still right.
Status check_renamed(const Workspace& workspace, const language::Snapshot& program,
                     const language::Symbol& symbol, const std::string& name,
                     const std::vector<language::FilePlace>& places,
                     const language::Unsaved& edited) {
  const std::string& root = program.path(program.root());
  const auto before =
      language::Snapshot::analysed(root, workspace.documents.texts(), workspace.setting());
  if (before == nullptr) return Failure{Fault::kUsage, root + " cannot be read", ""};
  for (const syntax::ParseResult& file : before->files()) {
    if (!file.ok)
      return Failure{Fault::kUsage,
                     before->path(file.file.id) + " has mistakes that hide names: mend them first",
                     ""};
  }
  PROBE_TRY(language::check_new_name(*before, symbol, name));
  if (symbol.kind != language::Kind::kVariable) {
    for (const language::Place* place : before->index().all(symbol)) {
      const bool is_edited = std::ranges::any_of(places, [&](const language::FilePlace& one) {
        return one.path == before->path(place->span.file) && one.span.begin == place->span.begin;
      });
      if (!is_edited)
        return Failure{Fault::kUsage,
                       "another `" + symbol.name + "` stands in " +
                           before->path(place->span.file),
                       ""};
    }
  }
  const std::string mistake =
      language::new_mistake(*before, symbol, name, edited, workspace.setting());
  if (!mistake.empty())
    return Failure{Fault::kUsage, "under the name `" + name + "`: " + mistake, ""};
  return {};
}

}  // namespace

Result<Json> answer_formatting(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const std::string_view text = at.snapshot().text(at.file);
  SourceSet sources;
  const FileId copy = sources.add(at.snapshot().path(at.file), std::string(text));
  Diagnostics diagnostics;
  PROBE_ASSIGN(const auto formatted, format::format_file(sources, copy, diagnostics));
  if (!formatted) return Json();  // it has mistakes, which are shown
  return difference(at.snapshot().lines(at.file), text, *formatted);
}

Result<Json> answer_prepare_rename(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  PROBE_ASSIGN(const Span span, language::renamed_span(at.snapshot(), at.file, at.offset));
  return Json{{"range", to_json(at.snapshot().range(span))},
              {"placeholder", std::string(at.snapshot().sources().text(span))}};
}

Result<Json> answer_rename(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, place_of(workspace, params));
  const std::string name = read_text(params, {"newName"});
  PROBE_ASSIGN(const Span span, language::renamed_span(at.snapshot(), at.file, at.offset));
  if (at.snapshot().sources().text(span) == name) return Json();
  PROBE_ASSIGN(const language::Symbol symbol,
               language::symbol_at(at.snapshot(), at.file, at.offset));
  const std::vector<const language::Snapshot*> others = workspace.others();
  if (!workspace.missed().empty()) {
    return Failure{Fault::kUsage,
                   "not every text of the folder was looked at: " + workspace.missed(), ""};
  }
  const auto places = language::references(at.snapshot(), at.file, at.offset, others);
  Json changes = Json::object();
  std::map<std::string, std::vector<Replacement>> by_path;
  for (const language::FilePlace& place : places) {
    if (!workspace.is_ours(place.path)) {
      return Failure{Fault::kUsage,
                     "`" + std::string(at.snapshot().sources().text(span)) +
                         "` stands in a text outside of the folder: " + place.path,
                     ""};
    }
    changes[uri_of(place.path)].push_back(text_edit(place.range, name));
    by_path[place.path].push_back({place.span, name});
  }
  // What a `derive` calls after it, or a metric's name in a table, would be lost in silence.
  language::Unsaved edited = workspace.documents.texts();
  for (auto& [path, parts] : by_path) {
    for (const language::Snapshot* snapshot : others) {
      const auto file = snapshot->find(path);
      if (!file) continue;
      edited[path] = language::applied(snapshot->text(*file), std::move(parts));
      break;
    }
  }
  for (const language::Snapshot* snapshot : others) {
    const bool is_edited = std::ranges::any_of(
        by_path, [&](const auto& one) { return snapshot->find(one.first).has_value(); });
    if (is_edited) PROBE_TRY(check_renamed(workspace, *snapshot, symbol, name, places, edited));
  }
  return Json{{"changes", std::move(changes)}};
}

Result<Json> answer_code_actions(Workspace& workspace, const Client& client, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const auto range = read_range(params.find("range"));
  if (!range) return Failure{Fault::kUsage, "expected `range`", ""};
  const language::Snapshot& snapshot = at.snapshot();
  const std::vector<const Diagnostic*> said = at.program->said(at.file);
  Json out = Json::array();
  for (const Diagnostic* diagnostic : said) {
    if (!diagnostic->fix || !is_wanted(params, "quickfix")) continue;
    const language::Range there = snapshot.range(diagnostic->primary);
    if (there.end < range->begin || range->end < there.begin) continue;
    const bool is_ours = std::ranges::all_of(
        diagnostic->fix->replacements, [&](const Replacement& part) {
          return workspace.is_ours(snapshot.path(part.span.file));
        });
    if (!is_ours) continue;
    out.push_back(
        {{"title", diagnostic->fix->message},
         {"kind", "quickfix"},
         {"isPreferred", true},
         {"diagnostics", Json::array({to_json(snapshot, *diagnostic, client.has_related)})},
         {"edit", edits_of(snapshot, diagnostic->fix->replacements)}});
  }
  const std::vector<Replacement> all = language::all_fixes(said, at.file);
  if (!all.empty() && is_wanted(params, "source.fixAll.vlaprobe")) {
    out.push_back({{"title", "fix all that can be fixed in this text"},
                   {"kind", "source.fixAll.vlaprobe"},
                   {"edit", edits_of(snapshot, all)}});
  }
  return out;
}

Result<Json> answer_move(Workspace& workspace, const Client&, const Json& params) {
  PROBE_ASSIGN(const At at, text_of(workspace, params));
  const auto from = read_pair(params, "from"), to = read_pair(params, "to");
  if (!from || !to) return Failure{Fault::kUsage, "expected `from` and `to`, places in m", ""};
  PROBE_ASSIGN(const std::vector<Replacement> parts,
               language::moved(at.snapshot(), read_text(params, {"task"}),
                               read_text(params, {"object"}), {*from, *to}));
  for (const Replacement& part : parts) {
    const std::string& path = at.snapshot().path(part.span.file);
    if (!workspace.is_ours(path)) {
      return Failure{Fault::kUsage,
                     "where it stands is written in a text outside of the folder: " + path +
                         "; a layout of its own would be written here",
                     ""};
    }
  }
  return edits_of(at.snapshot(), parts);
}

}  // namespace probe::lsp
