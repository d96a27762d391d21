// The answers by what they are about; answers.cpp has the table of their methods.
#pragma once

#include "runtime/lsp/answers.h"

namespace probe::lsp {

// Where a request is about: an open text, and the place in it.
struct At {
  Program* program = nullptr;
  FileId file;
  std::uint32_t offset = 0;
  const language::Snapshot& snapshot() const { return *program->now; }
};
// Fails (kUsage) where the text is not open, or nothing could be read of it.
Result<At> text_of(Workspace& workspace, const Json& params);
Result<At> place_of(Workspace& workspace, const Json& params);  // with its `position`

// answers_look.cpp
Result<Json> answer_hover(Workspace&, const Client&, const Json&);
Result<Json> answer_definition(Workspace&, const Client&, const Json&);
Result<Json> answer_references(Workspace&, const Client&, const Json&);
Result<Json> answer_highlights(Workspace&, const Client&, const Json&);
Result<Json> answer_signature(Workspace&, const Client&, const Json&);
Result<Json> answer_completion(Workspace&, const Client&, const Json&);
Result<Json> answer_workspace_symbols(Workspace&, const Client&, const Json&);
// answers_text.cpp
Result<Json> answer_symbols(Workspace&, const Client&, const Json&);
Result<Json> answer_folds(Workspace&, const Client&, const Json&);
Result<Json> answer_tokens(Workspace&, const Client&, const Json&);
Result<Json> answer_links(Workspace&, const Client&, const Json&);
Result<Json> answer_hints(Workspace&, const Client&, const Json&);
Result<Json> answer_lenses(Workspace&, const Client&, const Json&);
Result<Json> answer_diagnostics(Workspace&, const Client&, const Json&);
Json token_legend();
// answers_edit.cpp
Result<Json> answer_formatting(Workspace&, const Client&, const Json&);
Result<Json> answer_prepare_rename(Workspace&, const Client&, const Json&);
Result<Json> answer_rename(Workspace&, const Client&, const Json&);
Result<Json> answer_code_actions(Workspace&, const Client&, const Json&);
// Ours: {textDocument, task, object, from: [x, y], to: [x, y] in m} to a WorkspaceEdit.
Result<Json> answer_move(Workspace&, const Client&, const Json&);

}  // namespace probe::lsp
