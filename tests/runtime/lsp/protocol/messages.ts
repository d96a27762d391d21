// Which types of the protocol's own package each message has. check.mjs makes a JSON schema of it.
import type * as p from 'vscode-languageserver-protocol';

// What is asked, and what is answered.
interface Asked<Params, Result> {
  params: Params;
  result: Result;
}

export interface Requests {
  'initialize': Asked<p.InitializeParams, p.InitializeResult>;
  'shutdown': Asked<null, null>;
  'client/registerCapability': Asked<p.RegistrationParams, null>;
  'textDocument/codeAction': Asked<p.CodeActionParams, (p.Command | p.CodeAction)[] | null>;
  'textDocument/codeLens': Asked<p.CodeLensParams, p.CodeLens[] | null>;
  'textDocument/completion': Asked<p.CompletionParams, p.CompletionItem[] | p.CompletionList | null>;
  'textDocument/definition': Asked<p.DefinitionParams, p.Location | p.Location[] | p.LocationLink[] | null>;
  'textDocument/diagnostic': Asked<p.DocumentDiagnosticParams, p.DocumentDiagnosticReport>;
  'textDocument/documentHighlight': Asked<p.DocumentHighlightParams, p.DocumentHighlight[] | null>;
  'textDocument/documentLink': Asked<p.DocumentLinkParams, p.DocumentLink[] | null>;
  'textDocument/documentSymbol': Asked<p.DocumentSymbolParams, p.DocumentSymbol[] | p.SymbolInformation[] | null>;
  'textDocument/foldingRange': Asked<p.FoldingRangeParams, p.FoldingRange[] | null>;
  'textDocument/formatting': Asked<p.DocumentFormattingParams, p.TextEdit[] | null>;
  'textDocument/hover': Asked<p.HoverParams, p.Hover | null>;
  'textDocument/inlayHint': Asked<p.InlayHintParams, p.InlayHint[] | null>;
  'textDocument/prepareRename': Asked<p.PrepareRenameParams, p.PrepareRenameResult | null>;
  'textDocument/references': Asked<p.ReferenceParams, p.Location[] | null>;
  'textDocument/rename': Asked<p.RenameParams, p.WorkspaceEdit | null>;
  'textDocument/semanticTokens/full': Asked<p.SemanticTokensParams, p.SemanticTokens | null>;
  'textDocument/semanticTokens/range': Asked<p.SemanticTokensRangeParams, p.SemanticTokens | null>;
  'textDocument/signatureHelp': Asked<p.SignatureHelpParams, p.SignatureHelp | null>;
  'workspace/diagnostic/refresh': Asked<null, null>;
  'workspace/symbol': Asked<p.WorkspaceSymbolParams, p.SymbolInformation[] | p.WorkspaceSymbol[] | null>;
}

export interface Notices {
  'initialized': p.InitializedParams;
  'exit': null;
  '$/cancelRequest': { id: number | string };
  'textDocument/didChange': p.DidChangeTextDocumentParams;
  'textDocument/didClose': p.DidCloseTextDocumentParams;
  'textDocument/didOpen': p.DidOpenTextDocumentParams;
  'textDocument/didSave': p.DidSaveTextDocumentParams;
  'textDocument/publishDiagnostics': p.PublishDiagnosticsParams;
  'workspace/didChangeConfiguration': p.DidChangeConfigurationParams;
  'workspace/didChangeWatchedFiles': p.DidChangeWatchedFilesParams;
  'workspace/didChangeWorkspaceFolders': p.DidChangeWorkspaceFoldersParams;
}
