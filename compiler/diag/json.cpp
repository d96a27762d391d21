// Diagnostics as JSON; the order of keys is the order of json.h.
#include "compiler/diag/json.h"

#include "runtime/base/json.h"

namespace probe {
namespace {

void put_place(Json& out, const Span& span, const SourceSet& sources) {
  if (span.is_none()) {
    for (const char* key : {"file", "line", "column", "end_line", "end_column"}) out[key] = nullptr;
    return;
  }
  const SourceFile& file = sources.file(span.file);
  const LineColumn begin = file.line_column(span.begin);
  const LineColumn end = file.line_column(span.end);
  out["file"] = file.name();
  out["line"] = begin.line;
  out["column"] = begin.column;
  out["end_line"] = end.line;
  out["end_column"] = end.column;
}

Json to_json(const Fix& fix, const SourceSet& sources) {
  Json replacements = Json::array();
  for (const Replacement& replacement : fix.replacements) {
    Json item;
    put_place(item, replacement.span, sources);
    item["begin"] = replacement.span.begin;
    item["end"] = replacement.span.end;
    item["text"] = replacement.text;
    replacements.push_back(std::move(item));
  }
  Json out;
  out["message"] = fix.message;
  out["replacements"] = std::move(replacements);
  return out;
}

Json to_json(const Diagnostic& diagnostic, const SourceSet& sources) {
  Json out;
  out["code"] = info(diagnostic.code).text;
  out["severity"] = to_text(diagnostic.severity);
  out["message"] = diagnostic.message;
  put_place(out, diagnostic.primary, sources);
  out["labels"] = Json::array();
  for (const Label& label : diagnostic.labels) {
    Json item;
    item["message"] = label.text;
    put_place(item, label.span, sources);
    out["labels"].push_back(std::move(item));
  }
  out["fix"] = diagnostic.fix ? to_json(*diagnostic.fix, sources) : Json(nullptr);
  out["label"] = diagnostic.primary_label;
  out["helps"] = diagnostic.helps;
  out["notes"] = diagnostic.notes;
  return out;
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources) {
  Json out = Json::array();
  for (const Diagnostic* item : diagnostics.in_source_order()) {
    out.push_back(to_json(*item, sources));
  }
  // Messages quote the user's bytes, which need not be UTF-8.
  return out.dump(2) + "\n";
}

}  // namespace probe
