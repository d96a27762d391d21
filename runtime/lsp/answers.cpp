#include "runtime/lsp/answers.h"

#include "runtime/lsp/answers_impl.h"

namespace probe::lsp {
namespace {

struct Method {
  std::string_view name;
  Answer answer;
};

constexpr Method kMethods[] = {
    {"textDocument/codeAction", answer_code_actions},
    {"textDocument/codeLens", answer_lenses},
    {"textDocument/completion", answer_completion},
    {"textDocument/definition", answer_definition},
    {"textDocument/diagnostic", answer_diagnostics},
    {"textDocument/documentHighlight", answer_highlights},
    {"textDocument/documentLink", answer_links},
    {"textDocument/documentSymbol", answer_symbols},
    {"textDocument/foldingRange", answer_folds},
    {"textDocument/formatting", answer_formatting},
    {"textDocument/hover", answer_hover},
    {"textDocument/inlayHint", answer_hints},
    {"textDocument/prepareRename", answer_prepare_rename},
    {"textDocument/references", answer_references},
    {"textDocument/rename", answer_rename},
    {"textDocument/semanticTokens/full", answer_tokens},
    {"textDocument/semanticTokens/range", answer_tokens},
    {"textDocument/signatureHelp", answer_signature},
    {"vlaprobe/move", answer_move},
    {"workspace/symbol", answer_workspace_symbols},
};

}  // namespace

Answer find_answer(std::string_view method) {
  for (const Method& known : kMethods) {
    if (known.name == method) return known.answer;
  }
  return nullptr;
}

Json capabilities() {
  Json out = Json::object();
  out["positionEncoding"] = "utf-16";
  out["textDocumentSync"] = {{"openClose", true}, {"change", 2}, {"save", false}};
  out["completionProvider"] = {{"triggerCharacters", Json::array({".", "\"", "{", "(", "/"})}};
  out["hoverProvider"] = true;
  out["signatureHelpProvider"] = {{"triggerCharacters", Json::array({"(", ","})}};
  out["definitionProvider"] = true;
  out["referencesProvider"] = true;
  out["documentHighlightProvider"] = true;
  out["documentSymbolProvider"] = true;
  out["workspaceSymbolProvider"] = true;
  out["codeActionProvider"] = {
      {"codeActionKinds", Json::array({"quickfix", "source.fixAll.vlaprobe"})}};
  out["codeLensProvider"] = {{"resolveProvider", false}};
  out["documentLinkProvider"] = {{"resolveProvider", false}};
  out["documentFormattingProvider"] = true;
  out["renameProvider"] = {{"prepareProvider", true}};
  out["foldingRangeProvider"] = true;
  out["inlayHintProvider"] = true;
  out["semanticTokensProvider"] = {
      {"legend", token_legend()}, {"full", true}, {"range", true}};
  out["experimental"] = {{"vlaprobeMove", true}};
  out["diagnosticProvider"] = {{"identifier", "vlaprobe"},
                               {"interFileDependencies", true},
                               {"workspaceDiagnostics", false}};
  return out;
}

}  // namespace probe::lsp
